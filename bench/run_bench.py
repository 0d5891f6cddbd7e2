#!/usr/bin/python3
"""Times the program on the inputs that have a target, and the reference beside it.

    run_bench.py [--insym PROGRAM] [--shared FOLDER] [--repetitions N] [--quick]

Detection only (the report's timing.detect_s), method paper; median and least of the repetitions, which take
turns so that a busy machine slows all inputs alike. Targets: the paper's own setting, 0.05 of the diameter and
the kinds C, T, Z, S, W of its Table 1, on 84 points in 0.5 s on one thread (the paper: 251 s for its 76 points); all
kinds on real models of 435 vertices and more at 1e-4 in 1 s on all cores. The last line compares with
reference.py on one small set.
"""
import argparse
import importlib
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[variable] = "1"

CYCLES_ONLY = "C,T,Z,S,W"
ALL = "M,I,C2,C,T,Z,S,W"
#         file in shared/data         share  kinds     threads (0: all)  target in s
INPUTS = [("spinner4_vertices.xyz", 0.05, CYCLES_ONLY, 1, 0.5),
          ("spinner4_vertices.xyz", 0.05, ALL, 1, None),
          ("dsub37.step", 1e-4, ALL, 0, 1.0),
          ("Ventilator.stp", 1e-4, ALL, 0, 1.0),
          ("dsub37.step", 1e-4, ALL, 1, None),
          ("Ventilator.stp", 1e-4, ALL, 1, None),
          ("as1-oc-214.stp", 1e-4, ALL, 1, None),
          ("spinner4_vertices.xyz", 1e-4, ALL, 1, None),
          ("spinner4_vertices.xyz", 1e-6, ALL, 1, None)]
PAPER_S, PAPER_POINTS = 251, 76


def detect(insym, path, share, kinds=ALL, threads=1):
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "report.json"
        command = [insym, "detect", path, "--method", "paper", "--max-tolerance", repr(share), "--types", kinds,
                   "--json", out, "--quiet"] + (["--points", "vertices"] if path.suffix != ".xyz" else [])
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        subprocess.run(command + (["--threads", str(threads)] if threads else []), check=True,
                       stdout=subprocess.DEVNULL)
        spent = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        report = json.loads(out.read_text())
    report["timing"]["cpu_s"] = spent
    return report


def measure_all(insym, inputs, repetitions):
    """For each input (a report, seconds of each repetition)."""
    measured = [(None, []) for _ in inputs]
    for _ in range(repetitions):
        for k, (path, share, kinds, threads, _) in enumerate(inputs):
            report = detect(insym, path, share, kinds, threads)
            measured[k] = (report, measured[k][1] + [report["timing"]])
    return measured


def row(path, share, kinds, threads, target, report, timings):
    seconds = [t["detect_s"] for t in timings]
    cycles = statistics.median(t["cycles_s"] for t in timings)
    cpu = min(t["cpu_s"] for t in timings)
    median = statistics.median(seconds)
    verdict = "" if target is None else f"{target:.1f} s " + ("met" if median <= target else "MISSED")
    return (f"{path.name:<24}{len(report['points']):>5}{share:>9g} {'all' if kinds == ALL else kinds:<10}"
            f"{threads or os.cpu_count():>4}{report['stats']['seeds']:>9}"
            f"{report['stats']['cycles']:>8}{report['stats']['symmetries']:>9}{cycles:>9.3f}"
            f"{median - cycles:>9.3f}{median:>9.3f}{min(seconds):>9.3f}{cpu:>9.3f}  {verdict}")


def small_set(np):
    """40 points: four rings of six under noise, and scattered points."""
    rng = np.random.default_rng(2007)
    angle = np.arange(6) * np.pi / 3
    rings = [np.c_[r * np.cos(angle + a), r * np.sin(angle + a), np.full(6, z)]
             for r, a, z in rng.uniform([0.3, 0, -1], [1, 1, 1], size=(4, 3))]
    points = np.vstack([*rings, rng.uniform(-1, 1, size=(16, 3))])
    return points + rng.normal(scale=1e-4, size=points.shape)


def compare_with_reference(insym, shared, repetitions):
    sys.dont_write_bytecode = True  # the folder is read-only reference material
    sys.path.insert(0, str(shared / "spec"))
    ref = importlib.import_module("reference")
    points = small_set(ref.np)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "small.xyz"
        ref.np.savetxt(path, points, fmt="%.17g")
        reports = [detect(insym, path, 2e-3) for _ in range(repetitions)]
    options = reports[0]["options"]
    start = time.perf_counter()
    cycles = ref.cycles(ref.PointSet(points, None, options["resolution"], options["max_tolerance"]))
    slow = time.perf_counter() - start
    fast = statistics.median(r["timing"]["cycles_s"] for r in reports)
    print(f"reference.py on {len(points)} points at 0.002: {slow:.2f} s for {len(cycles)} cycles; insym {fast * 1e3:.2f} ms "
          f"for {len(reports[0]['cycles'])}: {slow / fast:.0f} times as fast")


def main():
    root = Path(__file__).resolve().parents[1]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--insym", type=Path, default=root / "build" / "insym")
    parser.add_argument("--shared", type=Path, default=root.parent / "shared")
    parser.add_argument("--repetitions", type=int, default=7)
    parser.add_argument("--quick", action="store_true", help="only inputs with a target")
    options = parser.parse_args()
    insym = options.insym.resolve()
    data = options.shared / "data"
    wanted = [(data / name, *rest) for name, *rest in INPUTS
              if (data / name).exists() and (rest[-1] is not None or not options.quick)]
    if not wanted:
        print(f"{data} is absent: nothing to time")
        return
    measured = measure_all(insym, wanted, options.repetitions)
    print(f"{options.repetitions} repetitions, load average {os.getloadavg()[0]:.1f} on {os.cpu_count()} "
          "cores; seconds: medians, the\nleast detect_s, and the least processor time of the whole program with reading and writing")
    print(f"{'input':<24}{'n':>5}{'share':>9} {'kinds':<10}{'thr.':>4}{'seeds':>9}{'cycles':>8}{'symm.':>9}{'cycles_s':>9}"
          f"{'symm._s':>9}{'detect_s':>9}{'least':>9}{'cpu_s':>9}  target")
    for case, (report, timings) in zip(wanted, measured):
        print(row(*case, report, timings))
        if case[1] == 0.05 and case[2] == CYCLES_ONLY:
            spent = statistics.median(t["detect_s"] for t in timings)
            print(f"  the paper: {PAPER_S} s for {PAPER_POINTS} points at this share; {PAPER_S / spent:.0f} times as fast")
    compare_with_reference(insym, options.shared, options.repetitions)


if __name__ == "__main__":
    main()
