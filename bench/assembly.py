#!/usr/bin/python3
"""Synthetic assemblies: patterns of parts with a known answer, and how many of them a report names.

    assembly.py make N POINTS.xyz TRUTH.json [--noise SHARE] [--seed S]
    assembly.py score REPORT.json TRUTH.json

Parts (bolts, brackets with a mirror plane, unsymmetric lumps) are repeated in grids, circles and rows, and each pattern
is placed and turned at random in a flat box that grows with N. Patterns are whole: the last ones are drawn until they
fit, and scattered points fill what room is left. All points have a normal error of SHARE of the diameter.

TRUTH.json: "patterns", each with its `type` (C or T), its `angle_deg` or `step`, and `size`, its points; "pattern_of",
the number of the pattern of each point, -1 for scattered ones. A pattern counts as found if a symmetry of its type, with
its step or angle to within 1 %, carries at least 80 % of its points.
"""
import argparse
import json

import numpy as np

TRIALS = 40  # patterns drawn for the last room before it is filled with scattered points


# Parts ----------------------------------------------------------------------------------------------

def ring(count, radius, height):
    angle = 2 * np.pi * np.arange(count) / count
    return np.c_[radius * np.cos(angle), radius * np.sin(angle), np.full(count, height)]


def bolt(_):
    return np.vstack([ring(6, 3, 0), ring(6, 3, 2), [[0, 0, 0], [0, 0, -8]]])


def bracket(rng):
    half = rng.uniform([0.5, -4, -4], [6, 4, 4], (6, 3))
    return np.vstack([half, half * [-1, 1, 1]])


def lump(rng):
    return rng.uniform(-3, 3, (7, 3))


PARTS = (bolt, bracket, lump)


# Patterns: (points, what a report should say of them) -----------------------------------------------

def grid(part, rng):
    rows, places = rng.integers(2, 6), rng.integers(3, 7)
    pitch = rng.uniform(14, 22, 2)
    points = np.vstack([part + [i * pitch[0], j * pitch[1], 0] for i in range(rows) for j in range(places)])
    return points, {"type": "T", "step": pitch[1]}


def circle(part, rng):
    count = rng.integers(5, 13)
    outwards = part + [count * rng.uniform(2.6, 4), 0, 0]
    angles = 2 * np.pi * np.arange(count) / count
    turns = [np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]]) for a in angles]
    return np.vstack([outwards @ turn.T for turn in turns]), {"type": "C", "angle_deg": 360 / count}


def row(part, rng):
    count = rng.integers(4, 16)
    step = np.array([rng.uniform(13, 20), 0, rng.uniform(-2, 2)])
    return np.vstack([part + i * step for i in range(count)]), {"type": "T", "step": np.linalg.norm(step)}


def any_turn(rng):
    """A rotation, uniform: of a random unit quaternion."""
    w, x, y, z = (q := rng.normal(size=4)) / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def any_pattern(rng):
    part = PARTS[rng.integers(len(PARTS))](rng)
    return (grid, circle, row)[rng.integers(3)](part, rng)


# The assembly ---------------------------------------------------------------------------------------

def assembly(n, noise=0.0, seed=1):
    """n points, shuffled, and the truth."""
    rng = np.random.default_rng(seed)
    side = 12 * np.sqrt(n / 2) + 60
    box = side * np.array([1, 1, 0.15])
    blocks, patterns, owners, count, failures = [], [], [], 0, 0
    while failures < TRIALS and count < n:
        points, pattern = any_pattern(rng)
        if count + len(points) > n:
            failures += 1
            continue
        blocks.append(points @ any_turn(rng).T + rng.uniform(size=3) * box)
        owners += [len(patterns)] * len(points)
        patterns.append({**pattern, "size": len(points)})
        count += len(points)
    blocks.append(rng.uniform(size=(n - count, 3)) * box)
    owners += [-1] * (n - count)
    points = np.vstack(blocks)
    diameter = np.linalg.norm(np.ptp(points, axis=0))
    order = rng.permutation(n)
    error = rng.normal(scale=noise * diameter, size=points.shape)  # last: the same assembly for any noise
    return (points + error)[order], {"patterns": patterns, "pattern_of": [owners[i] for i in order]}


def score(report, truth):
    """Which patterns the report names."""
    if report["input"]["merged_points"]:
        raise SystemExit("assembly.py: points were merged, so the truth does not name the report's points")
    patterns, pattern_of = truth["patterns"], np.asarray(truth["pattern_of"])
    found = [False] * len(patterns)
    for symmetry in report["symmetries"]:
        carried = np.unique(np.concatenate([cycle["points"] for cycle in symmetry["cycles"]]))
        owners = pattern_of[carried]
        shares = np.bincount(owners[owners >= 0], minlength=len(patterns))
        for k in np.flatnonzero(shares):
            value = "step" if patterns[k]["type"] == "T" else "angle_deg"
            is_it = (symmetry["type"] == patterns[k]["type"]
                     and abs(symmetry["isometry"][value] - patterns[k][value]) <= 0.01 * patterns[k][value])
            found[k] |= is_it and shares[k] >= 0.8 * patterns[k]["size"]
    return found


def write_points(path, points):
    np.savetxt(path, points, fmt="%.9g")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    make = commands.add_parser("make")
    make.add_argument("n", type=int)
    make.add_argument("points")
    make.add_argument("truth")
    make.add_argument("--noise", type=float, default=0.0)
    make.add_argument("--seed", type=int, default=1)
    judge = commands.add_parser("score")
    judge.add_argument("report")
    judge.add_argument("truth")
    options = parser.parse_args()
    if options.command == "make":
        points, truth = assembly(options.n, options.noise, options.seed)
        write_points(options.points, points)
        with open(options.truth, "w", encoding="utf-8") as out:
            json.dump(truth, out, default=float)
        print(f"{len(truth['patterns'])} patterns, {truth['pattern_of'].count(-1)} of {len(points)} points scattered")
        return
    with open(options.report, encoding="utf-8") as report, open(options.truth, encoding="utf-8") as truth:
        answer = json.load(truth)
        found = score(json.load(report), answer)
    for pattern, is_found in zip(answer["patterns"], found):
        if not is_found:
            print("missed", pattern)
    print(f"patterns found {sum(found)} of {len(found)}")


if __name__ == "__main__":
    main()
