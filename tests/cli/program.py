"""The program insym as a test sees it: run in a folder of its own, its failures judged."""
import re
import subprocess
from pathlib import Path

from report_schema import checked_report

DONE, DEFECT, USAGE, CANNOT_READ, INVALID, STOPPED = range(6)  # the exit statuses of report.md


class Box:
    """A folder of its own for one test, and the program run in it."""

    def __init__(self, program, folder):
        self.program = program
        self.folder = Path(folder)

    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def points(self, name, x):
        return self.write(name, "".join(" ".join(repr(float(v)) for v in row) + "\n" for row in x))

    def run(self, *args, **kwargs):
        if "input" not in kwargs:
            kwargs.setdefault("stdin", subprocess.DEVNULL)
        kwargs.setdefault("stdout", subprocess.PIPE)
        return subprocess.run([self.program, *map(str, args)], stderr=subprocess.PIPE, cwd=self.folder,
                              timeout=100, **kwargs)

    def start(self, *args, **kwargs):
        return subprocess.Popen([self.program, *map(str, args)], stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=self.folder, **kwargs)

    def files(self):
        return sorted(p.name for p in self.folder.iterdir())

    def report(self, *args, **kwargs):
        """Runs, expects success, returns the report."""
        done = self.run("detect", *args, "--json", "-", **kwargs)
        assert done.returncode == DONE, done
        return checked_report(done.stdout)


def one_sentence(stderr):
    text = stderr.decode()
    assert re.fullmatch(r"insym: [^\n]+\n", text), f"not one sentence: {text!r}"
    assert "defect of the program" not in text, text
    return text


def assert_fails(box, status, says, *args, **kwargs):
    """The run fails with that status and one sentence, and leaves no file behind."""
    before = box.files()
    done = box.run(*args, **kwargs)
    assert done.returncode == status, f"exit status {done.returncode}, not {status}: {done.stderr!r}"
    text = one_sentence(done.stderr)
    assert says in text, f"{says!r} is not in {text!r}"
    assert not done.stdout, done.stdout
    assert box.files() == before, box.files()
    return text


def assert_bad_input(box, status, says, path, *args):
    """The same for an input: with and without a report asked for."""
    assert_fails(box, status, says, "detect", path, *args)
    assert_fails(box, status, says, "detect", path, "--json", "r.json", *args)
    text = assert_fails(box, status, says, "detect", path, "--json", "-", "--quiet", *args)
    assert str(path) in text, f"the sentence does not name the file: {text}"
