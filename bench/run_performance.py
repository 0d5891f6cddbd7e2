#!/usr/bin/python3
"""Measures what docs/performance.md states, and writes it there.

    run_performance.py [--only growth,threads,...] [--quick] [--insym PROGRAM] [--kicad FOLDER] [--page FILE] ...

The page has a part for each section, between <!-- figures: NAME --> and <!-- end of figures -->. Only the parts of the
sections that are run are replaced; words by hand stay. Plots go to the folder images beside the page. --quick shows in
less than a minute that all of it works: few points, few models; unless --page says otherwise it writes to
build/performance. Sections `whole`, `kicad`, `paper_kicad` and `long_reference` run only when they are named or, those of
KiCad, with --kicad.
"""
import argparse
import datetime
import itertools
import math
import re
import shlex
import statistics
import sys
import tempfile
import time
from pathlib import Path

import measure
from measure import ROOT

import numpy as np

import assembly
import clusters
from chart import chart

CYCLES_ONLY = "C,T,Z,S,W"
METHODS = ("robust", "paper")
QUICK_TIME_LIMIT = 1  # seconds, of one run
WHOLE = {"time_limit": None}  # where what is found is compared


class Bench:
    """What the sections share: options, scratch files, plots."""

    def __init__(self, options, scratch):
        self.options = options
        self.quick = options.quick
        self.scratch = Path(scratch)
        self.images = options.page.parent / "images"

    def detect(self, path, **arguments):
        arguments.setdefault("time_limit", QUICK_TIME_LIMIT if self.quick else self.options.time_limit)
        return measure.detect(self.options.insym, path, **arguments)

    def repeated(self, *calls):
        """Runs of each call, (path, arguments), in turns."""
        return measure.take_turns(1 if self.quick else self.options.repetitions,
                                  [lambda p=path, a=arguments: self.detect(p, **a) for path, arguments in calls])

    def points(self, name, points):
        path = self.scratch / f"{name}.xyz"
        assembly.write_points(path, points)
        return path

    def plot(self, name, alt, *chart_arguments, **more):
        self.images.mkdir(parents=True, exist_ok=True)
        (self.images / f"performance_{name}.svg").write_text(chart(*chart_arguments, **more))
        return f"![{alt}](images/performance_{name}.svg)"

    def model(self, name):
        path = self.options.shared / "data" / name
        return path if path.exists() else None


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def median(runs, figure):
    return statistics.median(figure(run) for run in runs)


def detect_s(run):
    return run.timing["detect_s"]


def ratio(run):
    return run.timing["detect_s"] / max(run.timing["load_s"], 1e-9)


def seconds(value):
    return f"{value:.3g}" if value < 100 else f"{value:.0f}"


def time_of(runs):
    return seconds(median(runs, detect_s)) + runs[0].mark


def verdict(value, target):
    return "" if target is None else f"{target:g}: {'met' if value <= target else 'MISSED'}"


# Growth -----------------------------------------------------------------------------------------------

SIZES = (100, 200, 500, 1000, 2000, 5000, 10000, 20000, 50000, 100000)
QUICK_SIZES = (60, 200)
MOST_OF_PAPER = 10000  # method paper keeps all distances
TARGETS = {2000: 0.5, 20000: 10, 100000: 120}  # seconds for an assembly, method robust
TARGET_TIME_LIMIT = 150  # at least, of a run that has a target


def random_points(n):
    return np.random.default_rng(n).uniform(size=(n, 3)), None


def grid_points(n):
    side = round(n ** (1 / 3))
    axis = np.arange(side, dtype=float)
    return np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1, 3), None


FAMILIES = {"assembly": assembly.assembly, "random": random_points, "grid": grid_points}


def grow(bench, method, family):
    """One row for each size until a run meets the time limit: (n, seconds, MiB, patterns found or None, mark)."""
    rows = []
    for n in QUICK_SIZES if bench.quick else SIZES:
        if method == "paper" and n > MOST_OF_PAPER:
            break
        points, truth = FAMILIES[family](n)
        path = bench.points(f"{family}{n}", points)
        arguments = {"method": method}
        if (method, family) == ("robust", "assembly") and not bench.quick:
            arguments["time_limit"] = max(TARGET_TIME_LIMIT, bench.options.time_limit)
        runs = [bench.detect(path, **arguments)]
        while detect_s(runs[0]) < 0.5 and len(runs) < (1 if bench.quick else bench.options.repetitions):
            runs.append(bench.detect(path, **arguments))
        found = assembly.score(runs[0].report, truth) if truth else None
        rows.append((len(points), median(runs, detect_s), max(r.peak_mib for r in runs), found, runs[0].mark))
        if runs[0].stopped:
            break
    return rows


