"""Defects of the order of paths, their direction and where they begin. Kinds as in defects.py."""

import math
import re

from edits import body, edited, go, pick, restated, reverse, without_path
from places import distance, is_outer, is_wall, steady
from sliced import number

LABEL = re.compile(r"; (?:printing|start printing) object|EXCLUDE_OBJECT_START|M624|M486 S\d|;PRINTING:")


def swap(file, k, other):
    """Paths k and other change places; links lead to where they did, and on from there."""
    changes = {}
    for here, there in ((k, other), (other, k)):
        path, comes = file.paths[here], file.paths[there]
        for i in range(path.first, path.last + 1):
            changes[i] = []
        begin = file.lines[path.first]
        changes[path.first] = ([go(comes.start, begin)] + restated(file, comes.first) +
                               body(file, comes) + [go(path.end, begin)] +
                               restated(file, path.last))
    return edited(file, changes)


def swapped(file, rng, wanted, near=0.45):
    def make(k):
        path = file.paths[k]
        for other in range(k + 1, min(k + 25, len(file.paths))):
            later = file.paths[other]
            if later.section != path.section or later.start[2] != path.start[2]:
                return None
            if path.plain and later.plain and wanted(path, later) and (
                    near is None or distance(path, later, near) <= near):
                return swap(file, k, other)
        return None

    return pick(rng, range(len(file.paths)), 400, make)


def infill_before_wall(file, rng):
    def wanted(one, other):
        names = ("infill", "fill", "skin", "surface", "perimeter", "wall")
        return is_wall(one) != is_wall(other) and all(
            any(name in path.type.lower() for name in names) for path in (one, other))

    return swapped(file, rng, wanted)


def walls_swapped(file, rng):
    return swapped(file, rng, lambda one, other: is_wall(one) and is_wall(other) and
                   is_outer(one) != is_outer(other))


def bridge_first(file, rng):
    def wanted(one, other):
        return "bridge" in other.type.lower() and "bridge" not in one.type.lower()

    return swapped(file, rng, wanted)


def support_swapped(file, rng):
    def wanted(one, other):
        names = one.type.lower(), other.type.lower()
        return ("support" in names[0]) != ("support" in names[1]) or (
            "support" in names[0] and names[0] != names[1])

    return swapped(file, rng, wanted)


def skirt_last(file, rng):
    def wanted(one, other):
        return "skirt" in one.type.lower() and "skirt" not in other.type.lower()

    return swapped(file, rng, wanted, None)


def ironing_first(file, rng):
    def wanted(one, other):
        return "ironing" in other.type.lower() and "top" in one.type.lower()

    return swapped(file, rng, wanted)


def monotonic_swapped(file, rng):
    if "top_fill_pattern = monotonic" not in file.text() and (
            "top_surface_pattern = monotonic" not in file.text()):
        return None
    return swapped(file, rng, lambda one, other: one.type == other.type and one.type.lower() in (
        "top solid infill", "top surface"))


def outer_reversed(file, rng):
    return pick(rng, [p for p in file.paths if is_outer(p) and steady(file, p)], 50,
                lambda p: edited(file, reverse(file, p)) if p.closed() else None)


def open_wall_reversed(file, rng):
    return pick(rng, [p for p in file.paths if is_wall(p) and steady(file, p)], 400,
                lambda p: None if p.closed() or math.dist(p.start, p.end) < 0.2
                else edited(file, reverse(file, p)))


def seam_moved(file, rng):
    def make(path):
        if not path.closed() or not steady(file, path):
            return None
        far = [k for k in range(2, len(path.deposits) - 1)
               if math.dist(path.points[k], path.start[:2]) > 1]
        if not far:
            return None
        k = rng.choice(far)
        lines = body(file, path)
        changes = {i: [] for i in range(path.first, path.last + 1)}
        feed = restated(file, path.first)
        gap = [f"G1 X{number(path.start[0])} Y{number(path.start[1])}"]
        begin = file.lines[path.first]
        changes[path.first] = ([go(path.points[k], begin)] + feed + lines[k:] + gap + lines[:k] +
                               [go(path.end, begin)] + feed)
        return edited(file, changes)

    return pick(rng, [p for p in file.paths if is_outer(p)], 100, make)


