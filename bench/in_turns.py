#!/usr/bin/python3
"""What a change gave to method `paper`: a former program and this one in turns, as the clock swings.

    in_turns.py FORMER [--insym PROGRAM] [--default] [--threads 1,2] [--repetitions 9] [MODEL ...]

Prints a table for docs/performance.md: seconds of detection of both, medians, their ratio, and whether they find the same
(reports without `timing`, byte by byte). In the paper's setting, cycles at 0.05, or with --default at default options.
Without MODEL: those of the paper's size in ../shared/data.
"""
import argparse
import sys
from pathlib import Path

import measure
from measure import ROOT
from run_performance import CYCLES_ONLY, PAPER, detect_s, median, seconds, table

SETTING = {"share": 0.05, "kinds": CYCLES_ONLY}
MODELS = [name for name, *_, target in PAPER if target == 0.1]


def compare(options, path, threads):
    def run(program):
        return measure.detect(program, path, method="paper", points="vertices", threads=threads, **({} if options.default else SETTING))

    former, now = measure.take_turns(options.repetitions, [lambda: run(options.former), lambda: run(options.insym)])
    before, after = median(former, detect_s), median(now, detect_s)
    same = len({r.bytes_without_timing() for r in former + now}) == 1
    return [path.stem, len(now[0].report["points"]), threads, seconds(before), seconds(after), f"{after / before:.2f}", "yes" if same else "NO"]


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("former", type=Path)
    parser.add_argument("models", nargs="*", type=Path, metavar="MODEL")
    parser.add_argument("--insym", type=Path, default=ROOT / "build" / "insym")
    parser.add_argument("--default", action="store_true")
    parser.add_argument("--threads", default="1,2")
    parser.add_argument("--repetitions", type=int, default=9)
    options = parser.parse_intermixed_args(arguments)
    data = ROOT.parent / "shared" / "data"
    options.models = options.models or [data / name for name in MODELS if (data / name).exists()]
    if not options.models:
        parser.error(f"no MODEL, and {data} is not here")
    return options


def main(arguments):
    options = parse(arguments)
    rows = [compare(options, path, int(threads)) for path in options.models for threads in options.threads.split(",")]
    print(table(["vertices of", "n", "threads", "before, s", "after, s", "ratio", "same"], rows))
    setting = "default options" if options.default else "the paper's setting"
    print(f"\n`bench/in_turns.py`, {setting}, medians of {options.repetitions}: {measure.machine()}.")


if __name__ == "__main__":
    main(sys.argv[1:])