def exponent(rows):
    """Of the growth of time between 2,000 and 20,000 points, or as far as the runs go."""
    inside = [(n, t) for n, t, _, _, mark in rows if 1900 <= n <= 21000 and not mark]
    if len(inside) < 2:
        return "-"
    (n, t), (m, u) = inside[0], inside[-1]
    value = math.log(u / t) / math.log(m / n)
    return f"{value:.2f}" if m > 19000 else f"{value:.2f} (to {m:,})"


def growth_table(grown):
    head = ["n"] + [f"{family}, {what}" for family in FAMILIES for what in ("s", "MiB")] + ["patterns found", "target, s"]
    rows = []
    for k in range(max(map(len, grown.values()))):
        cells, name, found, target = [], "", "", ""
        for family in FAMILIES:
            if k >= len(grown[family]):
                cells += ["", ""]
                continue
            n, spent, mib, hits, mark = grown[family][k]
            cells += [seconds(spent) + mark, f"{mib:.0f}"]
            name = name or f"{n:,}"
            found = f"{sum(hits)} of {len(hits)}" if hits else found
            target = verdict(spent, TARGETS.get(n)) if family == "assembly" else target
        rows.append([name, *cells, found, target])
    rows.append(["exponent, 2,000 to 20,000", *(cell for family in FAMILIES for cell in (exponent(grown[family]), "")), "", ""])
    return table(head, rows)


def growth(bench):
    grown = {method: {family: grow(bench, method, family) for family in FAMILIES} for method in METHODS}
    parts = []
    for method in METHODS:
        parts += [f"Method `{method}`, default options (a grid has the nearest cube to n points; the target and the patterns are "
                  "those of the assembly):", growth_table(grown[method])]
    lines = {f"{family}, {method}": grown[method][family] for method in METHODS for family in FAMILIES}
    parts.append(bench.plot("time", "Seconds over points", {k: [(r[0], r[1]) for r in rows] for k, rows in lines.items()},
                            "points", "seconds"))
    parts.append(bench.plot("memory", "Memory over points", {k: [(r[0], r[2]) for r in rows] for k, rows in lines.items()},
                            "points", "MiB"))
    return "\n\n".join(parts)


# The paper's setting ----------------------------------------------------------------------------------

# Model, share of the diameter, kinds, slabs, --max-chains, target in seconds.
PAPER = [("spinner4.stp", 0.05, CYCLES_ONLY, None, None, 0.1),
         ("spinner2.stp", 0.05, CYCLES_ONLY, None, None, 0.1),
         ("linkrods.step", 0.05, CYCLES_ONLY, None, None, 0.1),
         ("Ventilator.stp", 1e-3, "M,I,C2", None, None, 1),
         ("dsub37.step", 0.05, CYCLES_ONLY, None, 0, 10),
         ("dsub37.step", 0.05, CYCLES_ONLY, None, None, 10),
         ("dsub37.step", 0.05, CYCLES_ONLY, 8, None, None)]


def searched(run, share):
    """Up to which share of the diameter: all that was asked for, or less."""
    return f"{share if run.limited is None else run.limited:.3g}"


def verdict_of_all(run, value, target):
    """A target is for all that was asked for; what a limit left out is said."""
    kept = verdict(value, target)
    return kept if run.limited is None or not kept else kept.replace("met", f"met up to {run.limited:.3g} only")


def paper(bench):
    cases = [case for case in PAPER if bench.model(case[0])]
    cases = cases[:1] if bench.quick else cases
    if not cases:
        return None
    # Those of the large model by themselves: a machine that has just worked for long is slower.
    runs = []
    for _, group in itertools.groupby(cases, key=lambda case: case[0] == "dsub37.step"):
        runs += bench.repeated(*((bench.model(name), {"method": "paper", "share": share, "kinds": kinds, "regions": regions,
                                                      "max_chains": most, "points": "vertices"})
                                 for name, share, kinds, regions, most, _ in group))
    rows = []
    for (name, share, kinds, regions, most, target), own in zip(cases, runs):
        report = own[0].report
        rows.append([name, len(report["points"]), share, kinds, regions or "", "none" if most == 0 else "", searched(own[0], share),
                     report["stats"]["cycles"], report["stats"]["symmetries"], time_of(own),
                     verdict_of_all(own[0], median(own, detect_s), target)])
    return table(["model", "vertices", "share", "kinds", "regions", "limit of chains", "searched up to", "cycles", "symmetries", "detect, s",
                  "target, s"], rows)