def layers_exchanged(file, rng):
    def make(k):
        for other in range(k + 1, min(k + 60, len(file.paths))):
            if file.paths[other].start[2] != file.paths[k].start[2]:
                one, two = file.paths[k], file.paths[other]
                both = one.plain and two.plain and body(file, one) != body(file, two)
                return swap(file, k, other) if both else None
        return None

    return pick(rng, range(len(file.paths)), 50, make)


def monotonic_reversed(file, rng):
    """A path of a monotonic surface the other way round."""
    if "top_fill_pattern = monotonic" not in file.text() and (
            "top_surface_pattern = monotonic" not in file.text()):
        return None
    tops = [p for p in file.paths if p.type.lower() in ("top solid infill", "top surface", "ironing")]
    return pick(rng, [p for p in tops if steady(file, p)], 50,
                lambda p: None if p.closed() else edited(file, reverse(file, p)))


def ironing_exchanged(file, rng):
    return swapped(file, rng, lambda one, other: one.type.lower() == other.type.lower() == "ironing")


def tower_exchanged(file, rng):
    def wanted(one, other):
        names = one.type.lower(), other.type.lower()
        return any(name in ("wipe tower", "prime tower", "prime-tower") for name in names)

    return swapped(file, rng, wanted, None)


def seam_by_one(file, rng):
    def make(path):
        if not path.closed() or not steady(file, path) or len(path.deposits) < 4:
            return None
        lines = body(file, path)
        feed = restated(file, path.first)
        changes = {i: [] for i in range(path.first, path.last + 1)}
        gap = [f"G1 X{number(path.start[0])} Y{number(path.start[1])}"]
        begin = file.lines[path.first]
        changes[path.first] = ([go(path.points[1], begin)] + feed + lines[1:] + gap + lines[:1] +
                               [go(path.end, begin)] + feed)
        return edited(file, changes)

    return pick(rng, [p for p in file.paths if is_outer(p)], 100, make)


def fill_under_wall(file, rng):
    """A support and its neighbour that is none, at the distance at which they are laid."""

    def wanted(one, other):
        return ("support" in one.type.lower()) != ("support" in other.type.lower()) and (
            distance(one, other, 0.3) <= 0.48)

    return swapped(file, rng, wanted, None)


def path_moved(file, rng):
    """A path is printed some paths later, where the head comes by."""

    def make(k):
        path, other = file.paths[k], file.paths[min(k + 7, len(file.paths) - 1)]
        if not path.plain or other.section == path.section or other.start[2] != path.start[2]:
            return None
        changes = without_path(path, [go(path.end, file.lines[path.first])])
        changes[other.first] = ([go(path.start, file.lines[other.first])] + restated(file, path.first) + body(file, path) +
                                [go(other.start, file.lines[other.first])] + restated(file, other.first) +
                                [file.lines[other.first].text])
        return edited(file, changes)

    return pick(rng, range(len(file.paths) - 8), 400, make)


def overhang_exchanged(file, rng):
    return swapped(file, rng, lambda one, two: ("overhang" in one.type.lower()) != ("overhang" in two.type.lower())
                   and is_wall(one) and is_wall(two))


def brim_late(file, rng):
    return swapped(file, rng, lambda one, two: "brim" in one.type.lower() and "brim" not in two.type.lower(), None)


def bridge_late(file, rng):
    """A bridge behind what is printed against it."""
    return swapped(file, rng, lambda one, two: "bridge" in one.type.lower() and "bridge" not in two.type.lower())


def surface_before_wall(file, rng):
    return swapped(file, rng, lambda one, two: is_outer(one) and "top" in two.type.lower())


