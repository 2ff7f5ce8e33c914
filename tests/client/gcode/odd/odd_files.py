#!/usr/bin/env python3
"""Files that no slicer would write, or only one: each is optimised to an equal print, or stays.

  odd_files.py TRAVERSE [--seeds=1-30] [--keep=FOLDER] [--verbose]

Makes a small print for each seed, writes it in a style put together at random (line ends, checksums,
inches, relative moves, switches of modes, arcs by radius, layer marks that lie, ...), and has it
optimised. What comes out has to deposit the same, by the simulation below, which knows neither the
product's reader nor its verifier; or be the file as it was, or there is a message that says why not.
Ends with 1 if one of them is not so.
"""

import argparse
import collections
import os
import random
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from deposits import deposits, same  # noqa: E402
from odd_print import print_of, styled  # noqa: E402
from styles import STYLES  # noqa: E402


def try_seed(traverse, seed, folder, verbose):
    """What is wrong, or None; and what became of the file."""
    rng = random.Random(seed)
    styles = set(rng.sample(STYLES, rng.randint(1, 4)))
    data = styled(print_of(styles, rng), styles, rng)
    policy = rng.choice(("safe", "balanced", "free"))
    given, made = os.path.join(folder, "a.gcode"), os.path.join(folder, "b.gcode")
    with open(given, "wb") as file:
        file.write(data)
    if os.path.exists(made):
        os.remove(made)
    run = subprocess.run([traverse, "optimize", given, "-o", made, "--strategy=ni2opt", f"--policy={policy}",
                          "--quiet"], capture_output=True, text=True, timeout=60)
    title = f"seed {seed}, {policy}: {' '.join(sorted(styles))}"
    if run.returncode != 0:
        if verbose:
            print(f"{title}: {run.stderr.strip()[-200:]}")
        if os.path.exists(made):
            return f"{title}: {run.returncode}, and yet there is a file", "refused"
        return None if run.stderr.strip() and run.returncode < 128 else (
            f"{title}: {run.returncode} without a reason", "refused"), "refused"
    with open(made, "rb") as file:
        result = file.read()
    if result == data:
        return None, "as it was"
    wrong = same(deposits(data), deposits(result)) or same(deposits(data, True), deposits(result, True))
    return (f"{title}: {wrong}" if wrong else None), "optimised"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("traverse")
    parser.add_argument("--seeds", default="1-30")
    parser.add_argument("--keep", help="a folder for the files of seeds that fail")
    parser.add_argument("--verbose", action="store_true")
    args = parser.parse_args()
    first, last = (int(part) for part in args.seeds.split("-"))
    counts, wrong = collections.Counter(), 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(first, last + 1):
            fault, became = try_seed(args.traverse, seed, folder, args.verbose)
            counts[became] += 1
            if fault:
                wrong += 1
                print(fault, flush=True)
                for name in ("a", "b"):
                    path = os.path.join(folder, f"{name}.gcode")
                    if args.keep and os.path.exists(path):
                        os.replace(path, os.path.join(args.keep, f"{seed}.{name}.gcode"))
    print(", ".join(f"{count} {what}" for what, count in sorted(counts.items())) + f"; {wrong} wrong")
    sys.exit(1 if wrong or not counts["optimised"] else 0)


if __name__ == "__main__":
    main()
