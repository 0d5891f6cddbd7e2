#!/usr/bin/python3
"""Damaged models: damaged_models.py PROGRAM [--count N] [--seed S] [--keep FOLDER]; exit status 0 passed, 77 skipped.

Oracle: the contract. Whatever was done to a model (cut off, bytes flipped, numbers made huge, references broken), the
program ends with status 0 (it was not so bad), 3 or 4 and one sentence, within its limits of time and memory,
and reads the whole model again afterwards. Models: the examples, as STEP, and as meshes made here.
"""
import argparse
import random
import re
import resource
import struct
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
DONE, CANNOT_READ, INVALID = 0, 3, 4
IMPORT_S, IMPORT_MIB = 20, 1024


def cut(data, rng):
    return data[:rng.randrange(1, len(data))]


def flip(data, rng):
    data = bytearray(data)
    for _ in range(rng.choice((1, 3, 30, 300))):
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return bytes(data)


def replace_some(data, rng, pattern, make):
    places = list(re.finditer(pattern, data))
    for place in sorted(rng.sample(places, min(len(places), rng.choice((1, 3, 30)))), key=lambda m: -m.start()):
        data = data[:place.start()] + make(place.group()) + data[place.end():]
    return data


def huge_numbers(data, rng):
    return replace_some(data, rng, rb"-?\d+\.\d*(?:E[-+]?\d+)?",
                        lambda _: rng.choice((b"1.E300", b"-1.E30", b"1.E999", b"9999999999.", b"0.", b"1.E-300")))


def broken_references(data, rng):
    last = data.count(b";")
    return replace_some(data, rng, rb"#\d+", lambda _: b"#%d" % rng.choice((0, 999999999, rng.randrange(1, last + 1))))


def stl_of(rng):
    """A box as a mesh: STL as text, or OFF as text or binary."""
    corners = [(x, y, z) for x in (0, 20) for y in (0, 30) for z in (0, 10)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    kind = rng.choice(("off", "binary off", "stl", "stl"))
    if kind == "binary off":
        numbers = struct.pack(">3i24f", 8, 6, 12, *(x for p in corners for x in p))
        return "a.off", b"OFF BINARY\n" + numbers + b"".join(struct.pack(">6i", 4, *q, 0) for q in quads)
    if kind == "off":
        lines = ["OFF", "8 6 12"] + ["%g. %g. %g." % p for p in corners] + ["4 %d %d %d %d" % q for q in quads]
        return "a.off", "\n".join(lines).encode() + b"\n"
    triangles = [t for q in quads for t in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]
    facets = ["facet normal 0 0 0\nouter loop\n" + "".join("vertex %g. %g. %g.\n" % corners[i] for i in t)
              + "endloop\nendfacet" for t in triangles]
    return "a.stl", ("solid box\n" + "\n".join(facets) + "\nendsolid box\n").encode()


def whole_models(rng, steps):
    """(name, content), STEP four times out of five."""
    while True:
        for _ in range(4):
            yield "a.step", rng.choice(steps)
        yield stl_of(rng)


def run(program, path):
    """Exit status, standard error, seconds and the most memory in MiB of any run so far."""
    start = time.monotonic()
    done = subprocess.run([program, "detect", path, "--types", "T", "--max-tolerance", "1e-6", "--limit", "1",
                           "--import-time", str(IMPORT_S), "--import-memory", str(IMPORT_MIB)],
                          capture_output=True, timeout=10 * IMPORT_S)
    memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    return done.returncode, done.stderr.decode(errors="replace"), time.monotonic() - start, memory


def judge(status, stderr):
    if status not in (DONE, CANNOT_READ, INVALID):
        return f"exit status {status}"
    if status != DONE and not re.fullmatch(r"insym: [^\n]+\n", stderr):
        return f"not one sentence: {stderr!r}"
    return ""


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=3)
    parser.add_argument("--keep", type=Path, help="keep models there that fail")
    options = parser.parse_args()
    rng = random.Random(options.seed)
    steps = [p.read_bytes() for p in sorted(EXAMPLES.glob("*.step"))]
    wrong, statuses, slowest, memory, crashed = [], Counter(), 0.0, 0.0, 0
    with tempfile.TemporaryDirectory() as folder:
        whole = Path(folder) / "whole.step"
        whole.write_bytes(min(steps, key=len))
        models = whole_models(rng, steps)
        for i in range(options.count):
            damage = (cut, flip, huge_numbers, broken_references)[i % 4]
            name, data = next(models)
            path = Path(folder) / name
            path.write_bytes(damage(data, rng))
            status, stderr, seconds, memory = run(options.program, path)
            statuses[status] += 1
            crashed += "crashed" in stderr
            slowest = max(slowest, seconds)
            failure = judge(status, stderr) or ("too slow" if seconds > IMPORT_S + 5 else "")
            if failure:
                wrong.append(f"{i}: {damage.__name__} of {name}: {failure}")
                if options.keep:
                    (options.keep / f"{i}-{name}").write_bytes(path.read_bytes())
            if i % 20 == 19 and run(options.program, whole)[0] != DONE:
                wrong.append(f"{i}: the next call, on a whole model, failed")
    print("\n".join(wrong))
    print(f"DAMAGED {options.count} models: {dict(sorted(statuses.items()))}, {crashed} crashes of a reader, slowest "
          f"{slowest:.1f} s, most memory {memory:.0f} MiB, {len(wrong)} failures")
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    main()
