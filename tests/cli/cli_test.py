#!/usr/bin/python3
"""The program insym from outside: cli_test.py PROGRAM [TEST...]; exit status 0 passed, 1 failed, 77 skipped.

Oracle: the contract (report.md): for every input the exit status it names, exactly one sentence on
standard error for a failure, no partial file, a report of the schema's shape; known answers for small
sets of points; the same bytes for every number of threads.
"""
import math
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import traceback
from pathlib import Path

import numpy as np

from program import CANNOT_READ, DONE, INVALID, STOPPED, USAGE, Box, assert_bad_input, assert_fails, one_sentence
from report_schema import checked_report

SHARED = Path(os.environ.get("INSYM_SHARED", Path(__file__).resolve().parents[2] / "../shared"))
NOBODY = 65534


class Skip(Exception):
    """The test cannot run here; the sentence says why."""


# Points -------------------------------------------------------------------------------------------

def ring(n, dimension=3):
    angle = 2 * np.pi * np.arange(n) / n
    return np.column_stack([np.cos(angle), np.sin(angle), np.full(n, 0.5)][:dimension])


def cloud(n):
    return np.random.default_rng(5).uniform(size=(n, 3))


def long_run(box):
    """Arguments of a run that takes much longer than any of these tests waits."""
    return box.points("cloud.xyz", cloud(20000)).name, "--max-tolerance", "0.05"


def shared(name):
    path = SHARED / name
    if not path.exists():
        raise Skip(f"{path} is not there")
    return path.resolve()


def has_brep():
    return os.environ.get("INSYM_BREP", "ON").upper() in ("ON", "1", "TRUE", "YES")


def need_brep():
    if not has_brep():
        raise Skip("the program was built without the reader of models")


# Bad input, one by one ----------------------------------------------------------------------------

def test_empty_file(box):
    assert_bad_input(box, INVALID, "no points", box.write("a.xyz", "").name)


def test_only_comments(box):
    assert_bad_input(box, INVALID, "no points", box.write("a.csv", "# nothing\n\n// here\n").name)


def test_one_point(box):
    assert_bad_input(box, INVALID, "point", box.write("a.xyz", "1 2 3\n").name)


def test_all_points_equal(box):
    assert_bad_input(box, INVALID, "equal", box.write("a.xyz", "1 2 3\n" * 5).name)


def test_mixed_columns(box):
    assert_bad_input(box, INVALID, "a.txt:2: 4 columns", box.write("a.txt", "1 2\n1 2 3 4\n").name)


def test_not_a_number(box):
    assert_bad_input(box, INVALID, "a.xyz:2:", box.write("a.xyz", "1 2 3\n1 NaN 3\n").name)


def test_infinity(box):
    assert_bad_input(box, INVALID, "a.xyz:3:", box.write("a.xyz", "1 2 3\n3 2 1\n1 inf 3\n").name)


def test_word(box):
    assert_bad_input(box, INVALID, "a.xyz:1: 'one'", box.write("a.xyz", "one 2 3\n1 2 3\n").name)


def test_number_too_large(box):
    assert_bad_input(box, INVALID, "a.xyz:2: '1e999'", box.write("a.xyz", "1 2 3\n1e999 2 3\n").name)


def test_distances_overflow(box):
    assert_bad_input(box, INVALID, "overflow", box.write("a.xyz", "1e308 0 0\n-1e308 0 0\n0 1e308 0\n0 0 0\n").name)


def test_label_not_whole(box):
    assert_bad_input(box, INVALID, "a.xyz:1: the label 'x'", box.write("a.xyz", "1 2 3 x\n").name)


def test_wrong_atom_count(box):
    assert_bad_input(box, INVALID, "a.xyz:1:", box.write("a.xyz", "3\nwater\nO 0 0 0\nH 1 0 0\n").name)


def test_binary_file(box):
    assert_bad_input(box, CANNOT_READ, "binary", box.write("a.xyz", bytes(range(256)) * 20).name)


def test_program_as_input(box):
    shutil.copy(box.program, box.folder / "a.xyz")
    assert_bad_input(box, CANNOT_READ, "binary", "a.xyz")


def test_endless_device(box):
    assert_bad_input(box, CANNOT_READ, "binary", "/dev/zero")


def test_directory(box):
    (box.folder / "a.xyz").mkdir()
    assert_bad_input(box, CANNOT_READ, "directory", "a.xyz")


def test_directory_named_step(box):
    need_brep()
    (box.folder / "a.step").mkdir()
    assert_bad_input(box, CANNOT_READ, "directory", "a.step")


def test_missing_file(box):
    assert_bad_input(box, CANNOT_READ, "No such file", "none.xyz")


def test_missing_step(box):
    need_brep()
    assert_bad_input(box, CANNOT_READ, "", "none.step")


def test_truncated_step(box):
    need_brep()
    whole = shared("data/spinner4.stp").read_bytes()
    for share in (0.01, 0.5, 0.99):
        path = box.write("cut.step", whole[:int(share * len(whole))])
        assert_bad_input(box, CANNOT_READ, "cut.step", path.name)


def test_text_named_step(box):
    need_brep()
    assert_bad_input(box, CANNOT_READ, "STEP", box.write("a.stp", "1 2 3\n4 5 6\n").name)


def test_empty_step(box):
    need_brep()
    assert_bad_input(box, CANNOT_READ, "", box.write("a.step", "").name)


