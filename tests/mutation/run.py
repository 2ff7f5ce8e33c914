#!/usr/bin/env python3
"""Puts small faults into the product, one at a time, and counts those that the tests find.

    tests/mutation/run.py                     all places, about an hour on two cores
    tests/mutation/run.py --each=1 --seed=3   one fault a place, others than the usual ones
    tests/mutation/run.py --places=auth       places whose file contains a word
    tests/mutation/run.py --list              the faults, without trying them
    tests/mutation/run.py --check             whether every place still exists; no build

A fault turns a comparison, a sign or a condition round, swaps && and ||, answers the opposite, or
leaves a statement out. What does not compile is not counted. The sources are put back after each
fault, also when the script is stopped. Exit code 1 if fewer than --least of 100 are found.

The tree must be built (build/release), and nobody else may be building it.
"""

import argparse
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import time

from places import PLACES

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
# What is left out without a difference: it saves time alone.
SPARES_TIME = re.compile(r"\.(reserve|shrink_to_fit)\(")
NOT_CODE = re.compile(r"^\s*(//|#|assert\(|static_assert|using |namespace |template)")


def code_part(line):
    """The line without its comment; strings are blanked, at the same length."""
    line = re.sub(r'"(?:[^"\\]|\\.)*"', lambda m: '"' + "_" * (len(m.group()) - 2) + '"', line)
    at = line.find("//")
    return line if at < 0 else line[:at]


def faults_of(text):
    """All faults of a source: (line number from 1, new line, what was done)."""
    depth_of_parameters = 0
    for number, line in enumerate(text.splitlines(), 1):
        if NOT_CODE.match(line):
            continue
        code = code_part(line)
        continues = depth_of_parameters > 0
        depth_of_parameters += code.count("(") - code.count(")")
        if "operator" in code or "template" in code or "std::function<" in code:
            continue
        for pattern, replacement in SWAPS:
            for match in re.finditer(pattern, code):
                # What a bracket of a template means is not a comparison.
                new = line[:match.start()] + match.expand(replacement) + line[match.end():]
                yield number, new, f"{match.group().strip()} -> {match.expand(replacement).strip()}"
        if SPARES_TIME.search(code):
            continue
        if not continues and depth_of_parameters == 0 and STATEMENT.match(code.rstrip()):
            yield number, re.sub(r"\S.*", ";", line), "left out"


def choose(place, each, seed):
    text = (ROOT / place["file"]).read_text()
    faults = list(faults_of(text))
    random.Random(f"{seed} {place['file']}").shuffle(faults)
    lines = set()
    chosen = []
    for fault in faults:
        if fault[0] not in lines and len(chosen) < 4 * each:  # some will not compile
            lines.add(fault[0])
            chosen.append(fault)
    return chosen


def run(command, seconds):
    """The exit code, or "time". What it started ends with it: a fault may well never return."""
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                          start_new_session=True) as process:
        try:
            return process.wait(timeout=seconds)
        except subprocess.TimeoutExpired:
            return "time"
        finally:
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass


def try_fault(place, fault, build):
    """'found', 'missed', or None if the fault does not compile."""
    path = ROOT / place["file"]
    original = path.read_text()
    lines = original.splitlines(keepends=True)
    lines[fault[0] - 1] = fault[1] + "\n"
    try:
        path.write_text("".join(lines))
        if run(["cmake", "--build", build, "--target", *place["targets"]], 600) != 0:
            return None
        for test in place["tests"]:
            if run(["sh", "-c", test.replace("$BUILD", build)], place.get("seconds", 120)) != 0:
                return "found"
        return "missed"
    finally:
        path.write_text(original)


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
    places = [place for place in PLACES if options.places in place["file"]]
    if options.check:
        gone = [p["file"] for p in places if not list(faults_of((ROOT / p["file"]).read_text()))]
        print("\n".join(f"{name}: nothing to put a fault into" for name in gone))
        return 1 if gone else 0
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
            found += outcome == "found"
            if outcome == "missed":
                missed.append(where)
        if not options.list:
            run(["cmake", "--build", options.build, "--target", *place["targets"]], 600)
    if options.list:
        return 0
    share = 100 * found / max(1, tried)
    print(f"\n{found} of {tried} faults found: {share:.0f} %")
    print("\n".join(f"missed: {where}" for where in missed))
    return 0 if share >= options.least else 1


if __name__ == "__main__":
    sys.exit(main())
