#!/usr/bin/python3
"""List models of Debian's kicad-packages3d whose file names state the answer, in the form kicad.py reads.

    kicad_list.py DEB [--seed S] [--count N] [--without LIST] > other.txt

DEB: Debian's kicad-packages3d (`apt-get download kicad-packages3d`). Lines 'count pitch_mm path': connectors
(`..._2x23_P1.27mm...`: 23 in a row), dual rows (DIP-48, pitch 2.54; SSOP-56 ... P0.635mm: half of the pins in a
row), and square packages (TQFP-48 ... P0.5mm: a quarter). Rows of three and less are left out, and what LIST holds.
"""
import argparse
import random
import re
import subprocess

PITCH = re.compile(r"_P(\d+(?:\.\d+)?)mm")
CONNECTOR = re.compile(r"_0?([12])x(\d+)(?:-\dMP)?_P\d")
DUAL = re.compile(r"/(?:SSOP|TSSOP|MSOP|SOIC|SOP|HTSSOP|VSSOP)-(\d+)_")
DIP = re.compile(r"/DIP-(\d+)_W[\d.]+mm(?:_Socket)?\.step$")
SQUARE = re.compile(r"/(?:TQFP|LQFP|QFN|QFP|VQFN)-(\d+)-?(?:1EP)?_(\d+(?:\.\d+)?)x(\d+(?:\.\d+)?)mm")


def answer(path):
    """(count in a row, pitch) that the name states, or None."""
    pitch = PITCH.search(path)
    if m := DIP.search(path):
        return int(m[1]) // 2, 2.54
    if pitch is None:
        return None
    if m := CONNECTOR.search(path):
        return int(m[2]), float(pitch[1])
    if m := DUAL.search(path):
        return int(m[1]) // 2, float(pitch[1])
    if (m := SQUARE.search(path)) and m[2] == m[3] and int(m[1]) % 4 == 0:
        return int(m[1]) // 4, float(pitch[1])
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("deb")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=260)
    parser.add_argument("--without", default=None)
    o = parser.parse_args()
    known = set()
    if o.without:
        with open(o.without, encoding="utf-8") as listing:
            known = {line.rstrip("\n").split(" ", 2)[2] for line in listing if line.strip()}
    listing = subprocess.run(["dpkg-deb", "--contents", o.deb], capture_output=True, text=True, check=True).stdout
    paths = sorted(line.split("/3dmodels/", 1)[1] for line in listing.splitlines()
                   if "/3dmodels/" in line and line.endswith(".step"))
    models = [(answer(p), p) for p in paths if p not in known]
    models = [(a, p) for a, p in models if a is not None and a[0] > 3]
    random.Random(o.seed).shuffle(models)
    for (count, pitch), path in models[:o.count]:
        print(count, pitch, path)


if __name__ == "__main__":
    main()
