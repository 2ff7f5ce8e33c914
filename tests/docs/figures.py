"""The figures of the guides that a seed decides, not a machine: writes them there, or says where a guide differs.

    TRAVERSE=build/release/client/traverse tests/docs/figures.py [--write] [--long] [GUIDE...]

They stand between `<!-- figures NAME -->` and `<!-- end of figures -->`, of seed 1 and no time limit; those that take long,
proofs and several seeds, between `<!-- long figures NAME -->` and the same end, and only --long looks at them.
"""
import json
import os
import pathlib
import re
import statistics
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
INSTANCES = SOURCE / "tests" / "bench" / "instances"
RUNS = {}
REFERENCE = json.loads((SOURCE / "tests" / "bench" / "reference.json").read_text(encoding="utf-8"))


def runs_of(part, strategies, seeds=1, layers="1-5"):
    """The documents of the runs of each strategy, one a seed, by their labels; each is run once for all tables."""
    key = (part, seeds, layers)
    missing = [name for name in strategies if (key, name) not in RUNS]
    if missing:
        ran = subprocess.run([os.environ["TRAVERSE"], "compare", str(INSTANCES / f"{part}.damat"), f"--layers={layers}",
                              "--quiet", "--json=-", f"--repeat={seeds}", "--strategies=" + ",".join(missing)],
                             stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
        for run in json.loads(ran.stdout)["runs"]:
            RUNS.setdefault((key, run["label"]), []).append(run["routes"])
    return {name: RUNS[key, name] for name in strategies}


def compare(part, strategies):
    """The documents of one run of each strategy on layers 1 to 5, by their labels."""
    return {label: runs[0] for label, runs in runs_of(part, strategies).items()}


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


# Table 5.2 of the thesis: gains over NO in %, of its Guloso, NI2OPT, and BT under NRP, BBCP, and BBCP with 5000 restarts.
THESIS_GAINS = {"part1": (51.8, 46.3, 52.5, 52.5, 52.5), "part2": (56.6, 59.2, 57.6, 57.9, 58.9),
                "part3": (65.4, 65.4, 65.0, 65.0, 65.8)}


def five_seeds():
    labels = ["none", "greedy", "ni2opt", "tabu:polish=false:representation=nrp", "tabu:polish=false",
              "tabu:polish=false:diversifications=5000", "tabu"]
    rows = []
    for part, thesis in THESIS_GAINS.items():
        found = runs_of(part, labels, seeds=5)
        lengths = [[travel(run) for run in found[label]] for label in labels]
        none = lengths[0][0]
        rows.append([part, *(f"{one[0]:.2f}" for one in lengths[:3]),
                     *(f"{statistics.mean(many):.2f} +- {statistics.stdev(many):.2f}" for many in lengths[3:])])
        rows.append(["gain, ours", "", *(f"{100 * (1 - statistics.mean(many) / none):.1f} %" for many in lengths[1:])])
        rows.append(["gain, thesis", "", *(f"{gain} %" for gain in thesis), ""])
    return table(["part", "none", "greedy", "ni2opt", "NRP, 2500", "BBCP, 2500", "BBCP, 5000", "`tabu`"], rows)


BLOCKS = {"methods": methods, "published": published, "reductions": reductions}
LONG_BLOCKS = {"proven": proven, "five_seeds": five_seeds}
GUIDES = ("README.md", "engine/TABU.md", "engine/EXACT.md")
PLACE = re.compile(r"(?s)(<!-- (long )?figures (\w+) -->\n)(.*?)(\n<!-- end of figures -->)")


def renewed(text, long=False):
    def now(found):
        if found[2] and not long:
            return found[0]
        return found[1] + (LONG_BLOCKS if found[2] else BLOCKS)[found[3]]() + found[5]
    return PLACE.sub(now, text)


def main(arguments):
    write = "--write" in arguments
    named = [name for name in arguments if not name.startswith("--")] or GUIDES
    faults = 0
    for name in named:
        guide = SOURCE / name
        text = guide.read_text(encoding="utf-8")
        if not PLACE.search(text):
            print(f"{name}: holds no figures")
            faults += 1
            continue
        now = renewed(text, long="--long" in arguments)
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
