#!/usr/bin/env python3
"""The tree of tests mirrors the sources; tests/README.md says where the others are tested."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def stated_folders():
    """[folder] of the table in tests/README.md."""
    text = (ROOT / "tests/README.md").read_text(encoding="utf-8")
    table = text.split("| sources without tests of their own | tested by |\n|---|---|\n")[1].split("\n\n")[0]
    return re.findall(r"`([\w/]+)/`", "\n".join(row.split("|")[1] for row in table.splitlines()))


def untested():
    """Sources that no test has the name of, and whose header no test includes; programs' main.cc are run."""
    tests = list((ROOT / "tests").rglob("*_test.cc"))
    named = {str(test.relative_to(ROOT / "tests")).removesuffix("_test.cc") for test in tests}
    included = set()
    for test in tests:
        included.update(re.findall(r'#include "([^"]+)\.h"', test.read_text(encoding="utf-8")))
    for part in ("engine", "client", "server"):
        for source in sorted((ROOT / part).rglob("*.cc")):
            name = str(source.relative_to(ROOT)).removesuffix(".cc")
            if source.name != "main.cc" and name not in named and name not in included:
                yield source.relative_to(ROOT)


class MirrorTest(unittest.TestCase):
    def test_every_source_has_tests_or_a_reason(self):
        folders = stated_folders()
        missing = [str(source) for source in untested()
                   if not any(source.is_relative_to(folder) for folder in folders)]
        self.assertEqual(missing, [])

    def test_no_reason_outlives_its_sources(self):
        sources = list(untested())
        self.assertEqual([folder for folder in stated_folders()
                          if not any(source.is_relative_to(folder) for source in sources)], [])


if __name__ == "__main__":
    unittest.main()
