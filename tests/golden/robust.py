#!/usr/bin/python3
"""Method robust, the default: planted symmetries with known answers, scattered points, and its reports.

Oracles: plant.py and score.py (what was planted: found, first, slots; false alarms); check_report.py (the
definitions: no violation).
"""
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import golden

# Settings of issue 4's benchmark, a few cases of each: (name, options of plant.py, least shares found, first, slots).
# Its bounds, and where it has none what is met with something to spare.
SETTINGS = [
    ("noise 1e-4", ["--noise", "1e-4", "--clutter", "1", "--missing", "0.2"], 0.995, 0.92, 0.97),
    ("noise 1e-3", ["--noise", "1e-3", "--clutter", "2", "--missing", "0.3"], 0.99, 0.90, 0.92),
    ("noise 3e-3", ["--noise", "3e-3", "--clutter", "1"], 0.97, 0.90, 0.80),
    ("noise 1e-2", ["--noise", "1e-2", "--clutter", "0.5"], 0.80, 0.70, 0.20),
    ("clutter 4", ["--noise", "1e-6", "--clutter", "4"], 0.995, 0.95, 0.95),
]


def run(*command):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True)


def score(options, folder, plant, count):
    bench = options.shared / "bench"
    made = run(sys.executable, bench / "plant.py", "--seed", "11", "--count", count, *plant, folder)
    if made.returncode != 0:
        raise RuntimeError(made.stderr)
    done = run(sys.executable, bench / "score.py", options.insym.resolve(), folder)
    last = (done.stdout.strip().splitlines() or [done.stderr])[-1]
    found = re.search(r"found (\d+)/(\d+), first (\d+)/\d+, slots (\d+)/(\d+), false alarms (\S+) per case", last)
    if done.returncode != 0 or not found:
        raise RuntimeError(f"score.py: {last}")
    return last, found


def planted(options, folder, count):
    wrong = []
    for k, (name, plant, found_least, first_least, slots_least) in enumerate(SETTINGS):
        last, m = score(options, Path(folder) / str(k), plant, count)
        print(f"{name}: {last}", flush=True)
        found, cases, first, slots, lost = (int(m.group(i)) for i in range(1, 6))
        if found < found_least * cases or first < first_least * cases or slots < slots_least * lost:
            wrong.append(f"{name}: too few found, first or slots")
    last, m = score(options, Path(folder) / "random", ["--random"], count)
    print(f"scattered: {last}", flush=True)
    if float(m.group(6)) > 0.2:
        wrong.append("scattered points: more than 0.2 false alarms for each set")
    return wrong


def reports(options, folder, checker, paths):
    wrong = []
    for path in paths:
        out = Path(folder) / "report.json"
        done = run(options.insym.resolve(), "detect", path, "--points", "vertices", "--quiet", "--json", out)
        if done.returncode != 0:
            raise RuntimeError(f"{path}: exit status {done.returncode}: {done.stderr}")
        report = json.loads(out.read_text())
        check = run(sys.executable, checker, out)
        print(f"{path.name}: {check.stdout.strip().splitlines()[-1]}", flush=True)
        if check.returncode != 0 or not report["symmetries"] or report["options"]["method"] != "robust":
            wrong.append(f"{path.name}: {check.stdout.strip()[-300:]}")
    return wrong


def main():
    options = golden.arguments(__doc__).parse_args()
    golden.specification(options.shared, "check_report")
    checker = options.shared / "spec" / "check_report.py"
    examples = Path(__file__).resolve().parents[2] / "examples"
    paths = [options.shared / "data" / "spinner4_vertices.xyz"]
    models = ["flange", "bracket", "antiprism", "spiral_stair"] if options.full else ["flange", "bracket"]
    paths += [examples / f"{name}.step" for name in models]
    with tempfile.TemporaryDirectory() as folder:
        wrong = planted(options, folder, "200" if options.full else "16")
        wrong += reports(options, folder, checker, paths)
    print("\n".join(wrong))
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    main()
