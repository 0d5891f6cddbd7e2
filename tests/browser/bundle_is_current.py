#!/usr/bin/python3
"""Builds the page anew: bundle_is_current.py VIEWER FOLDER [--update]; 77: not possible here.

Oracle: the committed bundle, byte for byte. FOLDER holds node_modules (modules.py). --update replaces the bundle.
"""
import shutil
import subprocess
import sys
from pathlib import Path

SKIPPED = 77


def main():
    viewer, folder = Path(sys.argv[1]), Path(sys.argv[2])
    if not (folder / "node_modules").is_dir() or not shutil.which("node"):
        print("skipped: the packages of viewer/ are not installed here")
        return SKIPPED
    for name in ("src", "dist"):
        shutil.rmtree(folder / name, ignore_errors=True)
    shutil.copytree(viewer / "src", folder / "src")
    for name in ("page.html", "vite.config.js", "tsconfig.json", "package.json"):
        shutil.copy(viewer / name, folder / name)
    done = subprocess.run(["npm", "run", "build"], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        print(done.stdout + done.stderr)
        return 1
    built, committed = folder / "dist/page.html", viewer / "dist/page.html"
    if "--update" in sys.argv:
        shutil.copy(built, committed)
    if built.read_bytes() != committed.read_bytes():
        print(f"{committed} is not what viewer/ builds; run make page and commit it")
        return 1
    size = len(built.read_bytes())
    print(f"the page without data has {size} bytes")
    assert size < 1500000, "the page has grown beyond what was promised"
    return 0


sys.exit(main())