def test_step_without_geometry(box):
    need_brep()
    text = """ISO-10303-21;
HEADER;
FILE_DESCRIPTION((''),'2;1');
FILE_NAME('empty','2024-01-01T00:00:00',(''),(''),'','','');
FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));
ENDSEC;
DATA;
#1=APPLICATION_CONTEXT('core data for automotive mechanical design processes');
ENDSEC;
END-ISO-10303-21;
"""
    assert_bad_input(box, INVALID, "geometry", box.write("a.step", text).name)


def test_formats_that_are_not_read(box):
    for name in ("a.gltf", "a.3mf", "a.FCStd"):
        assert_bad_input(box, CANNOT_READ, "this format is not read", box.write(name, "x").name)


# What nobody may read or write --------------------------------------------------------------------

def as_nobody(box):
    """Lets an unprivileged user run the program in the box; root may read and write everything."""
    if os.getuid() != 0:
        return {}
    parent = box.folder
    os.chmod(parent, 0o755)
    rights = {"user": NOBODY, "group": NOBODY}
    try:
        if box.run("--version", **rights).returncode == 0:
            return rights
    except PermissionError:
        pass
    raise Skip("running as root, and the user nobody cannot run the program where it is")


def test_no_permission_to_read(box):
    path = box.points("a.xyz", ring(6))
    path.chmod(0)
    rights = as_nobody(box)
    assert_fails(box, CANNOT_READ, "a.xyz: cannot be opened: Permission denied", "detect", "a.xyz", **rights)
    if has_brep():
        path.rename(box.folder / "a.step")
        assert_fails(box, CANNOT_READ, "Permission denied", "detect", "a.step", **rights)


def test_no_permission_to_write(box):
    box.points("a.xyz", ring(6))
    rights = as_nobody(box)
    assert_fails(box, USAGE, "r.json: cannot be written: Permission denied", "detect", "a.xyz", "--json", "r.json", **rights)


def test_read_only_report_is_kept(box):
    box.points("a.xyz", ring(6))
    box.write("r.json", "old").chmod(0o444)
    rights = as_nobody(box)
    if rights:
        os.chmod(box.folder, 0o777)
    assert_fails(box, USAGE, "r.json: cannot be written", "detect", "a.xyz", "--json", "r.json", **rights)
    assert (box.folder / "r.json").read_text() == "old"


def test_unwritable_output(box):
    box.points("a.xyz", ring(6))
    (box.folder / "folder").mkdir()
    for target, says in (("none/r.json", "No such file"), ("folder", "directory"), ("a.xyz/r.json", "Not a directory")):
        assert_fails(box, USAGE, says, "detect", "a.xyz", "--json", target)


def test_unwritable_output_is_said_before_the_work(box):
    start = time.monotonic()
    assert_fails(box, USAGE, "cannot be written", "detect", *long_run(box), "--json", "none/r.json")
    assert time.monotonic() - start < 30  # the work itself takes minutes


def test_report_over_the_input(box):
    path = box.points("a.xyz", ring(6))
    before = path.read_bytes()
    assert_fails(box, USAGE, "is the input itself", "detect", "a.xyz", "--json", "./a.xyz")
    assert path.read_bytes() == before


def test_full_disk(box):
    box.points("a.xyz", ring(6))
    done = box.run("detect", "a.xyz", "--json", "/dev/full")
    assert done.returncode == USAGE and b"No space left" in done.stderr, done
    one_sentence(done.stderr)
    assert b"C rotation" in done.stdout  # the work is not lost
    with open("/dev/full", "wb") as full:
        for args in (["a.xyz"], ["a.xyz", "--json", "-"]):
            done = box.run("detect", *args, stdout=full)
            assert done.returncode == USAGE and b"No space left" in done.stderr, done
            one_sentence(done.stderr)


def test_file_size_limit(box):
    box.points("a.xyz", cloud(300))
    done = box.run("detect", "a.xyz", "--json", "r.json", "--quiet", "--max-tolerance", "1e-4",
                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000)))
    assert done.returncode == USAGE, done
    one_sentence(done.stderr)
    assert box.files() == ["a.xyz"], box.files()


# Wrong usage --------------------------------------------------------------------------------------

def test_no_command(box):
    assert_fails(box, USAGE, "no command")
    assert_fails(box, USAGE, "did you mean detect?", "detct", "a.xyz")
    assert_fails(box, USAGE, "insym detect a.xyz", "a.xyz")
    assert_fails(box, USAGE, "INPUT is required", "detect")
    assert_fails(box, USAGE, "one INPUT", "detect", "a.xyz", "b.xyz")


def test_unknown_option(box):
    box.points("a.xyz", ring(6))
    assert_fails(box, USAGE, "did you mean --max-tolerance?", "detect", "a.xyz", "--max-tol", "0.1")
    assert_fails(box, USAGE, "did you mean --threads?", "detect", "a.xyz", "--thread=2")
    assert_fails(box, USAGE, "unknown option --frobnicate", "detect", "a.xyz", "--frobnicate")
    assert_fails(box, USAGE, "unknown option -z", "detect", "a.xyz", "-z")


def test_missing_value(box):
    box.points("a.xyz", ring(6))
    assert_fails(box, USAGE, "--json", "detect", "a.xyz", "--json")
    assert_fails(box, USAGE, "--json", "detect", "a.xyz", "--json", "--quiet")
    assert_fails(box, USAGE, "--json", "detect", "a.xyz", "--json", "")