def paper_kicad(bench):
    """As many vertices as the paper's parts, of models that were drawn by lot: bench/kicad_small.txt."""
    paths = kicad_paths(bench, (ROOT / "bench" / "kicad_small.txt").read_text().splitlines())
    if not paths:
        return None
    runs = bench.repeated(*((path, {"method": "paper", "share": 0.05, "kinds": CYCLES_ONLY, "points": "vertices"}) for path in paths))
    rows = sorted(([path.stem, len(own[0].report["points"]), own[0].report["stats"]["cycles"], time_of(own),
                    verdict(median(own, detect_s), 0.1)] for path, own in zip(paths, runs)), key=lambda row: row[1])
    return table(["model", "vertices", "cycles", "detect, s", "target, s"], rows)


def whole(bench):
    """A large model at growing tolerances, without the limit of chains."""
    path = bench.model("dsub37.step")
    if not path:
        return None
    rows = []
    for share in (0.005,) if bench.quick else (0.005, 0.01, 0.02, 0.03, 0.05):
        run = bench.detect(path, method="paper", share=share, kinds=CYCLES_ONLY, points="vertices", max_chains=0, time_limit=None)
        stats = run.report["stats"]
        rows.append([share, stats["seeds"], stats["cycles"], stats["symmetries"], seconds(run.timing["cycles_s"]),
                     seconds(run.timing["symmetries_s"]), seconds(detect_s(run)), f"{run.peak_mib:,.0f}"])
    return table(["share", "seeds", "cycles", "symmetries", "cycles, s", "symmetries, s", "detect, s", "MiB"], rows)


# Models -----------------------------------------------------------------------------------------------

MODELS = ("as1-oc-214.stp", "Ventilator.stp", "dsub37.step", "spinner2.stp", "spinner4.stp", "linkrods.step")
HALF = {"as1-oc-214.stp", "Ventilator.stp", "dsub37.step"}  # detection in half the time of loading


def models(bench):
    names = [name for name in MODELS if bench.model(name)]
    if not names:
        return None
    rows = []
    for name in ["spinner4.stp"] if bench.quick else names:
        for points in ("vertices",) if bench.quick else ("vertices", "representative"):
            runs = bench.repeated(*((bench.model(name), {"points": points, "method": method}) for method in METHODS))
            row = [name, points, len(runs[0][0].report["points"]),
                   seconds(statistics.median(run.timing["load_s"] for own in runs for run in own))]
            target = (0.5 if name in HALF else 1) if points == "vertices" else None
            for own in runs:
                value = median(own, ratio)
                row += [time_of(own), f"{value:.2f}", verdict(value, target)]
            rows.append(row)
    return table(["model", "points", "n", "load, s"] + [f"`{m}` {w}" for m in METHODS for w in ("s", "ratio", "target")], rows)


def kicad_paths(bench, listing):
    """The models of a list (paths below the library's folder) that the folder holds, by the end of their path."""
    below = {"/".join(path.parts[-2:]): path for path in bench.options.kicad.rglob("*.step")} if bench.options.kicad else {}
    paths = [below[name] for name in listing if name in below]
    return paths[:2] if bench.quick else paths


def development_list(bench):
    listing = bench.options.shared / "bench" / "kicad_dev.txt"
    return [line.split(" ", 2)[2] for line in listing.read_text().splitlines() if line] if listing.exists() else []


def header_table(bench, path):
    """A pin header of 2 x 23 by its vertices: thousands of cycles."""
    cases = [("robust", None), ("paper", None), ("paper", 1e-5)]
    runs = bench.repeated(*((path, {"points": "vertices", "method": method, "share": share}) for method, share in cases))
    rows = [[path.stem, len(own[0].report["points"]), method, share or "auto", own[0].report["stats"]["cycles"],
             own[0].report["stats"]["symmetries"], time_of(own), verdict(median(own, detect_s), 0.7)]
            for (method, share), own in zip(cases, runs)]
    return table(["model", "vertices", "method", "share", "cycles", "symmetries", "detect, s", "target, s"], rows)


