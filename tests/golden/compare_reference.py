#!/usr/bin/python3
"""Compares cycles and clusters with reference.py on random sets, half of them with planted orbits.

Oracle: the executable definitions (shared/spec/reference.py). At least 99 % of the reference's cycles
must be found, and the symmetries of types T C Z S W must be exactly reference.clusters() of the
cycles found. 60 sets take half a minute; `--full` runs 300, the last 60 at up to 0.04 of the diameter.
"""
import tempfile
import time
from pathlib import Path

import golden

SETS, FULL_SETS, WIDE_SETS = 60, 300, 60
REQUIRED_SHARE = 0.99
KINDS = "TCZSW"


def rotation(np, angle, dim):
    c, s = np.cos(angle), np.sin(angle)
    q = np.eye(dim)
    q[:2, :2] = [[c, -s], [s, c]]
    return q


def planted_isometry(np, rng, dim, turn):
    """A random isometry about the origin: rotation, translation, glide; in 3D also screw and S."""
    kind = KINDS[turn % (5 if dim == 3 else 3)]
    q, t = np.eye(dim), np.zeros(dim)
    count = int(rng.integers(4, 8))
    if kind in "CS":
        q = rotation(np, 2 * np.pi / (count if kind == "C" else 6), dim)
    if kind == "W":
        q = rotation(np, rng.uniform(0.5, 1.2), dim)
    if kind in "ZS":
        q = np.diag([1.0] * (dim - 1) + [-1.0]) @ q
    if kind in "TZ":
        t[0] = rng.uniform(0.2, 0.4)
    if kind == "W":
        t[-1] = rng.uniform(0.1, 0.3)
    return q, t, {"S": 6, "W": 6}.get(kind, count)


def random_set(np, k):
    """(points, max_tolerance) of set k: 8 to 24 points in 2D or 3D, even k with planted orbits."""
    rng = np.random.default_rng([2007, k])
    dim, planted = 2 + k // 2 % 2, k % 2 == 0
    n = int(rng.integers(8, 25))
    x = rng.uniform(-1, 1, size=(n, dim))
    max_tolerance = rng.choice([2e-3, 5e-3, 1e-2]) * (4 if k >= FULL_SETS - WIDE_SETS else 1)
    if planted:
        q, t, count = planted_isometry(np, rng, dim, k // 4)
        for first in range(0, n - count + 1, count + 2):      # two scattered points between orbits
            for i in range(first + 1, first + count):
                x[i] = q @ x[i - 1] + t
        diameter = np.linalg.norm(x[:, None] - x[None], axis=2).max()
        x += rng.normal(scale=10 ** rng.uniform(-4, -3) * diameter, size=x.shape) / np.sqrt(dim)
    return x[rng.permutation(n)], float(max_tolerance)


def is_pairs(symmetry):
    """Half-turns are type C too, but come from pairs: no clusters of section 6's cycles."""
    return all(len(c["points"]) == 2 for c in symmetry["cycles"])


def cluster_differences(ref, ps, report):
    """Sentences about symmetries that are no clusters of the cycles found, or the reverse."""
    differences = []
    for kind in KINDS:
        members = [(tuple(c["points"]), c["closed"]) for c in report["cycles"] if kind in c["types"]]
        want = {frozenset(ref.canonical(*members[i]) for i in ids): level
                for level, ids in ref.clusters(ps, members, kind)}
        have = {frozenset(ref.canonical(c["points"], c["closed"]) for c in s["cycles"]): s["tolerance"]["min"]
                for s in report["symmetries"] if s["type"] == kind and not is_pairs(s)}
        for name, found in (("missing", want.keys() - have.keys()), ("no cluster", have.keys() - want.keys())):
            differences += [f"{kind} {name}: {sorted(points for points, _ in cluster)}" for cluster in found]
        differences += [f"{kind} at {have[c]:.9g}, should be at {want[c]:.9g}" for c in want.keys() & have.keys()
                        if abs(want[c] - have[c]) > 2 * ps.resolution]
    return differences


def compare(np, ref, insym, k):
    """(cycles of the reference, of these not found, found beyond it, sentences) of set k."""
    x, max_tolerance = random_set(np, k)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "set.xyz"
        np.savetxt(path, x, fmt="%.17g")
        report = golden.detect(insym, path, max_tolerance)
    if not np.array_equal(np.array(report["points"]), x):
        return 0, 0, 0, ["the report's points are not those of the input"]
    ps = ref.PointSet(x, None, report["options"]["resolution"], report["options"]["max_tolerance"])
    start = time.time()
    want = ref.cycles(ps)
    spent = time.time() - start
    have = {ref.canonical(c["points"], c["closed"]): c["types"] for c in report["cycles"]}
    lost, extra = want.keys() - have.keys(), have.keys() - want.keys()
    sentences = [f"types of {c[0]} are {have[c]}, should be {want[c]}" for c in want.keys() & have.keys()
                 if sorted(want[c]) != sorted(have[c])]
    sentences += cluster_differences(ref, ps, report)
    print(f"set {k}: {len(x)} points in {x.shape[1]}D at {max_tolerance:g}: reference {len(want)} cycles "
          f"({spent:.1f} s), lost {sorted(lost)}, beyond it {len(extra)}", flush=True)
    return len(want), len(lost), len(extra), sentences


def main():
    parser = golden.arguments(__doc__)
    parser.add_argument("--part", default="0/1", help="K/N: every N-th of the sets, from K")
    parser.add_argument("--first", type=int, default=0, help="number of the first set")
    parser.add_argument("--sets", type=int, default=SETS, help="how many sets without --full")
    options = parser.parse_args()
    ref = golden.specification(options.shared, "reference")
    np = ref.np
    part, parts = map(int, options.part.split("/"))
    total = lost = extra = 0
    wrong = []
    last = FULL_SETS if options.full else options.first + options.sets
    for k in range(options.first + part, last, parts):
        a, b, c, sentences = compare(np, ref, options.insym, k)
        total, lost, extra = total + a, lost + b, extra + c
        wrong += [f"set {k}: {sentence}" for sentence in sentences]
    print("\n".join(wrong))
    share = 1 - lost / max(1, total)
    print(f"REFERENCE found {total - lost}/{total} cycles ({100 * share:.2f} %), {extra} beyond it, "
          f"{len(wrong)} differences of types and clusters")
    raise SystemExit(0 if total > 0 and share >= REQUIRED_SHARE and not wrong else 1)


if __name__ == "__main__":
    main()