def test_unknown_type(box):
    box.points("a.xyz", ring(6))
    assert_fails(box, USAGE, "unknown type 'Q'", "detect", "a.xyz", "--types", "C,Q")
    assert_fails(box, USAGE, "did you mean M?", "detect", "a.xyz", "--types", "mirror")
    assert_fails(box, USAGE, "--types", "detect", "a.xyz", "--types", "")
    assert_fails(box, USAGE, "--types", "detect", "a.xyz", "--types", "C,,M")


def test_unknown_method(box):
    box.points("a.xyz", ring(6))
    assert_fails(box, USAGE, "did you mean paper?", "detect", "a.xyz", "--method", "papper")


def assert_bad_numbers(box, option, values):
    box.points("a.xyz", ring(6))
    for value in values:
        assert_fails(box, USAGE, option, "detect", "a.xyz", option, value)
        assert_fails(box, USAGE, option, "detect", "a.xyz", f"{option}={value}")


def test_tolerance_zero(box):
    assert_bad_numbers(box, "--max-tolerance", ["0", "0.0", "-0"])


def test_tolerance_negative(box):
    assert_bad_numbers(box, "--max-tolerance", ["-1", "-0.05", "-1e-300"])


def test_tolerance_above_one(box):
    assert_bad_numbers(box, "--max-tolerance", ["1.0000001", "5", "1e308", "1e999", "inf"])


def test_tolerance_not_a_number(box):
    assert_bad_numbers(box, "--max-tolerance", ["nan", "much", "0,05", "0.05mm", "5%"])


def test_tolerance_below_resolution(box):
    assert_bad_numbers(box, "--max-tolerance", ["1e-7"])
    assert_fails(box, USAGE, "below the resolution", "detect", "a.xyz", "--resolution", "0.1", "--max-tolerance", "0.05")
    report = box.report("a.xyz", "--resolution", "1e-8", "--max-tolerance", "1e-7")
    assert math.isclose(report["options"]["max_tolerance"], 2e-7), report["options"]


def test_other_numbers(box):
    assert_bad_numbers(box, "--resolution", ["0", "-1", "1", "nan", "x"])
    assert_bad_numbers(box, "--limit", ["-1", "1.5", "x", "99999999999"])
    assert_bad_numbers(box, "--threads", ["-1", "1.5", "x", "100000"])
    assert_bad_numbers(box, "--time-limit", ["0", "-1", "nan", "inf", "x"])


def test_max_symmetries(box):
    """The first N of the whole list, and it is said how many there were; oracle: the whole list."""
    assert_bad_numbers(box, "--max-symmetries", ["-1", "1.5", "x"])
    box.points("a.xyz", np.vstack([ring(6), ring(6) + [0, 0, 5]]))
    for method in ("robust", "paper"):
        whole = box.report("a.xyz", "--method", method, "--quiet")
        count = len(whole["symmetries"])
        assert whole["status"] == "complete" and count > 3
        for most in ("0", str(count)):
            assert box.report("a.xyz", "--method", method, "--max-symmetries", most, "--quiet")["status"] == "complete"
        done = box.run("detect", "a.xyz", "--method", method, "--max-symmetries", "3", "--json", "-")
        assert done.returncode == STOPPED and f"the best 3 of {count} symmetries" in done.stderr.decode(), done
        few = checked_report(done.stdout)
        assert few["status"] == "result_limit" and few["stats"]["symmetries"] == 3
        assert [d["code"] for d in few["diagnostics"]] == ["result_limit"]
        assert few["symmetries"] == whole["symmetries"][:3] and few["group"] == whole["group"]


def test_max_chains(box):
    """Fewer chains by a lower tolerance, and it is said which; oracle: the whole search at that tolerance."""
    assert_bad_numbers(box, "--max-chains", ["-1", "1.5", "x"])
    box.points("a.xyz", np.random.default_rng(7).uniform(size=(40, 3)))
    paper = ("--method", "paper", "--max-tolerance", "0.05")
    for most in ("0", "1000000"):
        whole = box.report("a.xyz", *paper, "--max-chains", most, "--quiet")
        assert whole["status"] == "complete" and not whole["diagnostics"]
    reports = []
    for threads in ("1", "2"):
        done = box.run("detect", "a.xyz", *paper, "--max-chains", "500", "--threads", threads, "--json", "-")
        assert done.returncode == STOPPED and "more than 500 chains of four points" in done.stderr.decode(), done
        reports.append(checked_report(done.stdout))
    few = reports[0]
    assert few["cycles"] == reports[1]["cycles"] and few["symmetries"] == reports[1]["symmetries"]
    assert few["status"] == "result_limit" and [d["code"] for d in few["diagnostics"]] == ["chains"]
    share = few["options"]["max_tolerance"] / few["input"]["diameter"]
    assert 0.001 < share < 0.05 and any(abs(0.05 * 0.8**k - share) < 1e-12 for k in range(1, 20))
    again = box.report("a.xyz", "--method", "paper", "--max-tolerance", repr(share), "--max-chains", "0", "--quiet")
    assert again["cycles"] == few["cycles"] != whole["cycles"] and again["symmetries"] == few["symmetries"]


