#!/usr/bin/python3
"""The measuring programs of bench/: bench_test.py PROGRAM SOURCES. Nothing is timed.

Oracle: geometry, for what the assemblies hold; the definition of "found", for the score; for the runner, that it
replaces the figures of the page and no other word, that the definitions as a program (reference.py) give as many
cycles, that spglib names the same group, and that the report has the same bytes for one thread and two.
"""
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from collections import Counter
from pathlib import Path

import numpy as np

PROGRAM, SOURCES = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
sys.path.insert(0, str(SOURCES / "bench"))
sys.dont_write_bytecode = True
import assembly  # noqa: E402
import kicad_list  # noqa: E402


def pattern_points(points, truth, k):
    return points[np.flatnonzero(np.asarray(truth["pattern_of"]) == k)]


def check_translation(points, pattern):
    """In two thirds of a grid's or row's points at least one and the same step begins."""
    steps = (points[None] - points[:, None]).reshape(-1, 3)
    long_enough = steps[np.abs(np.linalg.norm(steps, axis=1) - pattern["step"]) < 1e-9]
    most = Counter(map(tuple, np.round(long_enough, 6))).most_common(1)[0][1]
    assert most >= 2 / 3 * len(points), (most, pattern)


def check_rotation(points, pattern):
    """The centre of a circle of k parts lies on its axis, so each distance to it comes k times, or 2 k times, ..."""
    count = round(360 / pattern["angle_deg"])
    distances = np.sort(np.linalg.norm(points - points.mean(axis=0), axis=1))
    ends = np.append(np.flatnonzero(np.diff(distances) > 1e-6) + 1, len(distances))
    assert not (np.diff(ends, prepend=0) % count).any(), pattern


def check_assembly():
    types = Counter()
    for n, seed in ((100, 1), (1000, 2), (3000, 3)):
        points, truth = assembly.assembly(n, seed=seed)
        assert points.shape == (n, 3) and len(truth["pattern_of"]) == n
        assert truth["pattern_of"].count(-1) <= max(30, n / 50), "most points belong to a pattern"
        for k, pattern in enumerate(truth["patterns"]):
            own = pattern_points(points, truth, k)
            assert len(own) == pattern["size"]
            (check_translation if pattern["type"] == "T" else check_rotation)(own, pattern)
            types[pattern["type"]] += 1
        again, _ = assembly.assembly(n, seed=seed)
        assert (again == points).all(), "the same seed gives the same assembly"
        noisy, _ = assembly.assembly(n, 1e-3, seed)
        shift = np.sqrt(((noisy - points) ** 2).mean()) / np.linalg.norm(np.ptp(points, axis=0))
        assert 0.8e-3 < shift < 1.2e-3, shift
    assert min(types["T"], types["C"]) >= 5, types


def report_of(truth, value_factor=1.0, share=1.0, other_type=False):
    """What a program would say that finds every pattern, its step or angle off by a factor, with a share of the points."""
    symmetries = []
    for k, pattern in enumerate(truth["patterns"]):
        own = np.flatnonzero(np.asarray(truth["pattern_of"]) == k)[:int(np.ceil(share * pattern["size"]))].tolist()
        value = {"step": 0, "angle_deg": 0}
        value |= {key: pattern[key] * value_factor for key in value if key in pattern}
        symmetries.append({"type": "W" if other_type else pattern["type"], "isometry": value, "cycles": [{"points": own}]})
    return {"input": {"merged_points": 0}, "symmetries": symmetries}


def check_score():
    _, truth = assembly.assembly(2000, seed=4)
    assert all(assembly.score(report_of(truth), truth))
    assert all(assembly.score(report_of(truth, 1.009, 0.8), truth))
    for spoilt in (report_of(truth, 1.011), report_of(truth, share=0.7), report_of(truth, other_type=True)):
        assert not any(assembly.score(spoilt, truth))


FIGURES = re.compile(r"<!-- figures: (\w+) -->\n(.*?)<!-- end of figures -->", re.DOTALL)


def cells(figures):
    """The first table: a row is a dictionary."""
    lines = [line.strip("|").split("|") for line in figures.splitlines() if line.startswith("|")]
    return [dict(zip(map(str.strip, lines[0]), map(str.strip, line))) for line in lines[2:]]


