#!/usr/bin/python3
"""The documentation against the program: docs_test.py PROGRAM SOURCES.

Oracle: every command of README.md and docs/ that begins with "$ " ends with status 0 when it is run as written, from a
folder that looks like the project's; the options of `insym detect --help` and of docs/command_line.md are the same.
"""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAM, SOURCES = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()


def commands():
    for page in [SOURCES / "README.md", *sorted((SOURCES / "docs").glob("*.md"))]:
        for line in page.read_text().splitlines():
            found = re.match(r"(?:    )?\$ (.+)", line)
            if found:
                yield page.name, found[1]


def run_all(folder):
    (folder / "build").mkdir()
    (folder / "build/insym").symlink_to(PROGRAM)
    (folder / "examples").symlink_to(SOURCES / "examples")
    opener = folder / "bin/xdg-open"  # no test opens a browser
    opener.parent.mkdir()
    opener.write_text("#!/bin/sh\n")
    opener.chmod(0o755)
    environment = {**os.environ, "PATH": f"{opener.parent}:{os.environ['PATH']}", "TMPDIR": str(folder)}
    count = 0
    for page, command in commands():
        done = subprocess.run(["bash", "-o", "pipefail", "-c", command], cwd=folder, env=environment, capture_output=True,
                              text=True, timeout=300)
        assert done.returncode == 0, f"{page}: {command}\n{done.stdout}{done.stderr}"
        count += 1
    assert count >= 10, f"only {count} commands were found"
    print(f"{count} commands were run")


def check_options():
    text = subprocess.run([PROGRAM, "detect", "--help"], capture_output=True, text=True, check=True).stdout
    offered = set(re.findall(r"^\s+(?:-h,)?(--[a-z-]+)", text, re.MULTILINE)) - {"--help"}
    described = set(re.findall(r"`(--[a-z-]+)", (SOURCES / "docs/command_line.md").read_text()))
    assert offered == described, f"offered, not described: {offered - described}; the other way: {described - offered}"


check_options()
with tempfile.TemporaryDirectory() as scratch:
    run_all(Path(scratch))