def kicad(bench):
    rows, lines = [], {}
    paths = kicad_paths(bench, development_list(bench))
    if not paths:
        return None
    headers = [path for path in paths if path.name.startswith("PinHeader_2x23")]
    for points in ("vertices", "representative"):
        for method in METHODS:
            runs = bench.repeated(*((path, {"points": points, "method": method}) for path in paths))
            ratios = {path.stem: median(own, ratio) for path, own in zip(paths, runs)}
            worst = max(ratios, key=ratios.get)
            slowest_path, slowest = max(zip(paths, runs), key=lambda item: median(item[1], detect_s))
            middle = statistics.median(ratios.values())
            rows.append([points, method, len(paths), f"{middle:.2f}", verdict(middle, 0.5 if points == "vertices" else 1),
                         sum(r <= 0.5 for r in ratios.values()), sum(r <= 1 for r in ratios.values()), f"{ratios[worst]:.2f} ({worst})",
                         f"{time_of(slowest)} ({slowest_path.stem}, {len(slowest[0].report['points'])} points)"])
            lines[f"{points}, {method}"] = [((k + 1) / len(paths), max(r, 1e-3)) for k, r in enumerate(sorted(ratios.values()))]
    plot = bench.plot("kicad", "Ratio of detection to loading", lines, "share of the models", "detect / load", x_logarithmic=False)
    return table(["points", "method", "models", "median ratio", "target", "at most 0.5", "at most 1", "worst ratio",
                  "slowest, s"], rows) + "".join("\n\n" + header_table(bench, path) for path in headers) + "\n\n" + plot


# Threads ----------------------------------------------------------------------------------------------

def threads(bench):
    n = 100 if bench.quick else 20000
    path = bench.points("threads", assembly.assembly(n)[0])
    one, two = bench.repeated((path, WHOLE | {"threads": 1}), (path, WHOLE | {"threads": 2}))
    same = len({run.bytes_without_timing() for run in one + two}) == 1
    speedup = median(one, detect_s) / median(two, detect_s)
    rows = [[f"assembly of {n:,}", time_of(one), time_of(two), f"{speedup:.2f}",
             f"1.7: {'met' if speedup >= 1.7 else 'MISSED'}", "yes" if same else "NO"]]
    return table(["points", "1 thread, s", "2 threads, s", "speed-up", "target", "same bytes without `timing`"], rows)


# Other programs ---------------------------------------------------------------------------------------

def small_set():
    """40 points: four rings of six under noise, and scattered points."""
    rng = np.random.default_rng(2007)
    angle = np.arange(6) * np.pi / 3
    rings = [np.c_[r * np.cos(angle + a), r * np.sin(angle + a), np.full(6, z)]
             for r, a, z in rng.uniform([0.3, 0, -1], [1, 1, 1], size=(4, 3))]
    points = np.vstack([*rings, rng.uniform(-1, 1, size=(16, 3))])
    return points + rng.normal(scale=1e-4, size=points.shape)


def compare_with_reference(bench, path, points, share, name, target):
    runs, = bench.repeated((path, WHOLE | {"method": "paper", "share": share, "kinds": CYCLES_ONLY}))
    lengths = runs[0].report["options"]
    ref = measure.reference(bench.options.shared)
    start = time.perf_counter()
    cycles = ref.cycles(ref.PointSet(points, None, lengths["resolution"], lengths["max_tolerance"]))
    slow = time.perf_counter() - start
    fast = median(runs, detect_s)
    rows = [[name, len(points), share, f"{len(cycles)} and {len(runs[0].report['cycles'])}", seconds(slow), f"{fast:.3g}",
             f"{slow / fast:,.0f}", target and f"{target:,}: {'met' if slow / fast >= target else 'MISSED'}"]]
    return table(["points", "n", "share", "cycles of both", "reference.py, cycles, s", "insym, cycles and symmetries, s", "ratio",
                  "target"], rows)


def reference(bench):
    if not (bench.options.shared / "spec" / "reference.py").exists():
        return None
    points = small_set()[:18] if bench.quick else small_set()
    return compare_with_reference(bench, bench.points("small", points), points, 2e-3, "rings and scattered points", "")


def long_reference(bench):
    path = bench.model("spinner4_vertices.xyz")
    return path and compare_with_reference(bench, path, np.loadtxt(path, ndmin=2)[:, :3], 0.01, path.stem, 5000)


