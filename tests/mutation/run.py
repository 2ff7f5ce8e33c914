#!/usr/bin/env python3
"""Puts small faults into the product, one at a time, and counts those that the tests find.

    tests/mutation/run.py                     all places, about an hour on two cores
    tests/mutation/run.py --each=1 --seed=3   one fault a place, others than the usual ones
    tests/mutation/run.py --places=auth       places whose file contains a word
    tests/mutation/run.py --list              the faults, without trying them
    tests/mutation/run.py --check             whether every place and its tests still exist

A fault turns a comparison, a sign or a condition round, swaps && and ||, answers the opposite, or
leaves a statement out. What does not compile is not counted. The sources are put back after each
fault, also when the script is stopped. Exit code 1 if fewer than --least of 100 are found.

First the tests of the place run, then, if they miss the fault, all of their binary: both count as
found, and the output tells which ("found by others"). For a few places another binary follows.

Some faults make no difference. Those known by their form are never chosen: assertions, as release
builds have none; reserve(); and a statement that only counts steps for the budget, rest(n), since
tests/engine/schedule/gaps_test.cc holds for the engine as a whole how often it asks. Those that
were looked at one by one are in EQUIVALENT of places.py, each with the reason. All others that
are missed count as missed.

The tree must be built (build/release), and nobody else may be building it. To go on working
meanwhile, let it run in a worktree of its own; CMAKE_BUILD_PARALLEL_LEVEL limits its builds.
"""

import argparse
import fnmatch
import functools
import os
import pathlib
import random
import re
import resource
import signal
import stat
import subprocess
import sys
import time

from places import EQUIVALENT, PLACES

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Pattern, replacement: tried on code alone, never within strings or comments.
SWAPS = [
    (r" <= ", " > "), (r" >= ", " < "), (r" < (?!<)", " >= "), (r" > (?!>)", " <= "),
    (r" == ", " != "), (r" != ", " == "), (r" && ", " || "), (r" \|\| ", " && "),
    (r" \+ ", " - "), (r" - ", " + "), (r" \+= ", " -= "), (r" -= ", " += "),
    (r"\bif \((?!const |auto |std::|absl::|int |size_t )(.+)\) (?=return|continue|break)", r"if (!(\1)) "),
    (r"\breturn true;", "return false;"), (r"\breturn false;", "return true;"),
    (r"\bstd::min\(", "std::max("), (r"\bstd::max\(", "std::min("),
]
STATEMENT = re.compile(r"^\s+(?!return|const |auto |case |using |break|continue|delete|else|}|for |if )"
                       r"[\w.\->\[\]*+:()]+( [+\-*|&]?= .+|\(.*\)|\+\+|--)?;$")
# What makes no difference: it saves time alone, or shares it with others.
SPARES_TIME = re.compile(r"\.(reserve|shrink_to_fit)\(|^\s*(\w+[.>-]+)*rest_?(\(\))?\(.*\);$")
NOT_CODE = re.compile(r"^\s*(//|#|using |namespace |template)")
ASSERTION = re.compile(r"^\s*(for \(.*\) )?(assert|static_assert)\(")


def code_part(line):
    """The line without its comment; strings are blanked, at the same length."""
    line = re.sub(r'"(?:[^"\\]|\\.)*"', lambda m: '"' + "_" * (len(m.group()) - 2) + '"', line)
    at = line.find("//")
    return line if at < 0 else line[:at]


def faults_of(text):
    """All faults of a source: (line number from 1, new line, what the line says then)."""
    depth_of_parameters = 0
    asserting = False
    for number, line in enumerate(text.splitlines(), 1):
        if NOT_CODE.match(line):
            continue
        code = code_part(line)
        continues = depth_of_parameters > 0
        depth_of_parameters += code.count("(") - code.count(")")
        asserting = ASSERTION.match(line) is not None or (asserting and continues)
        if asserting or SPARES_TIME.search(code):
            continue
        if "operator" in code or "template" in code or "std::function<" in code:
            continue
        for pattern, replacement in SWAPS:
            for match in re.finditer(pattern, code):
                # What a bracket of a template means is not a comparison.
                new = line[:match.start()] + match.expand(replacement) + line[match.end():]
                yield number, new, new.strip()
        if not continues and depth_of_parameters == 0 and STATEMENT.match(code.rstrip()):
            yield number, re.sub(r"\S.*", ";", line), f"without {line.strip()}"