def test_regions(box):
    assert_bad_numbers(box, "--regions", ["0", "-1", "1.5", "x", "10001", "2,q", "2,xy", "2,", ",z", "2,x,y", "2 x"])
    box.points("a.xyz", np.vstack([ring(6), ring(6) + [0, 0, 5]]))
    assert_fails(box, USAGE, "add --method paper", "detect", "a.xyz", "--regions", "2")
    box.points("plane.xyz", ring(6, 2))
    assert_fails(box, USAGE, "no z", "detect", "plane.xyz", "--method", "paper", "--regions", "2,z")
    whole, one, two = (box.report("a.xyz", "--method", "paper", *more, "--quiet")
                       for more in ([], ["--regions", "1,y"], ["--regions", "2,z"]))
    for report in (whole, one, two):
        del report["timing"]
    assert one == whole and not whole["diagnostics"]
    assert [d["code"] for d in two["diagnostics"]] == ["regions"], two["diagnostics"]
    assert all(max(c["points"]) < 6 or min(c["points"]) >= 6 for c in two["cycles"]), two["cycles"]
    assert any(s["type"] == "C" and s["order"] == 6 and len(s["cycles"]) == 2 for s in two["symmetries"])


def test_bad_columns(box):
    assert_bad_numbers(box, "--columns", ["x", "x,y,q", "x,x,y", "x,y,"])


def test_columns_for_a_model(box):
    need_brep()
    assert_fails(box, USAGE, "--columns", "detect", shared("data/spinner4.stp"), "--columns", "x,y,z")


# Small sets with known answers --------------------------------------------------------------------

def types_of(report):
    return {(s["type"], s["order"]) for s in report["symmetries"]}


def test_two_points(box):
    report = box.report(box.points("a.xyz", [[0, 0, 0], [1, 0, 0]]).name)
    assert len(report["points"]) == 2 and report["status"] == "complete"


def test_nothing_found(box):
    done = box.run("detect", box.points("a.xyz", [[0, 0, 0], [1, 0, 0], [0, 2.3, 0.1], [4, 0.7, 9]]).name, "--types", "W")
    assert done.returncode == DONE and b"No symmetries found" in done.stdout, done


def test_ring(box):
    report = box.report(box.points("a.xyz", ring(7)).name)
    best = [s for s in report["symmetries"] if s["type"] == "C" and s["order"] == 7]
    assert best and best[0]["coverage"] == 1 and len(best[0]["cycles"][0]["points"]) == 7, types_of(report)


def test_collinear(box):
    x = np.outer(np.arange(6), [2.0, 1.0, 0.5])
    report = box.report(box.points("a.xyz", x).name, "--types", "T")
    steps = [s["isometry"]["step"] for s in report["symmetries"]]
    assert any(math.isclose(step, math.sqrt(5.25), rel_tol=1e-9) for step in steps), steps


def test_coplanar_in_space(box):
    x = np.array([[3.0 * i, 2.0 * j, 5.0] for i in range(4) for j in range(3)])
    report = box.report(box.points("a.xyz", x).name)
    assert report["input"]["dimension"] == 3 and report["status"] == "complete"
    assert any(math.isclose(s["isometry"]["step"], 3) for s in report["symmetries"] if s["type"] == "T")


def test_plane(box):
    report = box.report(box.points("a.txt", ring(5, 2)).name)
    assert report["input"]["dimension"] == 2 and ("C", 5) in types_of(report), types_of(report)


def test_labels_from_columns(box):
    x = np.column_stack([ring(6, 2), np.arange(6) % 2])
    report = box.report(box.points("a.txt", x).name, "--columns", "x,y,label")
    assert report["labels"] == [0, 1, 0, 1, 0, 1]
    assert ("C", 6) not in types_of(report) and ("C", 3) in types_of(report), types_of(report)


def test_chemists_xyz(box):
    rows = "".join(f"{'C' if i % 2 else 'H'} {x!r} {y!r} {z!r}\n" for i, (x, y, z) in enumerate(ring(8).tolist()))
    report = box.report(box.write("a.xyz", "8\nring of two elements\n" + rows).name)
    assert report["labels"] == [1, 6] * 4 and ("C", 4) in types_of(report) and ("C", 8) not in types_of(report)


def test_further_frames_are_noted(box):
    frame = "3\n\nC 0 0 0\nC 1 0 0\nC 0 1 0\n"
    path = box.write("a.xyz", frame * 2).name
    done = box.run("detect", path, "--json", "-")
    assert done.returncode == DONE and "a.xyz:6:" in one_sentence(done.stderr)
    report = checked_report(done.stdout)
    assert len(report["points"]) == 3 and report["diagnostics"][0]["code"] == "frames_skipped"
    assert not box.run("detect", path, "--json", "-", "--quiet").stderr


def test_csv_with_header(box):
    text = "X;Y;Z\r\n" + "".join(f"{x!r};{y!r};{z!r}\r\n" for x, y, z in ring(5).tolist())
    report = box.report(box.write("a.csv", text).name)
    assert report["input"]["format"] == "csv" and ("C", 5) in types_of(report)


def test_standard_input(box):
    text = "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in ring(6).tolist())
    report = box.report("-", input=text.encode())
    assert report["input"]["path"] == "-" and ("C", 6) in types_of(report)
    done = box.run("detect", "-", input=b"1 2 3\n1 x 3\n")
    assert done.returncode == INVALID and "standard input:2: 'x'" in one_sentence(done.stderr)
    assert box.run("detect", "-", input=b"").returncode == INVALID


