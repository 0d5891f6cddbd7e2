#!/usr/bin/python3
"""Installs what the page is built and tested with: modules.py VIEWER FOLDER; exit status 77: not possible here.

FOLDER/node_modules is made by `npm ci` from the lock file of VIEWER, once for each state of that file.
"""
import json
import shutil
import subprocess
import sys
from pathlib import Path

SKIPPED = 77


def main():
    viewer, folder = Path(sys.argv[1]), Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    lock, installed = viewer / "package-lock.json", folder / "installed.json"
    if installed.exists() and installed.read_bytes() == lock.read_bytes():
        return 0
    if not shutil.which("npm"):
        print("skipped: there is no npm here")
        return SKIPPED
    # Without the alias among the overrides, on which the npm of Debian 12 (9.2) fails; the lock file has it too.
    package = json.loads((viewer / "package.json").read_text())
    package.pop("overrides", None)
    (folder / "package.json").write_text(json.dumps(package))
    shutil.copy(lock, folder / lock.name)
    # No scripts of packages: nothing here needs one.
    command = ["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--prefer-offline"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        print("skipped: npm cannot install the packages, as without a network:\n" + done.stderr[-600:])
        return SKIPPED
    shutil.copy(lock, installed)
    return 0


sys.exit(main())
