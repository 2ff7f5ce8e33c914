#!/usr/bin/env python3
"""Traverse beside the literature on GTSPLIB, as a page of Markdown: lengths by effort, the bound, proofs.

  tests/bench/literature.py FOLDER > tests/bench/LITERATURE.md      every .gtsp file there that literature.csv names
  tests/bench/literature.py --seeds=1 --seconds=0 --only=31pr152,40d198 FOLDER     one seed, no proofs, two instances
  tests/bench/literature.py --page=tests/bench/LITERATURE.md --anew=1,proof --only=88pr439 FOLDER
                                     effort 1 with its bound, and the proof; all else as that page has it

FOLDER holds your own copies of the instances (Fischetti, Salazar and Toth 1997); none come with the project.
literature.csv has the published values and those of GLNS. One thread, one run after another.
"""
import argparse
import csv
import json
import os
import pathlib
import platform
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
EFFORTS = ("0.25", "1", "4", "16")

# A proof that had less than that share of its seconds is tried again, so many times at most.
LEAST_SHARE = 0.8
MOST_PROOFS = 3

HEAD = """# GTSPLIB: the literature's table

Written by `tests/bench/literature.py FOLDER`: {machine}, one thread, version {version}, seeds {seeds}.{note}

{instances} symmetric instances in the plane from Fischetti, Salazar and Toth (1997). The number before a name is the
number of sets. All columns except seconds and proofs are percent above the published value: from 1997 for the five
instances without GLNS, and otherwise the best known of GLNS's benchmark.

* *effort*: `auto` with that `effort` (1 is the default), beside the CPU seconds of the whole command, including start
  and reading; means over the seeds. The search ends by itself, so lengths do not depend on the machine.
* *bound*: how far below the default route its lower bound is.
* *GLNS*: as published: Smith and Imeson's method in C++ with its default settings, mean of ten runs on an Apple M4 Pro.
  Its time is that of the solver alone.
* *proof*: `exact` within about {seconds:g} CPU seconds: those to a proof, or the gap that was left. Where others use the machine
  too, runs that had less are repeated with more wall time.

Not everything can be compared. The machines differ. Published lengths use distances rounded to whole numbers (EUC_2D),
and GLNS minimises these. Traverse minimises true distances; afterwards it chooses the points of its sets, in the order
found, for rounded distances. So an optimal tour may be above 0 here, and a proof concerns the shortest true tour. An
instance whose smallest set has several points is searched once from each of them; the time is for all together.
"""


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--traverse", default=str(ROOT / "build/release/client/traverse"))
    parser.add_argument("--seeds", default="1,2,3")
    parser.add_argument("--seconds", type=float, default=60, help="for a proof; 0: none is looked for")
    parser.add_argument("--note", default="", help="a sentence about the machine, for the page")
    parser.add_argument("--only", help="names, divided by commas")
    parser.add_argument("--page", type=pathlib.Path, help="takes from this page what is not measured")
    parser.add_argument("--anew", help="with --page: what is measured, of 0.25, 1, 4, 16 and proof")
    options = parser.parse_args()
    if (options.page is None) != (options.anew is None):
        parser.error("--page and --anew go together")
    options.anew = options.anew.split(",") if options.anew else [*EFFORTS, "proof"]
    for name in options.anew:
        if name not in (*EFFORTS, "proof"):
            parser.error(f"--anew={name}: no such column")
    return options


def run(traverse, file, *flags):
    """The document of one run, and its CPU seconds."""
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "routes.json")
        process = subprocess.Popen([traverse, "optimize", str(file), "--quiet", "--threads=1", f"--json={out}", *flags])
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            sys.exit(f"{file}: traverse failed with code {process.returncode}")
        with open(out, encoding="utf-8") as document:
            return json.load(document), usage.ru_utime + usage.ru_stime


def mean(values):
    values = list(values)
    return sum(values) / len(values)


def of_shortest(document):
    """Length and bound in true distances: the tour is the shortest of the layers."""
    layers = document["layers"]
    bounds = [layer["lower_bound_mm"] for layer in layers]
    return min(layer["travel_mm"] for layer in layers), None if None in bounds else min(bounds)


def gap_below(document):
    length, bound = of_shortest(document)
    return None if bound is None else 100 * max(0.0, 1 - bound / length)


def prove(options, file, layers):
    """A proof, or the gap. Runs again with more of the wall where others left it less of the processor."""
    if options.seconds <= 0:
        return "-"
    wall = options.seconds
    for _ in range(MOST_PROOFS):
        document, seconds = run(options.traverse, file, "--strategy=exact", f"--layer_time_limit={wall / layers:g}s")
        length, bound = of_shortest(document)
        # The layers from the other points need no proof once their bounds are above the shortest.
        proven = bound is not None and bound >= length * (1 - 1e-9)
        if proven or seconds > LEAST_SHARE * options.seconds:
            break
        wall *= options.seconds / seconds
    if bound is None:
        return "none"
    return f"{seconds:.2f} s" if proven else f"open {gap_below(document):.1f} %"


