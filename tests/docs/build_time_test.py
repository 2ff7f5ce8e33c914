#!/usr/bin/env python3
"""README's minutes stay true: all files together take so many times as long to read as one that hardly changes.

Reading is two thirds of compiling, and what a header that is included too often makes dearer.
"""
import json
import os
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import unittest

BUILD = pathlib.Path(os.environ.get("TRAVERSE_BUILD", "build/release"))
OF_LONG_TESTS = re.compile("/tests/(bench|fuzz)/")  # README speaks of a build without them
FIXED = "traverse/v1/plan.pb.cc"  # nearly all of it is protobuf's headers
SAMPLE = 15

# When README's minutes were measured.
MEASURED = 245


def seconds(command):
    """Processor time."""
    begin = resource.getrusage(resource.RUSAGE_CHILDREN)
    head, tail = command["command"].split(" -o ", 1)
    subprocess.run(f"{head} -fsyntax-only {tail.split(' ', 1)[1]}", shell=True, cwd=command["directory"], check=True)
    end = resource.getrusage(resource.RUSAGE_CHILDREN)
    return end.ru_utime + end.ru_stime - begin.ru_utime - begin.ru_stime


class BuildTime(unittest.TestCase):
    def test_files_have_not_become_dear(self):
        commands = json.loads((BUILD / "compile_commands.json").read_text(encoding="utf-8"))
        commands = sorted((of for of in commands if "cmake_pch" not in of["file"]), key=lambda of: of["file"])
        fixed = next(of for of in commands if of["file"].endswith(FIXED))
        commands = [of for of in commands if not OF_LONG_TESTS.search(of["file"])]
        # By itself: what it shares with others would hide what others have come to include.
        fixed = dict(fixed, command=re.sub(r"-Xclang -include(-pch)? -Xclang \S+", "", fixed["command"]))
        sample = commands[::len(commands) // SAMPLE]
        # In turns, so that what makes the processor slower for a while does so for both.
        pairs = [(seconds(of), seconds(fixed) if at % 5 == 2 else None) for at, of in enumerate(sample)]
        files, beside = zip(*pairs)
        ratio = statistics.mean(files) / statistics.mean(filter(None, beside)) * len(commands)
        self.assertLess(ratio, 1.4 * MEASURED, "measure again, and change README's minutes")


if __name__ == "__main__":
    if BUILD.name != "release":
        print("SKIPPED: README speaks of the preset release")
        sys.exit(77)
    unittest.main()