def choose(place, each, seed):
    text = (ROOT / place["file"]).read_text()
    faults = [fault for fault in faults_of(text) if (place["file"], fault[2]) not in EQUIVALENT]
    random.Random(f"{seed} {place['file']}").shuffle(faults)
    taken = set()
    chosen = []
    for fault in faults:
        if fault[0] not in taken and len(chosen) < 4 * each:  # some will not compile
            taken.add(fault[0])
            chosen.append(fault)
    return chosen


def run(command, seconds):
    """The exit code, or "time". What it started ends with it: a fault may well never return.

    The limit is of computing, so that a busy machine finds nothing; one that waits has twice as long.
    """
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                          start_new_session=True,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))) as process:
        try:
            return process.wait(timeout=2 * seconds)
        except subprocess.TimeoutExpired:
            return "time"
        finally:
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass


def binary_of(target, build):
    """The test binary of a target."""
    found = [path for path in (ROOT / build / "tests").rglob(target) if path.is_file()]
    if not found:
        sys.exit(f"{target} is not built in {build}")
    return str(found[0])


@functools.cache
def tests_of(binary):
    """All tests of a binary, as Suite.Name."""
    listed = subprocess.run([binary, "--gtest_list_tests"], capture_output=True, text=True, check=True)
    suite = ""
    names = []
    for line in listed.stdout.splitlines():
        if line.startswith(" "):
            names.append(suite + line.split()[0])
        else:
            suite = line.split()[0]
    return names


def gone_from_the_list(places, build):
    """What the list of places names and is not there."""
    for place in places:
        if not list(faults_of((ROOT / place["file"]).read_text())):
            yield f"{place['file']}: nothing to put a fault into"
        for suites in place["suites"].split(":"):
            if not fnmatch.filter(tests_of(binary_of(place["target"], build)), suites):
                yield f"{place['file']}: no test is called {suites}"
    for file, fault in EQUIVALENT:
        if fault not in (what for _, _, what in faults_of((ROOT / file).read_text())):
            yield f"{file}: no fault '{fault}'"


def put_devices_back():
    """A fault in how files are written puts a file in the place of a device, where root runs it."""
    for path, number in (("/dev/null", 3), ("/dev/full", 7)):
        if not stat.S_ISCHR(os.stat(path).st_mode):
            os.unlink(path)
            os.mknod(path, stat.S_IFCHR | 0o666, os.makedev(1, number))
            os.chmod(path, 0o666)


def try_fault(place, fault, build):
    """'found', 'found by others', 'missed', or None if the fault does not compile."""
    path = ROOT / place["file"]
    original = path.read_text()
    lines = original.splitlines(keepends=True)
    lines[fault[0] - 1] = fault[1] + "\n"
    try:
        path.write_text("".join(lines))
        if run(["cmake", "--build", build, "--target", place["target"]], 1200) != 0:
            return None
        near = [binary_of(place["target"], build), "--gtest_brief=1", f"--gtest_filter={place['suites']}"]
        if run(near, place["seconds"]) != 0:
            return "found"
        for target in (place["target"], *place["others"]):
            run(["cmake", "--build", build, "--target", target], 1200)
            if run([binary_of(target, build), "--gtest_brief=1", "--gtest_fail_fast"], 240) != 0:
                return "found by others"
        return "missed"
    finally:
        path.write_text(original)
        put_devices_back()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--each", type=int, default=3, help="faults a place")
    parser.add_argument("--seed", default="1")
    parser.add_argument("--places", default="")
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--least", type=float, default=90)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that the sources are put back
    places = [place for place in PLACES if options.places in place["file"]]
    if options.check:
        wrong = list(gone_from_the_list(places, options.build))
        for text in wrong:
            print(text)
        return 1 if wrong else 0
    found = tried = 0
    missed = []
    for place in places:
        done = 0
        for fault in choose(place, options.each, options.seed):
            if done == options.each:
                break
            where = f"{place['file']}:{fault[0]}: {fault[2]}"
            if options.list:
                done += 1
                print(where)
                continue
            began = time.monotonic()
            outcome = try_fault(place, fault, options.build)
            print(f"{outcome or 'does not compile'}: {where} ({time.monotonic() - began:.0f} s)", flush=True)
            if outcome is None:
                continue
            done += 1
            tried += 1
            found += outcome != "missed"
            if outcome == "missed":
                missed.append(where)
    if options.list:
        return 0
    run(["cmake", "--build", options.build, "--target", *{place["target"] for place in places}], 1800)
    share = 100 * found / max(1, tried)
    print(f"\n{found} of {tried} faults found: {share:.0f} %")
    print("\n".join(f"missed: {where}" for where in missed))
    return 0 if share >= options.least else 1


if __name__ == "__main__":
    sys.exit(main())
