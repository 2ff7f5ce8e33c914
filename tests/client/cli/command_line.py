"""Runs the built command line and holds it to what it says.

The environment names it: TRAVERSE.
"""
import os
import re
import resource
import subprocess
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
TESTS = os.path.dirname(os.path.dirname(HERE))

TRAVERSE = os.environ["TRAVERSE"]
INSTANCES = os.path.join(TESTS, "bench", "instances")
SMALL = os.path.join(TESTS, "data", "damat", "two_islands.damat")
PART1 = os.path.join(INSTANCES, "part1.damat")

DONE, INPUT, USAGE, SERVER = 0, 1, 2, 3


def read(name):
    with open(name, encoding="utf-8") as file:
        return file.read()


def island(records, contours=1, rasters=0):
    return f"nF,1\nF1,1\nI1,{contours},{rasters}\n{records}\n"


class CommandLine(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def put(self, name, content):
        mode = "wb" if isinstance(content, bytes) else "w"
        with open(self.path(name), mode) as file:
            file.write(content)
        return self.path(name)

    def run_traverse(self, *arguments, stdin=b"", env=None, limit=None):
        ran = subprocess.run([TRAVERSE, *arguments], input=stdin, capture_output=True, timeout=120,
                             env={**os.environ, **(env or {})},
                             preexec_fn=limit and (lambda: resource.setrlimit(*limit)))
        return ran.returncode, ran.stdout.decode(), ran.stderr.decode()

    def succeed(self, *arguments, **kw):
        """What was printed; on a busy machine the progress is told besides, and nothing else."""
        code, out, err = self.run_traverse(*arguments, **kw)
        told = [line for line in err.splitlines() if not re.match(r"\S+: \d+/\d+ layers", line)]
        self.assertEqual((code, told), (DONE, []))
        return out

    def fail_with(self, code, *arguments, **kw):
        """The one line of the failure; nothing else may be printed."""
        got, out, err = self.run_traverse(*arguments, **kw)
        self.assertEqual((got, out), (code, ""), err)
        self.assertEqual(err.count("\n"), 1, err)
        return err.rstrip("\n")
