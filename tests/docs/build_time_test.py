#!/usr/bin/env python3
"""README's minutes stay true: compiling everything takes so many times as long as reading the shared headers."""
import os
import pathlib
import sys
import unittest

BUILD = pathlib.Path(os.environ.get("TRAVERSE_BUILD", "build/release"))

# As it was when the README's minutes were measured. Headers of libraries are all that the precompiled ones are made
# of, so that a machine's speed, and what else it does, count on both sides.
MEASURED = 52


def durations():
    """[output] milliseconds, of the last time that each was made."""
    made = {}
    for line in (BUILD / ".ninja_log").read_text(encoding="utf-8").splitlines()[1:]:
        begin, end, _, output, _ = line.split("\t")
        made[output] = int(end) - int(begin)
    return made


class BuildTime(unittest.TestCase):
    def test_no_file_has_become_dear(self):
        made = durations()
        objects = sum(time for output, time in made.items() if output.endswith(".o"))
        headers = sum(time for output, time in made.items() if output.endswith((".pch", ".gch")))
        self.assertLess(objects / headers, 1.6 * MEASURED, "measure again, and change README's minutes")


if __name__ == "__main__":
    if BUILD.name != "release":
        print("SKIPPED: README speaks of the preset release")
        sys.exit(77)
    unittest.main()
