"""The figures of the guides that a seed decides, not a machine: writes them there, or says where a guide differs.

    TRAVERSE=build/release/client/traverse tests/docs/figures.py [--write] [GUIDE...]

They stand between `<!-- figures NAME -->` and `<!-- end of figures -->`. All are of seed 1 and no time limit.
"""
import json
import os
import pathlib
import re
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
INSTANCES = SOURCE / "tests" / "bench" / "instances"
REFERENCE = json.loads((SOURCE / "tests" / "bench" / "reference.json").read_text(encoding="utf-8"))


def compare(part, strategies):
    """The documents of one run of each strategy on layers 1 to 5, by their labels."""
    ran = subprocess.run([os.environ["TRAVERSE"], "compare", str(INSTANCES / f"{part}.damat"), "--layers=1-5", "--quiet",
                          "--json=-", "--strategies=" + ",".join(strategies)], stdout=subprocess.PIPE,
                         stderr=subprocess.DEVNULL, check=True)
    return {run["label"]: run["routes"] for run in json.loads(ran.stdout)["runs"]}


def travel(document):
    return document["total"]["travel_mm"]


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|---|" + "---:|" * (len(header) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def methods():
    names = ["none", "greedy", "ni2opt", "tabu", "auto"]
    rows = []
    for part in ("part1", "part2", "part3", "s7_text"):
        found = compare(part, names)
        best = REFERENCE[part]["best_known"]
        above = 100 * (travel(found["auto"]) - best) / best
        rows.append([part, *(f"{travel(found[name]):.2f}" for name in names), f"{best:.2f}", f"{above:.2f} %"])
    return table(["part", *names, "best known", "auto above it"], rows)


PUBLISHED = {"NO": "none", "Método 1": "greedy:pure", "Método 2": "ni2opt:pure:point_release=false",
             "Método 3": "ni2opt:pure", "`tabu:polish=false`": "tabu:polish=false", "`tabu`": "tabu"}


def published():
    """The sources' methods as published, and the gain of tabu search without polish over Método 2, its like."""
    rows = []
    for part in ("part1", "part2", "part3"):
        found = compare(part, PUBLISHED.values())
        second, plain = (travel(found[PUBLISHED[name]]) for name in ("Método 2", "`tabu:polish=false`"))
        rows.append([part, *(f"{travel(found[label]):.2f}" for label in PUBLISHED.values()),
                     f"{100 * (second - plain) / second:.1f} %"])
    return table(["part, mm", *PUBLISHED, "plain tabu under Método 2"], rows)


def reductions():
    rows = []
    for part in ("part1", "part2", "part3"):
        found = compare(part, ["tabu:polish=false:representation=nrp:diversifications=50", "tabu:thesis:diversifications=50"])
        nrp, thesis = ([layer["statistics"] for layer in document["layers"]] for document in found.values())

        def mean(layers, name):
            return sum(layer[f"points_{name}"] for layer in layers) / len(layers)
        rows.append([part, *(f"{mean(nrp, name):.0f}" for name in ("entries", "island_analysis", "sp", "nrp", "bbcp")),
                     f"{mean(thesis, 'vp'):.0f}", f"{100 * (1 - mean(thesis, 'vp') / mean(thesis, 'sp')):.0f} %"])
    return table(["part", "all", "island analysis", "SP", "NRP", "BBCP", "VP, as published", "under SP"], rows)


def proven():
    rows = []
    for part in ("part1", "part2", "part3", "s1_block", "s2_ring", "s3_bracket"):
        found = compare(part, ["exact"])["exact"]
        stops = {layer["stop"] for layer in found["layers"]}
        rows.append([part, f"{travel(found):.3f}", "proven" if stops == {"OPTIMAL"} else "open"])
    return table(["part, layers 1-5", "length mm", "bound"], rows)


BLOCKS = {"methods": methods, "published": published, "reductions": reductions, "proven": proven}
GUIDES = ("README.md", "engine/TABU.md", "engine/EXACT.md")
PLACE = re.compile(r"(?s)(<!-- figures (\w+) -->\n)(.*?)(\n<!-- end of figures -->)")


def renewed(text):
    return PLACE.sub(lambda found: found[1] + BLOCKS[found[2]]() + found[4], text)


def main(arguments):
    write = "--write" in arguments
    named = [name for name in arguments if name != "--write"] or GUIDES
    faults = 0
    for name in named:
        guide = SOURCE / name
        text = guide.read_text(encoding="utf-8")
        if not PLACE.search(text):
            print(f"{name}: holds no figures")
            faults += 1
            continue
        now = renewed(text)
        if now == text:
            continue
        if write:
            guide.write_text(now, encoding="utf-8")
            continue
        faults += 1
        for line, (old, new) in enumerate(zip(text.splitlines(), now.splitlines()), 1):
            if old != new:
                print(f"{name}:{line}: {old}\n  is now {new}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
