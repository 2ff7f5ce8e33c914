#!/usr/bin/env python3
"""Reads each file without precompiled headers, which hide an include that is missing; prints the errors.

  tests/each_file.py                                    all files, by the compiler of build/release: half an hour of a core
  tests/each_file.py --since=COMMIT                     what has changed since
  tests/each_file.py --compiler=g++ client/gcode/read   what begins so, by the other compiler
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[1]
PRECOMPILED = re.compile(r"-Xclang -include(-pch)? -Xclang \S+ ?")
CLANG_ALONE = {"-Wthread-safety", "-Winvalid-pch"}
GCC_ALONE = ["-Wno-restrict"]  # see CMakeLists.txt


def command_of(entry, compiler):
    words = shlex.split(PRECOMPILED.sub("", entry["command"]))
    at = words.index("-o")
    del words[at:at + 2]
    while not words[0].endswith("++"):  # a compiler cache
        del words[0]
    if compiler:
        words = [compiler, *(word for word in words[1:] if word not in CLANG_ALONE), *GCC_ALONE]
    return [*words, "-fsyntax-only"]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", default=SOURCE / "build/release", type=pathlib.Path)
    parser.add_argument("--compiler")
    parser.add_argument("--since")
    parser.add_argument("beginnings", nargs="*", default=[""])
    given = parser.parse_args()
    entries = {os.path.relpath(entry["file"], SOURCE): entry
               for entry in json.loads((given.build / "compile_commands.json").read_text(encoding="utf-8"))}
    files = [file for file in sorted(entries) if file.startswith(tuple(given.beginnings)) and not file.startswith("build")]
    if given.since:
        changed = subprocess.run(["git", "diff", "--name-only", given.since], cwd=SOURCE, capture_output=True, text=True, check=True)
        files = sorted(set(files) & set(changed.stdout.split()))

    def read(file):
        entry = entries[file]
        done = subprocess.run(command_of(entry, given.compiler), cwd=entry["directory"], capture_output=True, text=True, check=False)
        if done.returncode:
            print(done.stderr, flush=True)
        return done.returncode == 0

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        failed = [file for file, good in zip(files, pool.map(read, files)) if not good]
    print(f"{len(files)} files, {len(failed)} with errors {' '.join(failed)}")
    return 1 if failed or not files else 0


if __name__ == "__main__":
    sys.exit(main())
