#!/usr/bin/python3
"""Times the program on the inputs that have a target.

    run_bench.py [--insym PROGRAM] [--shared FOLDER] [--repetitions N] [--quick]

Detection only (the report's timing.detect_s), method paper; median and least of the repetitions, which take
turns so that a busy machine slows all inputs alike. Targets: the paper's own setting, 0.05 of the diameter and
the kinds C, T, Z, S, W of its Table 1, on 84 points in 0.5 s on one thread (the paper: 251 s for its 76 points); all
kinds on real models of 435 vertices and more at 1e-4 in 1 s on all cores. run_performance.py compares with others.
"""
import argparse
import os
import statistics
from pathlib import Path

import measure
from measure import ROOT

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


def row(path, share, kinds, threads, target, runs):
    report, timings = runs[0].report, [run.timing for run in runs]
    seconds = [t["detect_s"] for t in timings]
    cycles = statistics.median(t["cycles_s"] for t in timings)
    cpu = min(run.cpu_s for run in runs)
    median = statistics.median(seconds)
    verdict = "" if target is None else f"{target:.1f} s " + ("met" if median <= target else "MISSED")
    return (f"{path.name:<24}{len(report['points']):>5}{share:>9g} {'all' if kinds == ALL else kinds:<10}"
            f"{threads or os.cpu_count():>4}{report['stats']['seeds']:>9}"
            f"{report['stats']['cycles']:>8}{report['stats']['symmetries']:>9}{cycles:>9.3f}"
            f"{median - cycles:>9.3f}{median:>9.3f}{min(seconds):>9.3f}{cpu:>9.3f}  {verdict}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--insym", type=Path, default=ROOT / "build" / "insym")
    parser.add_argument("--shared", type=Path, default=ROOT.parent / "shared")
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
    measured = measure.take_turns(
        options.repetitions,
        [lambda p=path, s=share, k=kinds, t=threads: measure.detect(insym, p, method="paper", share=s, kinds=k, threads=t,
                                                                    points="vertices")
         for path, share, kinds, threads, _ in wanted])
    print(f"{options.repetitions} repetitions, load average {measure.load_average():.1f} on {os.cpu_count()} "
          "cores; seconds: medians, the\nleast detect_s, and the least processor time of the whole program with reading and writing")
    print(f"{'input':<24}{'n':>5}{'share':>9} {'kinds':<10}{'thr.':>4}{'seeds':>9}{'cycles':>8}{'symm.':>9}{'cycles_s':>9}"
          f"{'symm._s':>9}{'detect_s':>9}{'least':>9}{'cpu_s':>9}  target")
    for case, runs in zip(wanted, measured):
        print(row(*case, runs))
        if case[1] == 0.05 and case[2] == CYCLES_ONLY:
            spent = statistics.median(run.timing["detect_s"] for run in runs)
            print(f"  the paper: {PAPER_S} s for {PAPER_POINTS} points at this share; {PAPER_S / spent:.0f} times as fast")


if __name__ == "__main__":
    main()
