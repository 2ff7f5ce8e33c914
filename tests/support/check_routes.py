#!/usr/bin/env python3
"""Checks what `traverse optimize PART.damat --json=ROUTES.json` wrote against the part (standard library only).

  check_routes.py PART.damat[.xz|.gz] ROUTES.json [--deposition=interleaved] [--cleaning=N,X,Y] [--first=A]

Holds for each layer: every contour and raster exactly once, by the file's labels; an order that the deposition allows; an
entry that exists; the stated start, which is where the layer before ended or the head was cleaned; the stated lengths. Reads
DAMAT in its own way, so that a fault of the reader shows. Prints each fault, then the totals. Exit 0: no fault, 1: faults.
"""
import argparse
import gzip
import json
import lzma
import math
import sys

TOLERANCE_MM = 1e-6


def read_text(path):
    opener = {"xz": lzma.open, "gz": gzip.open}.get(path.rsplit(".", 1)[-1], open)
    with opener(path, "rt", encoding="utf-8") as file:
        return file.read()


def read_part(text):
    """The layers in the file's order: (id, {(island, kind, id): points}, {island: id of its outer contour})."""
    layers = []
    island = None
    for line in text.splitlines():
        fields = [field.strip() for field in line.split("//")[0].split(",")]
        kind, label = fields[0][:1], fields[0][1:]
        if kind == "F":
            layers.append((int(label), {}, {}))
        elif kind == "I":
            island = int(label)
        elif kind in ("C", "R"):
            numbers = [float(field[1:]) for field in fields[1:]]
            points = list(zip(numbers[0::2], numbers[1::2]))
            if kind == "C" and len(points) > 1 and points[0] == points[-1]:
                del points[-1]
            name = "contour" if kind == "C" else "raster"
            layers[-1][1][island, name, int(label)] = points
            if kind == "C":
                layers[-1][2].setdefault(island, int(label))
    return layers


class Checker:
    def __init__(self, layers, interleaved=False, cleaning=None):
        self.layers = layers
        self.interleaved = interleaved
        self.cleaning = cleaning  # (every n layers, point)
        self.faults = []

    def fault(self, layer, what):
        self.faults.append(f"layer {layer}: {what}")

    def near(self, a, b):
        return abs(a - b) <= TOLERANCE_MM * max(1.0, abs(a))

    def ends(self, layer, visit, points):
        """Where the visit begins and ends; None if it cannot be done."""
        if visit["kind"] == "contour":
            entry = visit["entry"]
            if not isinstance(entry, int) or not 0 <= entry < len(points):
                self.fault(layer, f"no vertex {entry} in {visit}")
                return None
            return points[entry], points[entry]
        first, last = points[0], points[-1]
        return (last, first) if visit["reversed"] else (first, last)

    def check_order(self, layer, visits, outer):
        """The order of deposition: ranks that may not fall, within the layer or within each island."""
        if self.interleaved:
            islands = [visit["island"] for visit in visits]
            entered = [island for i, island in enumerate(islands) if i == 0 or islands[i - 1] != island]
            if len(set(entered)) != len(entered):
                self.fault(layer, "an island is entered twice")
        last = {}
        for visit in visits:
            scope = visit["island"] if self.interleaved else 0
            if visit["kind"] == "raster":
                rank = 2
            else:
                rank = 0 if not self.interleaved or outer[visit["island"]] == visit["id"] else 1
            if rank < last.get(scope, 0):
                self.fault(layer, f"out of order: {visit}")
            last[scope] = rank

    def check_layer(self, answer, part, at):
        """Checks one layer that begins at `at`; returns its length and its end."""
        name, paths, outer = part
        if answer["id"] != name:
            self.fault(name, f"has id {answer['id']}")
        if math.dist(answer["start"], at) > TOLERANCE_MM:
            self.fault(name, f"starts at {answer['start']}, not {at}")
        left = dict(paths)
        length = 0.0
        for visit in answer["route"]:
            points = left.pop((visit["island"], visit["kind"], visit["id"]), None)
            if points is None:
                self.fault(name, f"unknown or repeated: {visit}")
                continue
            ends = self.ends(name, visit, points)
            if ends:
                length += math.dist(at, ends[0])
                at = ends[1]
        for key in left:
            self.fault(name, f"missing: {key}")
        self.check_order(name, answer["route"], outer)
        if not self.near(length, answer["travel_mm"]):
            self.fault(name, f"states {answer['travel_mm']} mm, has {length} mm")
        bound = answer["lower_bound_mm"]
        if bound is not None and bound > length * (1 + 1e-6) + TOLERANCE_MM:
            self.fault(name, f"bound {bound} is above its own length {length}")
        return length, at

    def check(self, document, first=1):
        """Checks the document; layer `first` of the part is its first one. Returns travel and cleaning in mm."""
        answers = document["layers"]
        parts = self.layers[first - 1 : first - 1 + len(answers)]
        if len(parts) != len(answers):
            self.faults.append("more layers than the part has")
        at, travel, cleaning = (0.0, 0.0), 0.0, 0.0
        for number, (answer, part) in enumerate(zip(answers, parts), 1):
            length, at = self.check_layer(answer, part, at)
            travel += length
            if self.cleaning and number % self.cleaning[0] == 0:
                if number < len(answers):
                    cleaning += math.dist(at, self.cleaning[1])
                at = self.cleaning[1]
        total = document["total"]
        if not self.near(total["cleaning_mm"], cleaning):
            self.faults.append(f"states {total['cleaning_mm']} mm of cleaning, has {cleaning} mm")
        if not self.near(total["travel_mm"], travel + cleaning):
            self.faults.append(f"states {total['travel_mm']} mm in total, has {travel + cleaning} mm")
        if total["lower_bound_mm"] is not None and total["lower_bound_mm"] > travel + cleaning + TOLERANCE_MM:
            self.faults.append("the total's bound is above it")
        return travel, cleaning


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part")
    parser.add_argument("routes")
    parser.add_argument("--deposition", default="sequential", choices=("sequential", "interleaved"))
    parser.add_argument("--cleaning", help="N,X,Y")
    parser.add_argument("--first", type=int, default=1)
    arguments = parser.parse_args()
    cleaning = None
    if arguments.cleaning:
        every, x, y = arguments.cleaning.split(",")
        cleaning = int(every), (float(x), float(y))
    checker = Checker(read_part(read_text(arguments.part)), arguments.deposition == "interleaved", cleaning)
    with open(arguments.routes, encoding="utf-8") as file:
        travel, moves = checker.check(json.load(file), arguments.first)
    for fault in checker.faults[:50]:
        print(fault)
    print(f"travel {travel:.6f} mm, cleaning {moves:.6f} mm, {len(checker.faults)} faults")
    return 1 if checker.faults else 0


if __name__ == "__main__":
    sys.exit(main())
