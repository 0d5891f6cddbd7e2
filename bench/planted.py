#!/usr/bin/python3
"""Planted symmetries, both methods: what plant.py makes and score.py says, as the tables of docs/benchmarks.md.

    planted.py INSYM [--shared DIR] [--seeds 11,12,13,14,15] [--count 200] [--methods robust,paper]

DIR holds bench/plant.py and bench/score.py. No tolerance is given. Prints a row for each setting, seed and method
as soon as it is known, then the sums over the seeds and, of the first setting, each kind.
tests/golden/robust.py asks some of these cases for the project's bounds.
"""
import argparse
import re
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from pathlib import Path

# noise (share of the diameter), random points for each planted one, share taken away
SETTINGS = [("1e-4", "1", "0.2"), ("1e-3", "2", "0.3"), ("3e-3", "1", "0.2"), ("1e-2", "0.5", "0.2"), ("1e-6", "10", "0.2")]
RANDOM = "scattered"
SCORE = re.compile(r"SCORE found (\d+)/(\d+), first (\d+)/\d+, slots (\d+)/(\d+), false alarms (\S+) per case")
KIND = re.compile(r"^(\w+): found (\d+)/(\d+)", re.MULTILINE)
COLUMNS = ("found", "cases", "first", "slots", "taken")


def run_setting(insym, bench, setting, seed, count, method):
    """Sums of one setting and seed, {kind: (found, cases)}, alarms per case or nan."""
    with tempfile.TemporaryDirectory() as folder:
        how = ["--random"] if setting == RANDOM else [
            "--noise", setting[0], "--clutter", setting[1], "--missing", setting[2]]
        subprocess.run([sys.executable, bench / "plant.py", *how, "--seed", str(seed), "--count", str(count), folder],
                       check=True, stdout=subprocess.DEVNULL)
        said = subprocess.run([sys.executable, bench / "score.py", insym, folder, "--method", method],
                              check=True, capture_output=True, text=True).stdout
    *numbers, alarms = SCORE.search(said).groups()
    kinds = {k: (int(found), int(cases)) for k, found, cases in KIND.findall(said)}
    return Counter(dict(zip(COLUMNS, map(int, numbers)))), kinds, float(alarms)


def row(setting, seeds, method, sums):
    shares = " | ".join(f"{sums[a]} of {sums[b]} ({100 * sums[a] / max(1, sums[b]):.1f} %)"
                        for a, b in (("found", "cases"), ("first", "cases"), ("slots", "taken")))
    print(f"| {' | '.join(setting)} | {seeds} | {method} | {shares} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("insym", type=Path)
    parser.add_argument("--shared", type=Path, default=Path(__file__).resolve().parents[1] / "../shared")
    parser.add_argument("--seeds", default="11,12,13,14,15")
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--methods", default="robust,paper")
    o = parser.parse_args()
    insym, bench, seeds = o.insym.resolve(), o.shared / "bench", [int(s) for s in o.seeds.split(",")]
    print("| noise | clutter | taken away | seeds | method | found | first | slots |\n|---|---|---|---|---|---|---|---|")
    all_kinds = defaultdict(Counter)
    for method in o.methods.split(","):
        for setting in SETTINGS:
            sums = Counter()
            for seed in seeds:
                own, kinds, _ = run_setting(insym, bench, setting, seed, o.count, method)
                sums += own
                row(setting, seed, method, own)
                if setting is SETTINGS[0]:
                    for kind, (found, cases) in kinds.items():
                        all_kinds[method, kind].update(found=found, cases=cases)
            if len(seeds) > 1:
                row(setting, f"{seeds[0]} to {seeds[-1]}", method, sums)
        alarms = run_setting(insym, bench, RANDOM, seeds[0], 2 * o.count, method)[2]
        print(f"{method}: {alarms:g} false alarms per scattered set, {2 * o.count} sets", flush=True)
    for (method, kind), sums in sorted(all_kinds.items()):
        print(f"{method}, first setting, {kind}: {sums['found']} of {sums['cases']}")


if __name__ == "__main__":
    main()