def check_runner(folder):
    before = (SOURCES / "docs/performance.md").read_text()
    page = folder / "performance.md"
    page.write_text(before)
    subprocess.run([SOURCES / "bench/run_performance.py", "--quick", "--insym", PROGRAM, "--page", page,
                    "--shared", SOURCES / "../shared"], check=True, stdout=subprocess.DEVNULL)
    after = page.read_text()
    assert FIGURES.sub("", after) == FIGURES.sub("", before), "words by hand were changed"
    figures = dict(FIGURES.findall(after))
    written = {name for name, text in figures.items() if "--quick" in text}
    assert {"growth", "threads"} <= written, written
    for name in written:
        assert cells(figures[name]) and "load average" in figures[name], name
        for plot in re.findall(r"\]\((images/\S+)\)", figures[name]):
            ElementTree.parse(folder / plot)
    assert cells(figures["threads"])[0]["same bytes without `timing`"] == "yes"
    if "reference" in written:
        slow, fast = cells(figures["reference"])[0]["cycles of both"].split(" and ")
        assert slow == fast, figures["reference"]
    if "spglib" in written:
        other, own = cells(figures["spglib"])[0]["named by both"].split(" and ")
        assert other == own, figures["spglib"]
    print("sections run:", ", ".join(sorted(written)))


def check_in_turns(folder):
    """A program compared with itself finds the same."""
    path = folder / "points.xyz"
    assembly.write_points(path, assembly.assembly(60)[0])
    said = subprocess.run([SOURCES / "bench/in_turns.py", PROGRAM, "--insym", PROGRAM, "--default", "--threads", "1",
                           "--repetitions", "1", path], check=True, capture_output=True, text=True).stdout
    row, = cells(said)
    assert row["n"] == str(len(path.read_text().splitlines())) and row["same"] == "yes", said
    assert float(row["before, s"]) > 0 and float(row["ratio"]) > 0, said


def check_kicad_list():
    """Oracle: the list that is given with the project; names of packages whose pins can be counted."""
    listing = SOURCES / "../shared/bench/kicad_dev.txt"
    given = listing.read_text().splitlines() if listing.exists() else []
    given += ["24 2.54 Package_DIP.3dshapes/DIP-48_W15.24mm_Socket.step",
              "12 0.5 Package_QFP.3dshapes/TQFP-48-1EP_7x7mm_P0.5mm_EP3.5x3.5mm.step"]
    for line in given:
        count, pitch, path = line.split(" ", 2)
        assert kicad_list.answer(path) == (int(count), float(pitch)), (line, kicad_list.answer(path))
    assert kicad_list.answer("Package_SO.3dshapes/SOIC_without_a_pitch.step") is None


def check_calibration():
    """Oracle: points scattered without an order have no symmetry that chance would not give."""
    said = subprocess.run([SOURCES / "bench/calibration.py", PROGRAM, "--sizes", "12,40", "--sets", "2"], check=True,
                          capture_output=True, text=True).stdout
    mean, sets = re.search(r"CALIBRATION (\S+) alarms per set, (\d+) sets", said).groups()
    assert int(sets) == 2 * 5 * 2 and float(mean) <= 0.2, said


def check_planted():
    """The table adds up to what was planted; without the shared programs there is nothing to run."""
    if not (SOURCES / "../shared/bench/plant.py").exists():
        print("planted: skipped, ../shared/bench is absent")
        return
    said = subprocess.run([SOURCES / "bench/planted.py", PROGRAM, "--seeds", "3", "--count", "8", "--methods", "robust"],
                          check=True, capture_output=True, text=True).stdout
    rows = [line for line in said.splitlines() if "| robust |" in line]
    assert len(rows) == 5 and all(" of 8 (" in r for r in rows), said
    assert sum(int(n) for n in re.findall(r"first setting, \w+: \d+ of (\d+)", said)) == 8, said


check_assembly()
check_score()
check_kicad_list()
check_calibration()
check_planted()
with tempfile.TemporaryDirectory() as scratch:
    check_in_turns(Path(scratch))
    check_runner(Path(scratch))
