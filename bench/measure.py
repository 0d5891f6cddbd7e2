"""Running the program under the clock, for the runners beside this file."""
import json
import os
import platform
import re
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

# Before numpy is loaded: its threads would disturb what is measured.
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[variable] = "1"

ROOT = Path(__file__).resolve().parents[1]
POINT_FORMATS = {".xyz", ".csv", ".txt"}

# A process inherits the peak memory of the one that starts it, and the runners are large: this one is small.
LAUNCHER = """
import os, sys
child = os.posix_spawn(sys.argv[1], sys.argv[1:], os.environ)
_, status, usage = os.wait4(child, 0)
print(os.waitstatus_to_exitcode(status), usage.ru_utime, usage.ru_maxrss)
"""
STOPPED = 5  # exit status of a run that a time limit ended


@dataclass
class Run:
    report: dict
    raw: bytes       # of the report
    cpu_s: float     # of the whole program, with reading and writing
    peak_mib: float  # of the program or, if that is more, of the process in which it reads models

    @property
    def timing(self):
        return self.report["timing"]

    @property
    def stopped(self):
        return self.report["status"] in ("time_limit", "cancelled")

    @property
    def limited(self):
        """Was the tolerance lowered (--max-chains)? Then the share of the diameter up to which was searched."""
        if not any(d["code"] == "chains" for d in self.report["diagnostics"]):
            return None
        return self.report["options"]["max_tolerance"] / self.report["input"]["diameter"]

    @property
    def mark(self):
        """What a figure must say beside it: that the run is not of all that was asked for."""
        if self.stopped:
            return " (stopped)"
        return "" if self.limited is None else f" (up to {self.limited:.3g})"

    def bytes_without_timing(self):
        return re.sub(rb'"timing": *\{[^}]*\}', b"", self.raw)


def arguments(path, method=None, share=None, kinds=None, points=None, threads=None, regions=None,
              max_chains=None, time_limit=None):
    """The arguments of insym detect; what is None is left at its default."""
    options = {"--method": method, "--max-tolerance": None if share is None else repr(share), "--types": kinds, "--threads": threads, "--regions": regions, "--max-chains": max_chains,
               "--points": None if path.suffix in POINT_FORMATS else points, "--time-limit": time_limit}
    given = [str(word) for item in options.items() if item[1] is not None for word in item]
    return ["detect", str(path), *given, "--quiet"]


def detect(insym, path, **options):
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "report.json"
        words = [sys.executable, "-S", "-c", LAUNCHER, str(insym), *arguments(Path(path), **options), "--json", str(out)]
        done = subprocess.run(words, check=True, capture_output=True, text=True)
        status, cpu_s, peak_kib = done.stdout.split()
        if int(status) not in (0, STOPPED):
            raise RuntimeError(f"insym ends with status {status} on {path}: {done.stderr.strip()}")
        raw = out.read_bytes()
    return Run(json.loads(raw), raw, float(cpu_s), int(peak_kib) / 1024)


def take_turns(repetitions, measurements, enough_s=60):
    """Results of each of the functions, which take turns so that a busy machine slows all alike. What has taken
    `enough_s` seconds is not repeated further."""
    results, spent = [[] for _ in measurements], [0.0] * len(measurements)
    for _ in range(repetitions):
        for k, measure in enumerate(measurements):
            if spent[k] < enough_s:
                start = time.perf_counter()
                results[k].append(measure())
                spent[k] += time.perf_counter() - start
    return results


def machine():
    processor = platform.processor() or platform.machine()
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            processor = line.split(":", 1)[1].strip()
            break
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    return f"{processor}, {os.cpu_count()} cores, {memory:.0f} GiB"


def version(insym):
    return subprocess.run([insym, "--version"], check=True, capture_output=True, text=True).stdout.strip()


def load_average():
    return os.getloadavg()[0]


def reference(shared):
    """The definitions as a program, ../shared/spec/reference.py."""
    sys.dont_write_bytecode = True  # the folder is read-only reference material
    folder = str(shared / "spec")
    if folder not in sys.path:
        sys.path.insert(0, folder)
    import reference as module
    return module
