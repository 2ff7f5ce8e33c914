#!/usr/bin/env python3
"""All that `traverse optimize` gives as reasons for what stays as sliced, each once, to be read by people who slice.

  reasons.py FOLDER... [--build=build/release] [--policies=safe,free,fast] [--strategy=greedy] [--most_mb=8]

Lines that differ in numbers, places and quoted lines alone are one. Behind each stand how often it was said, and an
example.
"""

import argparse
import collections
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import judge  # noqa: E402

# What tells how it went; the rest says why it went no better.
RESULTS = re.compile(r"(?:.*: \d+ layers, .* s$|cost |ended |gap |lower bound|\d+ of \d+ layers rewritten|least rest|"
                     r"--policy=fast would save|nothing to gain)")


def reasons_of(says):
    return [line for line in says.splitlines() if line.strip() and not RESULTS.match(line)]


def shape_of(line):
    """The line without what differs from file to file."""
    line = re.sub(r"`[^`]*`", "`..`", line)
    line = re.sub(r"\S+:\d+\b", "FILE:N", line)
    return re.sub(r"\d+(?:\.\d+)?", "N", line)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--policies", default="safe,free,fast")
    parser.add_argument("--strategy", default="greedy")
    parser.add_argument("--most_mb", type=float, default=8)
    arguments = parser.parse_args()

    said = collections.defaultdict(list)
    for path in judge.files_in(arguments.folders, arguments.most_mb):
        with tempfile.TemporaryDirectory() as folder:
            given = pathlib.Path(folder, path.name.removesuffix(".xz"))
            given.write_bytes(judge.read(path).encode("latin-1"))
            for policy in arguments.policies.split(","):
                run = subprocess.run([f"{arguments.build}/client/traverse", "optimize", given, "-o", f"{folder}/made",
                                      f"--policy={policy}", f"--strategy={arguments.strategy}"],
                                     capture_output=True, text=True, errors="replace", cwd=folder)
                for line in reasons_of(run.stdout + (run.stderr if run.returncode else "")):
                    said[shape_of(line)].append(line.replace(f"{folder}/", ""))
    for lines in sorted(said.values(), key=len, reverse=True):
        print(f"{len(lines)} times: {lines[0]}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