def over(documents, known):
    return mean(100 * (d["tour"]["rounded_length"] / int(known["published"]) - 1) for d in documents)


def measure(options, file, known, seeds, row):
    """What is to be measured, put into one row: percentages, then texts."""
    for index, effort in enumerate(EFFORTS):
        if effort not in options.anew:
            continue
        found = [run(options.traverse, file, f"--seed={seed}", f"--option=effort={effort}") for seed in seeds]
        documents = [document for document, _ in found]
        row["by_effort"][index] = (over(documents, known), mean(seconds for _, seconds in found))
        if effort == "1":
            row["bound"] = mean(gap_below(document) for document in documents)
    if "proof" in options.anew:
        # As many layers as the smallest set has points.
        row["proof"] = prove(options, file, layer_count(options, file))
    return row


def layer_count(options, file):
    document, _ = run(options.traverse, file, "--strategy=none")
    return len(document["layers"])


def empty_row(known):
    glns = 100 * (float(known["glns_mean"]) / int(known["published"]) - 1) if known["glns_mean"] else None
    return {"name": known["instance"], "published": known["published"], "by_effort": [None] * len(EFFORTS),
            "bound": None, "glns": glns,
            "glns_seconds": float(known["glns_seconds"]) if known["glns_seconds"] else None, "proof": "-"}


def row_of_page(page, known):
    """The row of an instance on a page that is there."""
    lines = map(split_line, page.read_text(encoding="utf-8").splitlines())
    cells = next((cells for cells in lines if cells[0] == known["instance"]), None)
    if cells is None:
        sys.exit(f"{page}: no row of {known['instance']}")
    row = empty_row(known)
    values = [None if cell == "-" else float(cell) for cell in cells[2:2 * len(EFFORTS) + 3]]
    row["by_effort"] = list(zip(values[0:-1:2], values[1:-1:2]))
    row["bound"] = values[-1]
    row["proof"] = cells[-1]
    return row


def split_line(line):
    return [cell.strip() for cell in line.strip("|").split("|")]


def number(value, form="%.2f"):
    return "-" if value is None else form % value


def line(row):
    cells = [row["name"], row["published"], *(number(value) for pair in row["by_effort"] for value in pair),
             number(row["bound"], "%.1f"), number(row["glns"]), number(row["glns_seconds"]), row["proof"]]
    return "| " + " | ".join(cells) + " |"


def means(name, rows):
    def of(key):
        known = [row[key] for row in rows if row[key] is not None]
        return mean(known) if known else None
    proven = sum(row["proof"].endswith(" s") for row in rows)
    by_effort = [tuple(map(mean, zip(*pairs))) for pairs in zip(*(row["by_effort"] for row in rows))]
    return {"name": name, "published": "", "by_effort": by_effort, "bound": of("bound"), "glns": of("glns"), "glns_seconds": of("glns_seconds"), "proof": f"{proven} proven"}


def main():
    options = parse_arguments()
    with open(HERE / "literature.csv", encoding="utf-8") as file:
        known = list(csv.DictReader(file))
    known = [row for row in known if (options.folder / (row["instance"] + ".gtsp")).exists()]
    wanted = options.only.split(",") if options.only else [row["instance"] for row in known]
    if options.page is None:
        known = [row for row in known if row["instance"] in wanted]
    if not known:
        sys.exit(f"{options.folder}: no .gtsp file of a name that literature.csv has")
    seeds = options.seeds.split(",")
    begin = time.monotonic()
    rows = []
    for of_instance in known:
        rows.append(row_of_page(options.page, of_instance) if options.page else empty_row(of_instance))
        if of_instance["instance"] in wanted:
            measure(options, options.folder / (of_instance["instance"] + ".gtsp"), of_instance, seeds, rows[-1])
            print(f"{line(rows[-1])}  {time.monotonic() - begin:.0f} s", file=sys.stderr)
    version = subprocess.run([options.traverse, "--version"], capture_output=True, text=True, check=True).stdout.split()[1]
    print(HEAD.format(machine=f"{platform.machine()}, {os.cpu_count()} cores", version=version, seeds=options.seeds,
                      note=options.note and "\n" + options.note,
                      instances=len(rows), seconds=options.seconds))
    efforts = [name for effort in EFFORTS for name in (f"effort {effort}", "s")]
    print("| instance | published | " + " | ".join([*efforts, "bound", "GLNS", "s", "proof"]) + " |")
    print("|---|" + "---:|" * (5 + len(efforts)))
    for row in rows:
        print(line(row))
    print(line(means("mean", rows)))
    if any(row["glns"] is None for row in rows) and any(row["glns"] is not None for row in rows):
        print(line(means("of those with GLNS", [row for row in rows if row["glns"] is not None])))


if __name__ == "__main__":
    main()
