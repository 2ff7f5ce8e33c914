#!/usr/bin/python3
"""The committed dashboard is what its generator writes."""

import pathlib
import shutil
import tempfile
import unittest

import support

FOLDER = support.DEPLOY / "monitoring" / "dashboard"


class Generator(unittest.TestCase):

    def test_writes_the_committed_file(self):
        with tempfile.TemporaryDirectory() as scratch:
            work = pathlib.Path(scratch)
            for name in ("build.mjs", "package.json", "package-lock.json"):
                shutil.copy(FOLDER / name, work / name)
            support.install_node_packages(work)
            support.run("node", work / "build.mjs", work / "traverse.json")

            self.assertEqual((FOLDER / "traverse.json").read_text(), (work / "traverse.json").read_text(),
                             "run `npm ci && node build.mjs` in deploy/monitoring/dashboard")


if __name__ == "__main__":
    support.main("node", "npm")