def test_step_model(box):
    need_brep()
    path = shared("data/spinner4.stp")
    done = box.run("detect", path, "--points", "vertices", "--max-tolerance", "1e-3", "--json", "r.json")
    assert done.returncode == DONE and b"84 vertices" in done.stdout, done
    report = checked_report((box.folder / "r.json").read_bytes())
    assert report["input"]["format"] == "step" and report["options"]["points"] == "vertices"
    assert len(report["entities"]) == 84 and ("C", 4) in types_of(report)


def example(name):
    return Path(__file__).resolve().parents[2] / "examples" / name


def test_flange(box):
    """The bolt circle of 8 with a hole missing, made of what makes its holes (examples/README.md)."""
    need_brep()
    report = box.report(example("flange.step"))
    assert report["options"]["points"] == "representative" and report["input"]["unit"] == "mm"
    first = report["symmetries"][0]
    assert (first["type"], first["order"]) == ("C", 8), first
    assert [len(c["points"]) for c in first["cycles"]] == [7] * 7, first["cycles"]
    made_of = {(e["geometry"], e.get("role"), e.get("radius")) for c in first["cycles"] for e in
               (report["entities"][i] for i in c["points"])}
    assert made_of == {("cylinder", "hole", 7), ("cylinder", "hole", 13), ("circle", None, 7), ("circle", None, 13),
                       ("plane", None, None)}, made_of
    table = box.run("detect", example("flange.step"), "--limit", "1").stdout.decode()
    assert "7 holes, radius 7 mm" in table, table


def test_points_and_labels_of_a_model(box):
    need_brep()
    path = example("flange.step")

    def kinds(*args):
        report = box.report(path, "--types", "M", *args)
        return {e["kind"] for e in report["entities"]}, report

    assert kinds("--points", "faces")[0] == {"face"}
    both, report = kinds("--points", "faces,edges")
    assert both == {"edge", "face"} and report["options"]["points"] == "edges,faces"
    assert kinds("--points", "vertices")[0] == {"vertex"}
    assert kinds("--labels", "none")[1]["labels"] is None
    assert set(kinds("--labels", "kind")[1]["labels"]) == {0, 1}
    assert len(set(kinds()[1]["labels"])) > len(set(kinds("--label-tolerance", "0.9")[1]["labels"]))
    assert_fails(box, USAGE, "did you mean faces?", "detect", path, "--points", "edges,face")
    assert_fails(box, USAGE, "--labels", "detect", path, "--labels", "radius")
    assert_bad_numbers(box, "--label-tolerance", ["-1", "1", "nan", "x"])