def spglib(bench):
    if not clusters.have_spglib():
        return None
    rows = []
    for group in ("Td",) if bench.quick else clusters.GROUPS:
        for orbits in (1,) if bench.quick else (1, 4, 20):
            points = clusters.cluster(group, orbits)
            path = bench.points(f"{group}{orbits}".replace("/", "_"), points)
            runs, = bench.repeated((path, WHOLE))
            times, order, symbol = clusters.with_spglib(group, points, 1 if bench.quick else bench.options.repetitions)
            own, other = median(runs, detect_s), statistics.median(times)
            named = runs[0].report["group"]["hermann_mauguin"]
            rows.append([group, len(points), order, f"{symbol} and {named}", seconds(other), time_of(runs), f"{other / own:.2g}"])
    return table(["group", "n", "operations", "named by both", "spglib, s", "insym, s", "ratio"], rows)


# The page ---------------------------------------------------------------------------------------------

SECTIONS = {"growth": growth, "paper": paper, "paper_kicad": paper_kicad, "whole": whole, "models": models, "kicad": kicad,
            "threads": threads, "reference": reference, "long_reference": long_reference, "spglib": spglib}
OF_KICAD = {"kicad", "paper_kicad"}
ONLY_WHEN_NAMED = OF_KICAD | {"whole", "long_reference"}


def with_figures(page, name, text):
    pattern = re.compile(rf"(<!-- figures: {name} -->\n).*?(<!-- end of figures -->)", re.DOTALL)
    if len(pattern.findall(page)) != 1:
        raise SystemExit(f"run_performance.py: the page has no part for the section {name}, or several")
    return pattern.sub(lambda found: f"{found[1]}{text}\n{found[2]}", page)


def note(options, name, load_before):
    command = ["bench/run_performance.py", "--only", name] + (["--quick"] if options.quick else [])
    command += ["--kicad", "FOLDER"] if name in OF_KICAD else []
    command += [word for key in ("repetitions", "time_limit") if getattr(options, key) != DEFAULTS[key]
                for word in (f"--{key.replace('_', '-')}", str(getattr(options, key)))]
    return (f"`{shlex.join(command)}` on {datetime.date.today()}: {measure.machine()}; load average {load_before:.1f} before and "
            f"{measure.load_average():.1f} after; {measure.version(options.insym)}.")


def run_section(bench, name, page):
    load_before, start = measure.load_average(), time.perf_counter()
    text = SECTIONS[name](bench)
    if text is None:
        print(f"{name}: left out, as what it needs is not here")
        return page
    print(f"{name}: {time.perf_counter() - start:.0f} s", flush=True)
    return with_figures(page, name, f"{text}\n\n{note(bench.options, name, load_before)}\n")


DEFAULTS = {"repetitions": 5, "time_limit": 240}


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--insym", type=Path, default=ROOT / "build" / "insym")
    parser.add_argument("--shared", type=Path, default=ROOT.parent / "shared")
    parser.add_argument("--kicad", type=Path, help="folder with the STEP models of Debian's kicad-packages3d, at any depth")
    parser.add_argument("--page", type=Path)
    parser.add_argument("--only", help="sections, of " + ",".join(SECTIONS))
    parser.add_argument("--repetitions", type=int, default=DEFAULTS["repetitions"])
    parser.add_argument("--time-limit", type=float, default=DEFAULTS["time_limit"], help="of one run, in seconds")
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args(arguments)
    left_out = ONLY_WHEN_NAMED - (OF_KICAD if options.kicad else set())
    options.sections = options.only.split(",") if options.only else [s for s in SECTIONS if s not in left_out]
    if unknown := set(options.sections) - set(SECTIONS):
        parser.error(f"--only: no section {', '.join(sorted(unknown))}; there are {', '.join(SECTIONS)}")
    options.insym = options.insym.resolve()
    template = ROOT / "docs" / "performance.md"
    options.page = options.page or (ROOT / "build" / "performance" / "performance.md" if options.quick else template)
    options.template = options.page if options.page.exists() else template
    return options


def main():
    options = parse(sys.argv[1:])
    options.page.parent.mkdir(parents=True, exist_ok=True)
    page = options.template.read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as scratch:
        bench = Bench(options, scratch)
        for name in options.sections:
            page = run_section(bench, name, page)
            options.page.write_text(page, encoding="utf-8")
    print(f"written: {options.page}")


if __name__ == "__main__":
    main()