def across_object(file, rng):
    """Two paths of one height on two sides of a label change places."""

    def make(k):
        one = file.paths[k]
        for other in range(k + 1, min(k + 40, len(file.paths))):
            two = file.paths[other]
            if two.start[2] != one.start[2]:
                return None
            if not any(LABEL.match(file.lines[i].text) for i in range(one.last, two.first)):
                continue
            if one.plain and two.plain and distance(one, two, 1) > 1:
                return swap(file, k, other) if body(file, one) != body(file, two) else None
        return None

    return pick(rng, range(len(file.paths)), 100, make)


def across_fan(file, rng):
    """Two paths far from each other change places though the fan changes between them."""

    def fan(path):
        return {key: text for key, text in file.lines[path.first].state.items() if key.startswith("M106")}

    def make(k):
        for other in range(k + 1, min(k + 30, len(file.paths))):
            one, two = file.paths[k], file.paths[other]
            if one.section != two.section or one.start[2] != two.start[2]:
                return None
            if one.plain and two.plain and fan(one) and fan(two) and fan(one) != fan(two) and (
                    distance(one, two, 1.0) > 1.0):
                return swap(file, k, other)
        return None

    return pick(rng, range(len(file.paths)), 400, make)


def wall_of_other_loop(file, rng):
    """Two outer walls that touch change places."""

    def make(k):
        one = file.paths[k]
        for other in range(k + 1, min(k + 25, len(file.paths))):
            two = file.paths[other]
            if two.section != one.section or two.start[2] != one.start[2]:
                return None
            if one.plain and two.plain and is_outer(two) and distance(one, two, 0.45) <= 0.45:
                return swap(file, k, other)
        return None

    return pick(rng, [k for k, p in enumerate(file.paths) if is_outer(p)], 100, make)


def whole_layers_exchanged(file, rng):
    """A layer is printed behind the next one, each at its height."""
    marks = [i for i, line in enumerate(file.lines) if file.is_layer(line.text)]

    def make(k):
        one, two, end = marks[k:k + 3]
        texts = [line.text for line in file.lines]
        return "\n".join(texts[:one] + texts[two:end] + texts[one:two] + texts[end:])

    return pick(rng, range(1, len(marks) - 3), 5, make)


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("infill and its wall exchanged", "order", infill_before_wall, "free"),
    ("outer and inner wall exchanged", "order", walls_swapped, "balanced"),
    ("bridge before its anchor", "order", bridge_first, "free"),
    ("support and what it carries exchanged", "order", support_swapped, "free"),
    ("skirt last", "order", skirt_last, "free"),
    ("ironing before what it irons", "order", ironing_first, "free"),
    ("lines of a monotonic surface exchanged", "order", monotonic_swapped, "balanced"),
    ("outer loop reversed", "direction", outer_reversed, "balanced"),
    ("open wall reversed", "direction", open_wall_reversed, "balanced"),
    ("seam moved", "seam", seam_moved, "safe"),
    ("paths of two layers exchanged", "same_print", layers_exchanged, "free"),
    ("monotonic path reversed", "direction", monotonic_reversed, "balanced"),
    ("lines of ironing exchanged", "order", ironing_exchanged, "free"),
    ("path of a tower exchanged", "order", tower_exchanged, "free"),
    ("support and its neighbour exchanged", "order", fill_under_wall, "free"),
    ("seam moved by a vertex", "seam", seam_by_one, "safe"),
    ("path in another part of the layer", "same_print", path_moved, "free"),
    ("paths of two objects exchanged", "same_print", across_object, "free"),
    ("overhanging wall and wall exchanged", "order", overhang_exchanged, "balanced"),
    ("brim behind what it holds", "order", brim_late, "free"),
    ("bridge behind what touches it", "order", bridge_late, "free"),
    ("surface before its wall", "order", surface_before_wall, "free"),
    ("paths exchanged across a change of the fan", "order", across_fan, "balanced"),
    ("walls of two outlines exchanged", "order", wall_of_other_loop, "balanced"),
    ("two layers exchanged", "same_print", whole_layers_exchanged, "free"),
)