def test_mesh(box):
    """A box of 1 x 2 x 3: 8 corners, 12 lines, 6 planes; three mirrors of all of them."""
    corners = [(x, y, z) for x in (0, 1) for y in (0, 2) for z in (0, 3)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    text = "OFF\n8 6 0\n" + "".join("%d %d %d\n" % p for p in corners) + "".join("4 %d %d %d %d\n" % q for q in quads)
    path = box.write("a.off", text)
    done = box.run("detect", path)
    if b"built without the reader" in done.stderr:
        raise Skip("the program was built without the reader of meshes")
    report = box.report(path)
    assert len(report["points"]) == 26 and report["input"]["unit"] is None and report["input"]["format"] == "off"
    whole = [s for s in report["symmetries"] if s["type"] == "M" and s["coverage"] == 1]
    assert len(whole) == 3, [s["isometry"] for s in whole]
    assert_bad_input(box, CANNOT_READ, "damaged", box.write("b.off", text[:60]).name)
    assert_bad_numbers(box, "--sharp-angle", ["0", "180", "nan", "x"])


def test_import_limits(box):
    need_brep()
    path = shared("data/Ventilator.stp")
    start = time.monotonic()
    assert_fails(box, CANNOT_READ, "longer than the import limit of 0.05 s", "detect", path, "--import-time", "0.05")
    assert time.monotonic() - start < 20
    assert_bad_numbers(box, "--import-time", ["0", "-1", "nan", "x"])
    assert_bad_numbers(box, "--import-memory", ["0", "1", "-1", "1.5", "x", "99999999999"])
    done = box.run("detect", path, "--import-memory", "16", "--types", "M", "--max-tolerance", "1e-6")
    assert done.returncode in (CANNOT_READ, DONE), done  # done: a build with a sanitizer, which limits no memory
    if done.returncode == CANNOT_READ:
        assert "memory" in one_sentence(done.stderr), done.stderr


def test_definitions_hold(box):
    data, checker = shared("data/spinner4_vertices.xyz"), shared("spec/check_report.py")
    # Without C2: the checker takes half-turns, which have type C, for rotations that no cycles confirm.
    done = box.run("detect", data, "--max-tolerance", "1e-3", "--types", "M,I,C,T,Z,S,W", "--json", "r.json", "--quiet")
    assert done.returncode == DONE and not done.stdout and not done.stderr, done
    check = subprocess.run([sys.executable, checker, "r.json", "--max", "60"], cwd=box.folder, capture_output=True)
    assert check.returncode == 0, check.stdout.decode()


# Where the results go -----------------------------------------------------------------------------

def test_table_and_report(box):
    path = box.points("a.xyz", ring(6)).name
    table = box.run("detect", path)
    assert b"a.xyz: 6 points" in table.stdout and b"C rotation" in table.stdout and not table.stderr
    both = box.run("detect", path, "--json", "r.json")
    assert b"C rotation" in both.stdout and checked_report((box.folder / "r.json").read_bytes())
    assert checked_report(box.run("detect", path, "--json", "-").stdout)
    assert checked_report(box.run("detect", path, "--json", "/dev/stdout").stdout)
    assert box.files() == ["a.xyz", "r.json"]


def test_quiet(box):
    path = box.points("a.xyz", np.vstack([ring(6), ring(6)])).name  # merged points are noted
    loud, quiet = box.run("detect", path), box.run("detect", path, "--quiet")
    assert b"merged" in loud.stderr and b"C rotation" in loud.stdout
    assert not quiet.stderr and b"C rotation" in quiet.stdout
    silent = box.run("detect", path, "--quiet", "--json", "r.json")
    assert silent.returncode == DONE and not silent.stderr and not silent.stdout
    assert checked_report((box.folder / "r.json").read_bytes())["input"]["merged_points"] == 6


def test_limit(box):
    path = box.points("a.xyz", ring(12)).name
    count = len(box.report(path)["symmetries"])
    assert count > 2
    assert f"{count - 2} more; --limit 0 shows all" in box.run("detect", path, "--all", "--limit", "2").stdout.decode()
    assert b" more;" not in box.run("detect", path, "--all", "--limit", "0").stdout


def test_what_follows_is_folded(box):
    path = box.points("a.xyz", ring(12)).name
    symmetries = box.report(path)["symmetries"]
    folded = sum(bool(s["implied_by"]) for s in symmetries)
    assert folded > 0
    assert f"{folded} that follow from these" in box.run("detect", path, "--limit", "0").stdout.decode()
    assert b"that follow from these" not in box.run("detect", path, "--limit", "0", "--all").stdout


def test_types_are_chosen(box):
    path = box.points("a.xyz", ring(6)).name
    report = box.report(path, "--types", "M,C2")
    assert report["options"]["types"] == ["M", "C2"]
    found = types_of(report)
    assert found and all(t == "M" or (t, order) == ("C", 2) for t, order in found), found


def test_report_replaces_whole_files_only(box):
    path = box.points("a.xyz", ring(6)).name
    (box.folder / "real.json").write_text("old")
    os.chmod(box.folder / "real.json", 0o640)
    (box.folder / "link.json").symlink_to("real.json")
    assert box.run("detect", path, "--json", "link.json").returncode == DONE
    assert (box.folder / "link.json").is_symlink() and (box.folder / "real.json").stat().st_mode & 0o777 == 0o640
    checked_report((box.folder / "real.json").read_bytes())
    box.write("bad.xyz", "1 2 3\n1 2 x\n")
    (box.folder / "real.json").write_text("old")
    assert box.run("detect", "bad.xyz", "--json", "real.json").returncode == INVALID
    assert (box.folder / "real.json").read_text() == "old"
    assert box.files() == ["a.xyz", "bad.xyz", "link.json", "real.json"]


def test_report_into_devices_and_pipes(box):
    path = box.points("a.xyz", ring(6)).name
    assert box.run("detect", path, "--json", "/dev/null", "--quiet").returncode == DONE
    assert os.path.exists("/dev/null") and not os.path.isfile("/dev/null")
    os.mkfifo(box.folder / "pipe")
    got = []
    reader = threading.Thread(target=lambda: got.append((box.folder / "pipe").read_bytes()))
    reader.start()
    assert box.run("detect", path, "--json", "pipe", "--quiet").returncode == DONE
    reader.join(10)
    checked_report(got[0])


# Things to look at --------------------------------------------------------------------------------

def need_view(box):
    if b"built without pages" in box.run("detect", "a.xyz", "--html", "r.html").stderr:
        raise Skip("the program was built without pages and pictures")
    (box.folder / "r.html").unlink(missing_ok=True)


def test_page_picture_and_scene(box):
    """That the files are of their kinds; what is in them is looked at in tests/view and tests/browser."""
    path = box.points("a.xyz", ring(6, 2)).name
    need_view(box)
    done = box.run("detect", path, "--html", "p.html", "--gltf", "s.glb", "--png", "i.png", "--json", "r.json", "--quiet")
    assert done.returncode == DONE and not done.stdout and not done.stderr, done
    starts = {"p.html": b"<!doctype html>", "s.glb": b"glTF\x02", "i.png": b"\x89PNG", "r.json": b"{"}
    for name, start in starts.items():
        assert (box.folder / name).read_bytes().startswith(start), name
    assert box.files() == ["a.xyz", *sorted(starts)]


def test_page_that_cannot_be_written(box):
    path = box.points("a.xyz", ring(6)).name
    need_view(box)
    for option in ("--html", "--png", "--gltf"):
        assert_fails(box, USAGE, "no/r", "detect", path, option, "no/r")
        assert_fails(box, USAGE, "is the input itself", "detect", path, option, path)
        assert_fails(box, USAGE, "takes a file", "detect", path, option, "-")
        assert_fails(box, USAGE, "the same file", "detect", path, option, "r", "--json", "r")


def test_view_opens_the_page(box):
    path = box.points("<a b>.xyz", ring(6)).name
    box.points("a.xyz", ring(6))
    need_view(box)
    (box.folder / "a.xyz").unlink()
    opener = box.write("xdg-open", f"#!/bin/sh\nprintf '%s' \"$1\" > '{box.folder}/opened'\n")
    opener.chmod(0o755)
    environment = {**os.environ, "PATH": str(box.folder), "TMPDIR": str(box.folder)}
    done = box.run("view", path, env=environment)
    assert done.returncode == DONE and not done.stderr, done
    page = Path(done.stdout.decode().rstrip("\n"))
    assert page.parent.parent == box.folder and page.name == "<a b>.html" and page.parent.stat().st_mode & 0o777 == 0o700
    for _ in range(100):
        if (box.folder / "opened").exists():
            break
        time.sleep(0.1)
    assert (box.folder / "opened").read_text() == str(page) and page.read_bytes().startswith(b"<!doctype html>")
    # No browser: the page is there all the same, and the path is printed.
    opener.unlink()
    done = box.run("view", path, env=environment)
    assert done.returncode == DONE and "no browser" in one_sentence(done.stderr), done
    assert Path(done.stdout.decode().rstrip("\n")).exists()
    before = box.files()
    assert box.run("view", "no.xyz", env=environment).returncode == CANNOT_READ and box.files() == before


def run_with_closed_reader(box, *args):
    read_end, write_end = os.pipe()
    os.close(read_end)
    try:
        return box.run(*args, stdout=write_end)
    finally:
        os.close(write_end)


def test_reader_has_gone(box):
    path = box.points("a.xyz", ring(12)).name
    for args in (["--limit", "0"], ["--json", "-"], ["--json", "r.json"]):
        done = run_with_closed_reader(box, "detect", path, *args)
        assert done.returncode == DONE and not done.stderr, (args, done)
    checked_report((box.folder / "r.json").read_bytes())
    for args in (["--help"], ["--version"]):
        done = run_with_closed_reader(box, *args)
        assert done.returncode == DONE and not done.stderr, (args, done)


def test_reader_stops_early(box):
    box.points("a.xyz", ring(24))
    line = f"'{box.program}' detect a.xyz --json - | head -1; exit ${{PIPESTATUS[0]}}"
    done = subprocess.run(["bash", "-c", line], cwd=box.folder, capture_output=True, timeout=60)
    assert done.returncode == DONE and done.stdout == b"{\n" and not done.stderr, done


def test_standard_output_closed(box):
    box.points("a.xyz", ring(6))
    for line, status in ((">&-", USAGE), ("--json - >&-", USAGE), ("--json r.json --quiet >&-", DONE),
                         ("--json s.json --quiet >&- 2>&- <&-", DONE)):
        done = subprocess.run(["bash", "-c", f"'{box.program}' detect a.xyz {line}"], cwd=box.folder, capture_output=True)
        assert done.returncode == status, (line, done)
        if status == USAGE:
            one_sentence(done.stderr)
    for name in ("r.json", "s.json"):
        checked_report((box.folder / name).read_bytes())


def test_strange_file_names(box):
    for name in (b"caf\xc3\xa9 %s.xyz", b"\xff\xfe.xyz", b"a\nb\x1b[1m.xyz"):
        path = os.path.join(os.fsencode(box.folder), name)
        with open(path, "wb") as file:
            file.write(b"".join(b"%r %r %r\n" % tuple(row) for row in ring(5).tolist()))
        done = subprocess.run([box.program, "detect", path, "--json", "-"], capture_output=True)
        assert done.returncode == DONE, done
        assert checked_report(done.stdout)["input"]["path"] == path.decode("utf-8", "replace")
        missing = subprocess.run([box.program, "detect", path + b"z"], capture_output=True)
        assert missing.returncode == CANNOT_READ and missing.stderr.count(b"\n") == 1, missing


def test_help_and_version(box):
    for args in (["--help"], ["-h"], ["detect", "--help"]):
        done = box.run(*args)
        assert done.returncode == DONE and not done.stderr and b"Exit status" in done.stdout, done
    text = box.run("detect", "--help").stdout.decode()
    for option in ("--json", "--types", "--max-tolerance", "--resolution", "--limit", "--threads", "--time-limit",
                   "--columns", "--quiet", "Examples"):
        assert option in text, option
    assert re.fullmatch(r"insym \d+\.\d+\.\d+\n", box.run("--version").stdout.decode())


# Stopping early -----------------------------------------------------------------------------------

def wait_until_signals_are_handled(run):
    """Until the program has set up its handlers, a signal would end it like any other."""
    for _ in range(600):
        assert run.poll() is None, "the run is over before the signal: it is too short for this test"
        caught = re.search(r"^SigCgt:\s*([0-9a-f]+)", Path(f"/proc/{run.pid}/status").read_text(), re.MULTILINE)
        if int(caught[1], 16) >> (signal.SIGINT - 1) & 1:
            return
        time.sleep(0.1)
    raise AssertionError("no handler for SIGINT")


def stop_with_signal(box, number, delay):
    run = box.start("detect", *long_run(box), "--json", "r.json")
    wait_until_signals_are_handled(run)
    time.sleep(delay)
    assert run.poll() is None, "the run is over before the signal: it is too short for this test"
    start = time.monotonic()
    run.send_signal(number)
    out, err = run.communicate(timeout=60)
    assert time.monotonic() - start < 30, "the program does not stop soon"
    return run.returncode, out, err


def test_interrupt(box):
    for number, delay in ((signal.SIGINT, 1.0), (signal.SIGTERM, 0.0)):
        status, out, err = stop_with_signal(box, number, delay)
        assert status == STOPPED, (status, err)
        assert "interrupt" in one_sentence(err) and b"Stopped by an interrupt" in out
        assert checked_report((box.folder / "r.json").read_bytes())["status"] == "cancelled"
        assert box.files() == ["cloud.xyz", "r.json"]
        (box.folder / "r.json").unlink()


def test_second_interrupt_ends_at_once(box):
    run = box.start("detect", *long_run(box), "--json", "r.json")
    wait_until_signals_are_handled(run)
    run.send_signal(signal.SIGSTOP)  # both wait until it goes on
    run.send_signal(signal.SIGINT)
    run.send_signal(signal.SIGTERM)
    run.send_signal(signal.SIGCONT)
    run.communicate(timeout=10)
    assert run.returncode in (-signal.SIGINT, -signal.SIGTERM), run.returncode
    assert box.files() == ["cloud.xyz"], box.files()


def test_interrupt_while_reading_standard_input(box):
    run = subprocess.Popen([box.program, "detect", "-", "--json", "r.json"], stdin=subprocess.PIPE,
                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=box.folder)
    time.sleep(0.5)
    run.send_signal(signal.SIGINT)
    assert run.wait(timeout=10) == -signal.SIGINT
    run.communicate()
    assert not box.files()


def test_time_limit(box):
    args = long_run(box)
    for limit in ("0.01", "1"):
        start = time.monotonic()
        done = box.run("detect", *args, "--time-limit", limit, "--json", "r.json")
        assert time.monotonic() - start < float(limit) + 30
        assert done.returncode == STOPPED, done
        assert "time limit" in one_sentence(done.stderr) and b"Stopped at the time limit" in done.stdout
        assert checked_report((box.folder / "r.json").read_bytes())["status"] == "time_limit"


def test_time_limit_of_a_model(box):
    need_brep()
    done = box.run("detect", shared("data/Ventilator.stp"), "--time-limit", "0.01", "--json", "-")
    assert done.returncode == STOPPED and checked_report(done.stdout)["status"] == "time_limit", done


def test_time_limit_that_is_not_reached(box):
    done = box.run("detect", box.points("a.xyz", ring(6)).name, "--time-limit", "1e300")
    assert done.returncode == DONE and not done.stderr, done


# Progress -----------------------------------------------------------------------------------------

def run_in_terminal(box, *args):
    """Returns what the program writes to a terminal as its standard error."""
    import pty
    leader, follower = pty.openpty()
    run = subprocess.Popen([box.program, *args], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=follower,
                           cwd=box.folder)
    os.close(follower)
    written = b""
    while True:
        try:
            data = os.read(leader, 65536)
        except OSError:
            break
        if not data:
            break
        written += data
    os.close(leader)
    run.wait(timeout=60)
    return written.decode()


def screen_of(written):
    """What a terminal shows in the end: lines, overwritten after a carriage return."""
    lines = []
    for line in written.replace("\r\n", "\n").split("\n"):
        shown = []
        for part in line.split("\r"):
            shown[:len(part)] = part
        lines.append("".join(shown).rstrip())
    return "\n".join(lines).strip()


def test_progress_only_on_a_terminal(box):
    args = ["detect", *long_run(box), "--time-limit", "2"]
    written = run_in_terminal(box, *args)
    assert "%" in written and len(written.split("\r")) > 5, written
    assert re.fullmatch(r"insym: stopped at the time limit[^\n]*", screen_of(written)), screen_of(written)
    assert run_in_terminal(box, *args, "--quiet") == ""
    assert b"%" not in box.run(*args).stderr


# The same bytes -----------------------------------------------------------------------------------

def without_timing(data):
    text, times = re.subn(rb'^"timing": .*$', b"", data, flags=re.MULTILINE)
    assert times == 1
    return text


def assert_same_bytes(box, *args):
    reports = set()
    for threads in (1, 2, 4, 1, 2, 4):
        done = box.run("detect", *args, "--threads", str(threads), "--json", "-", "--quiet")
        assert done.returncode == DONE, done
        checked_report(done.stdout)
        reports.add(without_timing(done.stdout))
    assert len(reports) == 1, f"{len(reports)} different reports"


def test_same_bytes_for_any_threads(box):
    rng = np.random.default_rng(3)
    x = np.vstack([ring(8), ring(8) * [2, 2, 1], rng.uniform(-2, 2, size=(60, 3))])
    assert_same_bytes(box, box.points("a.xyz", x + rng.normal(scale=1e-4, size=x.shape)).name, "--max-tolerance", "0.01")


def test_same_bytes_for_real_vertices(box):
    assert_same_bytes(box, shared("data/spinner4_vertices.xyz"), "--max-tolerance", "1e-3")


# --------------------------------------------------------------------------------------------------

def run_test(program, name):
    with tempfile.TemporaryDirectory(prefix="insym_cli_") as folder:
        try:
            globals()[name](Box(program, folder))
            return "passed"
        except Skip as why:
            print(f"{name} skipped: {why}")
            return "skipped"
        except Exception:
            traceback.print_exc()
            return "failed"


def main():
    program = str(Path(sys.argv[1]).resolve())
    names = sys.argv[2:] or [name for name in globals() if name.startswith("test_")]
    outcomes = []
    for name in names:
        outcomes.append(run_test(program, name))
        print(f"{name}: {outcomes[-1]}", flush=True)
    sys.exit(1 if "failed" in outcomes else 77 if set(outcomes) == {"skipped"} else 0)


if __name__ == "__main__":
    main()
