#!/usr/bin/python3
"""What a change gave: a former program and this one on the paper's setting, in turns, as the clock swings.

    in_turns.py FORMER [--insym PROGRAM] [--share 0.05] [--threads 1,2] [--repetitions 9] [--kicad FOLDER] [MODEL ...]

Prints a table for docs/performance.md: seconds of detection of both, medians, their ratio, and whether they find the same
(reports without `timing`, byte by byte). Without MODEL: those of the paper's size in ../shared/data, and with --kicad TO-220-4.
"""
import argparse
import sys
from pathlib import Path

import measure
from measure import ROOT
from run_performance import CYCLES_ONLY, detect_s, median, seconds, table

MODELS = ("spinner4.stp", "spinner2.stp", "linkrods.step")
OF_KICAD = "TO-220-4_Vertical.step"


def compare(options, path, threads):
    def run(program):
        return measure.detect(program, path, method="paper", share=options.share, kinds=CYCLES_ONLY, points="vertices", threads=threads)

    former, now = measure.take_turns(options.repetitions, [lambda: run(options.former), lambda: run(options.insym)])
    before, after = median(former, detect_s), median(now, detect_s)
    same = len({r.bytes_without_timing() for r in former + now}) == 1
    return [path.stem, len(now[0].report["points"]), threads, seconds(before), seconds(after), f"{after / before:.2f}", "yes" if same else "NO"]


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("former", type=Path)
    parser.add_argument("models", nargs="*", type=Path, metavar="MODEL")
    parser.add_argument("--insym", type=Path, default=ROOT / "build" / "insym")
    parser.add_argument("--share", type=float, default=0.05)
    parser.add_argument("--threads", default="1,2")
    parser.add_argument("--repetitions", type=int, default=9)
    parser.add_argument("--kicad", type=Path, help="folder with the STEP models of Debian's kicad-packages3d, at any depth")
    options = parser.parse_args(arguments)
    data = ROOT.parent / "shared" / "data"
    if not options.models:
        options.models = [data / name for name in MODELS if (data / name).exists()]
        options.models += sorted(options.kicad.rglob(OF_KICAD)) if options.kicad else []
    if not options.models:
        parser.error(f"no MODEL, and {data} is not here")
    return options


def main(arguments):
    options = parse(arguments)
    rows = [compare(options, path, int(threads)) for path in options.models for threads in options.threads.split(",")]
    print(table(["vertices of", "n", "threads", "before, s", "after, s", "ratio", "same"], rows))
    print(f"\n`bench/in_turns.py` at {options.share}, medians of {options.repetitions}: {measure.machine()}.")


if __name__ == "__main__":
    main(sys.argv[1:])
