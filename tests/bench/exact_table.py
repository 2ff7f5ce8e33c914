#!/usr/bin/env python3
"""What `exact` proves, as a Markdown table: travel, bound, gap, CPU seconds, nodes, cuts of each part.

  tests/bench/exact_table.py                                 parts 1-3 and s1-s3 layers 1-5, s4-s8 layer 1
  tests/bench/exact_table.py --seconds=5 --deposition=interleaved part2 s7_text:1-2
  tests/bench/exact_table.py --option=model=framework --option=time_limit=20 part2

One thread, one job after another. CPU seconds are those of the whole process, reading the file included. Exit code 1
if a job fails.
"""

import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
DEFAULT = ["part1", "part2", "part3", "s1_block", "s2_ring", "s3_bracket"] + [
    name + ":1" for name in ("s4_grille", "s5_islands40", "s6_gears", "s7_text", "s8_many")]


def cpu_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def instance(name):
    files = [ROOT / "tests/bench/instances" / (name + end) for end in (".damat", ".damat.xz")]
    return next((file for file in files if file.exists()), pathlib.Path(name))


def solve(options, name, layers):
    """The JSON document of one job, and its CPU seconds."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "routes.json"
        command = [options.traverse, "optimize", str(instance(name)), "--strategy=exact", "--threads=1", "--quiet",
                   f"--layers={layers}", f"--layer_time_limit={options.seconds}s", f"--json={out}",
                   f"--deposition={options.deposition}"]
        command += [f"--option={option}" for option in options.option]
        before = cpu_seconds()
        subprocess.run(command, check=True)
        return json.loads(out.read_text()), cpu_seconds() - before


def span(values, form):
    low, high = min(values), max(values)
    return form % low if form % low == form % high else form % low + "-" + form % high


def row(options, name, layers):
    document, seconds = solve(options, name, layers)
    done = document["layers"]
    travel = sum(layer["travel_mm"] for layer in done)
    bounds = [layer["lower_bound_mm"] for layer in done]
    bound = sum(bounds) if None not in bounds else None
    proven = all(layer["stop"] == "OPTIMAL" for layer in done)
    gap = "-" if bound is None else "0" if proven else f"{100 * (1 - bound / travel):.1f} %"

    def statistic(key):
        return span([layer.get("statistics", {}).get(key, 0) for layer in done], "%d")

    cells = [f"{name}, {layers}", span([len(layer["route"]) for layer in done], "%d"), f"{travel:.3f}",
             "proven" if proven else "-" if bound is None else f"{bound:.3f}", gap,
             span([layer["solve_seconds"] for layer in done], "%.3f"), f"{seconds:.2f}", statistic("passes"),
             statistic("nodes"), statistic("cuts")]
    print("| " + " | ".join(cells) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", help="a bundled part or a DAMAT file, and :LAYERS (default 1-5)")
    parser.add_argument("--seconds", type=float, default=60, help="limit of a layer")
    parser.add_argument("--deposition", default="sequential")
    parser.add_argument("--option", action="append", default=[], help="of the strategy, NAME=VALUE")
    parser.add_argument("--traverse", default=os.environ.get("TRAVERSE", str(ROOT / "build/release/client/traverse")))
    options = parser.parse_args()
    print("| part, layers | paths | length mm | bound mm | gap | seconds a layer | CPU seconds | passes | nodes | cuts |")
    print("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|")
    for part in options.parts or DEFAULT:
        name, _, layers = part.partition(":")
        row(options, name, layers or "1-5")


if __name__ == "__main__":
    try:
        main()
    except (subprocess.CalledProcessError, OSError) as error:
        sys.exit(str(error))
