#!/usr/bin/env python3
"""Plates printed object by object, where finished objects stand in the way of the head.

  obstacle_plates.py TRAVERSE [--seeds=1-30] [--keep=FOLDER] [--verbose]

Makes a plate for each seed: objects on both sides of a tower, around it, in a horseshoe, up against
it; the slicer's own travel leads round, above, or through them. Has it optimised, and looks with
head_path.py, which knows neither the product's writer nor its verifier, for new travel that leads
into what stands. And leads one move of the plate through a tower that it led above: `verify` has to
find that. Prints how many plates were optimised; ends with 1 if something is wrong.
"""

import argparse
import os
import random
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from head_path import into_what_stands  # noqa: E402
from plate import text_of  # noqa: E402

STYLES = ("round", "shuffled", "careless")


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def defect(traverse, given, made, seed, style, crossed):
    """What is wrong with what `verify` says of a travel through a tower, or None."""
    through = 1 + seed % crossed
    text, _ = text_of(random.Random(seed), style, through)
    with open(given, encoding="utf-8") as file:
        if not into_what_stands(file.read(), text):
            return None  # it only passes beside one
    write(made, text)
    run = subprocess.run([traverse, "verify", given, made], capture_output=True, text=True, timeout=600)
    # On the way to a layer it is also lower than anything there.
    said = run.stdout + run.stderr
    if run.returncode != 0 and ("obstacles" in said or "travels lower" in said):
        return None
    return f"verify does not find travel through a tower: {run.returncode}"


def try_seed(traverse, seed, folder):
    """What is wrong, or None; and whether the plate was optimised."""
    style = STYLES[seed % len(STYLES)]
    text, crossed = text_of(random.Random(seed), style)
    given, made = os.path.join(folder, "a.gcode"), os.path.join(folder, "b.gcode")
    write(given, text)
    policy = ("safe", "balanced", "free")[seed // len(STYLES) % 3]
    run = subprocess.run([traverse, "optimize", given, "-o", made, f"--policy={policy}", "--quiet"],
                         capture_output=True, text=True, timeout=600)
    title = f"seed {seed}, {style}, {policy}"
    if run.returncode != 0:
        return f"{title}: {run.returncode}: {run.stderr.strip()[-300:]}", False
    with open(made, encoding="utf-8") as file:
        result = file.read()
    found = into_what_stands(text, result)
    if found:
        line, below = max(found, key=lambda each: each[1])
        return f"{title}: {len(found)} moves into what stands, line {line} by {below:.2f} mm", True
    wrong = defect(traverse, given, os.path.join(folder, "c.gcode"), seed, style, crossed) if crossed else None
    return (f"{title}: {wrong}" if wrong else None), result != text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("traverse")
    parser.add_argument("--seeds", default="1-30")
    parser.add_argument("--keep")
    parser.add_argument("--verbose", action="store_true")
    options = parser.parse_args()
    first, _, last = options.seeds.partition("-")
    wrong, optimised, seeds = 0, 0, range(int(first), int(last or first) + 1)
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or temporary
        os.makedirs(folder, exist_ok=True)
        for seed in seeds:
            fault, changed = try_seed(options.traverse, seed, folder)
            optimised += changed
            if fault:
                wrong += 1
                print(fault)
            elif options.verbose:
                print(f"seed {seed}: {'optimised' if changed else 'as it was'}")
    print(f"{len(seeds)} plates, {optimised} optimised, {wrong} wrong")
    # Where hardly any is, the others prove nothing.
    return 1 if wrong or optimised * 4 < len(seeds) else 0


if __name__ == "__main__":
    sys.exit(main())
