"""What the golden tests share: where things are, running the program, skipping."""
import argparse
import importlib
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

SKIPPED = 77  # ctest's SKIP_RETURN_CODE

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(threads, "1")  # small matrices: numpy's threads only cost


def skip(sentence):
    print("SKIPPED:", sentence)
    sys.exit(SKIPPED)


def arguments(description):
    """A parser with the options of every golden script."""
    parser = argparse.ArgumentParser(description=description)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("--insym", type=Path, default=root / "build" / "insym", help="the program")
    parser.add_argument("--shared", type=Path, default=root.parent / "shared", help="specification and data")
    parser.add_argument("--full", action="store_true", help="every case; takes minutes")
    return parser


def specification(shared, module):
    """reference.py or check_report.py, or the end of the test where they or numpy are absent."""
    if not (shared / "spec" / f"{module}.py").exists():
        skip(f"{shared}/spec/{module}.py is absent")
    sys.dont_write_bytecode = True  # the folder is read-only reference material
    sys.path.insert(0, str(shared / "spec"))
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as missing:
        skip(f"Python's {missing.name} is absent (Debian: python3-{missing.name})")


def detect(insym, path, max_tolerance, *more, points="vertices"):
    """The report of method paper on a file, of a model on its vertices unless told otherwise; an exception
    where the program fails."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "report.json"
        command = [insym.resolve(), "detect", path, "--method", "paper", "--points", points, "--json", out, "--quiet",
                   "--max-tolerance", repr(float(max_tolerance)), *more]
        run = subprocess.run([str(part) for part in command], capture_output=True, text=True)
        if run.returncode != 0:
            raise RuntimeError(f"{' '.join(map(str, command))}: exit status {run.returncode}: {run.stderr.strip()}")
        return json.loads(out.read_text())
