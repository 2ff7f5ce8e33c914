#!/usr/bin/env python3
"""Where a build's time went: files, lines and seconds by folder, and the files that took longest.

  tests/build_table.py [build/release]

Reads what Ninja noted of the last time that each file was compiled: build from nothing on a machine that does nothing else.
"""
import collections
import pathlib
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[1]
LONGEST = 10


def compiled(build):
    """Seconds by object."""
    seconds = {}
    for line in (build / ".ninja_log").read_text(encoding="utf-8").splitlines()[1:]:
        begin, end, _, output, _ = line.split("\t")
        seconds[output] = (int(end) - int(begin)) / 1000
    return seconds


def source_of(output):
    """client/gcode/CMakeFiles/traverse_gcode.dir/read/reader.cc.o is of client/gcode/read/reader.cc; None: not one of ours."""
    folder, _, rest = output.partition("/CMakeFiles/")
    path = SOURCE / folder / rest.partition("/")[2].replace("__", "..").removesuffix(".o")
    return path.resolve().relative_to(SOURCE) if output.endswith(".cc.o") and path.is_file() else None


def folder_of(source):
    """Of the tests by what they test, of the rest by the first two folders."""
    parts = source.parts[:-1]
    return "/".join(parts[:3 if parts[0] == "tests" else 2])


def main():
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else SOURCE / "build/release")
    files = {source: (seconds, (SOURCE / source).read_text(encoding="utf-8").count("\n"))
             for output, seconds in compiled(build).items() if (source := source_of(output))}
    folders = collections.defaultdict(lambda: [0, 0, 0.0])
    for source, (seconds, lines) in files.items():
        for name in (folder_of(source), "all"):
            row = folders[name]
            row[0], row[1], row[2] = row[0] + 1, row[1] + lines, row[2] + seconds
    print("| folder | files | lines | s | ms a line |\n|---|---:|---:|---:|---:|")
    for name, (count, lines, seconds) in sorted(folders.items(), key=lambda row: -row[1][2]):
        print(f"| {name} | {count} | {lines} | {seconds:.0f} | {1000 * seconds / lines:.0f} |")
    print()
    for source, (seconds, lines) in sorted(files.items(), key=lambda one: -one[1][0])[:LONGEST]:
        print(f"{seconds:5.1f} s {lines:4} lines  {source}")


if __name__ == "__main__":
    main()
