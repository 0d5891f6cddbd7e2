#!/usr/bin/python3
"""How often method robust sees a symmetry where there is none: structureless sets of many sizes and layouts.

    calibration.py INSYM [--sizes 10,100,1000] [--sets K]

Layouts: scattered in a cube, on a plane, in a slab of a fiftieth of its width, on a line, and a grid whose points
are moved by up to half a pitch. An alarm is a listed symmetry with significance below 0. Prints for each size and
layout 'n layout: a alarms in k sets, at most m, s seconds each', and at last the mean of all.
Needs python3-numpy.
"""
import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import numpy as np


def grid(random, n):
    side = int(np.ceil(n ** (1 / 3)))
    nodes = np.stack(np.meshgrid(*[np.arange(side)] * 3), -1).reshape(-1, 3)[:n]
    return nodes + random.uniform(-0.5, 0.5, (n, 3))


def flat(random, n, thickness):
    return np.c_[random.uniform(-1, 1, (n, 2)), random.uniform(-thickness, thickness, n)]


LAYOUTS = {
    "space": lambda random, n: random.uniform(-1, 1, (n, 3)),
    "plane": lambda random, n: flat(random, n, 0),
    "slab": lambda random, n: flat(random, n, 0.02),
    "line": lambda random, n: np.c_[random.uniform(-1, 1, n), np.zeros((n, 2))],
    "grid": grid,
}


def alarms(insym, points, folder):
    """Number of symmetries below 0, and seconds of detection."""
    source, report = folder / "set.xyz", folder / "set.json"
    np.savetxt(source, points)
    subprocess.run([insym, "detect", str(source), "--json", str(report), "--quiet"], check=True)
    found = json.loads(report.read_text())
    return sum(s["significance"] < 0 for s in found["symmetries"]), found["timing"]["detect_s"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("insym")
    parser.add_argument("--sizes", default="10,30,100,300,1000,2000")
    parser.add_argument("--sets", type=int, default=5)
    o = parser.parse_args()
    counts = []
    with tempfile.TemporaryDirectory() as folder:
        for n in map(int, o.sizes.split(",")):
            for place, (layout, points) in enumerate(LAYOUTS.items()):
                results = [alarms(o.insym, points(np.random.default_rng([n, place, k]), n), Path(folder))
                           for k in range(o.sets)]
                own = [count for count, _ in results]
                counts += own
                print(f"{n} {layout}: {sum(own)} alarms in {o.sets} sets, at most {max(own)}, "
                      f"{np.mean([s for _, s in results]):.2f} s each", flush=True)
    print(f"CALIBRATION {np.mean(counts):.3f} alarms per set, {len(counts)} sets")


if __name__ == "__main__":
    main()
