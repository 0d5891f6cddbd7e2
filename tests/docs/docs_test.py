#!/usr/bin/python3
"""The documentation against the program: docs_test.py PROGRAM SOURCES.

Oracle: every command of README.md and docs/ that begins with "$ " ends with status 0 when it is run as written, from a
folder that looks like the project's, and prints first what the page shows below it, times apart; the options of `insym detect --help` and of docs/command_line.md are the same.
"""
import os
import re
import subprocess
import sys
import tempfile
from itertools import takewhile
from pathlib import Path

PROGRAM, SOURCES = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()


COMMAND = re.compile(r"(    )?\$ (.+)")


def commands():
    """(page, command, the lines shown below it)."""
    for page in [SOURCES / "README.md", *sorted((SOURCES / "docs").glob("*.md"))]:
        lines = page.read_text().splitlines()
        for i, line in enumerate(lines):
            if not (found := COMMAND.match(line)):
                continue
            indent = found[1] or ""  # such a block ends where the indent does; others with a fence
            shown = takewhile(lambda text: not COMMAND.match(text) and not text.startswith("```")
                              and (not text or text.startswith(indent)), lines[i + 1:])
            yield page.name, found[2], [text.strip() for text in shown if text]


def without_time(line):
    return re.sub(r"(under )?[0-9.]+ s$", "", line.strip())


def check_shown(page, command, shown, printed):
    printed = [line for line in printed.splitlines() if line]
    assert len(printed) >= len(shown), f"{page}: {command} prints less than is shown"
    for line, got in zip(shown, printed):
        assert without_time(line) == without_time(got), f"{page}: {command}\nshown:   {line}\nprinted: {got}"


def run_all(folder):
    (folder / "build").mkdir()
    (folder / "build/insym").symlink_to(PROGRAM)
    (folder / "examples").symlink_to(SOURCES / "examples")
    opener = folder / "bin/xdg-open"  # no test opens a browser
    opener.parent.mkdir()
    opener.write_text("#!/bin/sh\n")
    opener.chmod(0o755)
    environment = {**os.environ, "PATH": f"{opener.parent}:{os.environ['PATH']}", "TMPDIR": str(folder)}
    count = shows = 0
    for page, command, shown in commands():
        done = subprocess.run(["bash", "-o", "pipefail", "-c", command], cwd=folder, env=environment, capture_output=True,
                              text=True, timeout=300)
        assert done.returncode == 0, f"{page}: {command}\n{done.stdout}{done.stderr}"
        check_shown(page, command, shown, done.stdout)
        count += 1
        shows += bool(shown)
    assert count >= 10 and shows >= 2, f"only {count} commands were found, {shows} of them with what they print"
    print(f"{count} commands were run, {shows} of them against what is shown")


def check_options():
    text = subprocess.run([PROGRAM, "detect", "--help"], capture_output=True, text=True, check=True).stdout
    offered = set(re.findall(r"^\s+(?:-h,)?(--[a-z-]+)", text, re.MULTILINE)) - {"--help"}
    described = set(re.findall(r"`(--[a-z-]+)", (SOURCES / "docs/command_line.md").read_text()))
    assert offered == described, f"offered, not described: {offered - described}; the other way: {described - offered}"


check_options()
with tempfile.TemporaryDirectory() as scratch:
    run_all(Path(scratch))
