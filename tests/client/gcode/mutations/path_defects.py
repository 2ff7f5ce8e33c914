"""Defects of what is printed, and of what is done within a path. Kinds as in defects.py."""

import math
import re

from defects import (body, distance, edited, go, is_outer, is_wall, links, long_way, pick, restated, swap, swapped,
                     with_e, with_f, with_xy)
from further_defects import next_deposit, with_word
from sliced import number


LABEL = re.compile(r"; (?:printing|start printing) object|EXCLUDE_OBJECT_START|M624|M486 S\d|;PRINTING:")


def without_path(path, text=None):
    changes = {i: [] for i in range(path.first, path.last + 1)}
    if text is not None:
        changes[path.first] = text
    return changes


def path_dropped(file, rng):
    """The head goes on from where the path ends."""
    return pick(rng, file.paths, 5, lambda p: edited(file, without_path(p, [go(file, p.end)])))


def path_moved(file, rng):
    """A path is printed some paths later, where the head comes by."""

    def make(k):
        path, other = file.paths[k], file.paths[min(k + 7, len(file.paths) - 1)]
        if not path.plain or other.section == path.section or other.start[2] != path.start[2]:
            return None
        changes = without_path(path, [go(file, path.end)])
        changes[other.first] = ([go(file, path.start)] + restated(file, path.first) + body(file, path) +
                                [go(file, other.start)] + restated(file, other.first) +
                                [file.lines[other.first].text])
        return edited(file, changes)

    return pick(rng, range(len(file.paths) - 8), 400, make)


def of_whole_path(letter, factor):
    """A word of all lines of a path is multiplied."""

    def defect(file, rng):
        def make(path):
            if not path.plain or sum(file.lines[i].e for i in path.deposits) < 0.05:
                return None
            return edited(file, {i: [with_word(file.lines[i].text, letter, lambda v: v * factor)]
                                 for i in path.deposits})

        return pick(rng, file.paths, 50, make)

    return defect


def path_faster(file, rng):
    def make(path):
        line = file.lines[path.first]
        after = next((i for i in range(path.last + 1, len(file.lines)) if file.lines[i].kind != "comment"), None)
        if not path.plain or after is None:
            return None
        return edited(file, {path.first: [f"G1 F{number(line.feed * 1.01)}",
                                          re.sub(r"\s*F[0-9.]+", "", line.text)],
                             after: [f"G1 F{number(file.lines[path.last].feed)}", file.lines[after].text]})

    return pick(rng, file.paths, 50, make)


def path_at_height(by):
    """A path is printed higher or lower than its layer."""

    def defect(file, rng):
        def make(path):
            z = path.start[2]
            if not path.plain or z + by < 0.05 or any("Z" in file.lines[i].text for i in path.deposits):
                return None
            changes = {path.first: [f"G1 Z{number(z + by)}"] + restated(file, path.first) +
                       [file.lines[path.first].text]}
            changes[path.last] = changes.get(path.last, [file.lines[path.last].text]) + [f"G1 Z{number(z)}"]
            return edited(file, changes)

        return pick(rng, file.paths, 50, make)

    return defect


def segment_in_two(file, rng):
    def make(path):
        i = max(path.deposits, key=lambda k: file.lines[k].length())
        line = file.lines[i]
        if not path.plain or line.length() < 1 or line.e < 0.01 or "E" not in line.text:
            return None
        middle = [(line.start[a] + line.end[a]) / 2 for a in (0, 1)]
        return edited(file, {i: [f"G1 X{number(middle[0])} Y{number(middle[1])} E{number(line.e / 2)}",
                                 f"G1 X{number(line.end[0])} Y{number(line.end[1])} E{number(line.e / 2)}"]})

    return pick(rng, file.paths, 50, make)


def segments_in_one(file, rng):
    def make(path):
        for a, b in zip(path.deposits, path.deposits[1:]):
            one, two = file.lines[a], file.lines[b]
            if path.plain and "E" in one.text and "E" in two.text:
                return edited(file, {a: [f"G1 X{number(two.end[0])} Y{number(two.end[1])} "
                                         f"E{number(one.e + two.e)}"], b: []})
        return None

    return pick(rng, file.paths, 50, make)


def lines_exchanged(file, rng):
    """Two lines of a path in the other order."""

    def make(path):
        if len(path.deposits) < 3 or not path.plain:
            return None
        k = rng.randrange(len(path.deposits) - 1)
        a, b = path.deposits[k], path.deposits[k + 1]
        return edited(file, {a: [file.lines[b].text], b: [file.lines[a].text]})

    return pick(rng, file.paths, 20, make)


# --- within a path ---------------------------------------------------------------------------------


def within(make_lines):
    """Lines come in between two segments of a path."""

    def defect(file, rng):
        def make(path):
            if len(path.deposits) < 3 or not path.plain or path.last - path.first + 1 != len(path.deposits):
                return None
            i = path.deposits[1]
            lines = make_lines(file, file.lines[i])
            if lines is None:
                return None
            return edited(file, {i: lines + [f"G1 F{number(file.lines[i].feed)}", file.lines[i].text]})

        return pick(rng, file.paths, 50, make)

    return defect


def pull_and_push(file, line):
    del line
    found = next(iter(links(file)), None)
    if found is None:
        return None
    pull, push = file.lines[found[1][-1]], file.lines[found[3][-1]]
    return [f"G1 E{number(pull.e)} F{number(pull.feed)}", f"G1 E{number(-pull.e)} F{number(push.feed)}"]


def there_and_back(file, line):
    x, y = line.start[0] + 2, line.start[1] + 1
    return [go(file, (x, y)), go(file, line.start)]


def up_and_down(file, line):
    z = line.start[2]
    return [f"G1 Z{number(z + 0.4)} F600", f"G1 Z{number(z)}"]


# --- where a path begins and ends ------------------------------------------------------------------


def way_dropped(file, rng):
    """The path is drawn from where the head happens to be."""

    def make(k):
        ways = [i for i in file.link(k) if file.lines[i].kind == "travel"]
        if not ways or max(file.lines[i].length() for i in ways) < 0.2 or (
                any("Z" in file.lines[i].text for i in ways)):
            return None
        return edited(file, {i: [] for i in ways})

    return pick(rng, range(len(file.paths) - 1), 50, make)


def way_ends_beside(file, rng):
    def make(k):
        ways = [i for i in file.link(k) if file.lines[i].kind == "travel"]
        if not ways or file.lines[ways[-1]].length() < 1 or not re.search(r" X.* Y", file.lines[ways[-1]].text):
            return None
        line = file.lines[ways[-1]]
        return edited(file, {ways[-1]: [with_xy(line.text, (line.end[0] + 0.2, line.end[1]))]})

    return pick(rng, range(len(file.paths) - 1), 50, make)


def primed_late(file, rng):
    """Filament comes back behind the first segment."""

    def make(found):
        first = next_deposit(file, found[3][-1])
        changes = {i: [] for i in found[3]}
        changes[first] = [file.lines[first].text] + [file.lines[i].text for i in found[3]] + [
            f"G1 F{number(file.lines[first].feed)}"]
        return edited(file, changes)

    return pick(rng, links(file), 5, make)


def primed_by_segment(file, rng):
    """The filament comes back with the first segment."""

    def make(found):
        first = next_deposit(file, found[3][-1])
        line = file.lines[first]
        if not re.search(r"E-?[0-9.]", line.text) or re.search(r"G[23]", line.text):
            return None
        pushed = sum(file.lines[i].e for i in found[3])
        changes = {i: [] for i in found[3]}
        changes[first] = [with_e(line.text, lambda _: line.e + pushed)]
        return edited(file, changes)

    return pick(rng, links(file), 20, make)


def pulled_early(file, rng):
    """Filament is pulled back before the last segment."""

    def make(found):
        k, pulls, _, _ = found
        path = file.paths[k]
        if not path.plain or any(file.lines[i].kind != "retract" for i in pulls) or len(path.deposits) < 2:
            return None
        changes = {i: [] for i in pulls}
        changes[path.last] = [file.lines[i].text for i in pulls] + restated(file, path.last) + [
            file.lines[path.last].text]
        return edited(file, changes)

    return pick(rng, links(file), 50, make)


def only_pulled(which):
    """Of a retraction and its priming one is dropped, or done twice."""

    def defect(file, rng):
        def make(found):
            kind, times = which
            index = found[1] if kind == "pull" else found[3]
            if any(file.lines[i].kind == "wipe" for i in index):
                return None
            return edited(file, {i: [file.lines[i].text] * times for i in index})

        return pick(rng, links(file), 20, make)

    return defect


def feed_line_dropped(file, rng):
    """What sets the feed rate of a path, on a line of its own."""

    def make(path):
        for i in range(path.first - 1, max(0, path.first - 12), -1):
            line = file.lines[i]
            if line.kind == "feed" and re.match(r"G1 F", line.text):
                before = next((one.feed for one in reversed(file.lines[:i]) if one.feed), 0)
                said = re.search(r"F\d", file.lines[path.first].text)
                return edited(file, {i: []}) if before != line.feed and not said else None
            if line.kind in ("deposit", "travel"):
                return None
        return None

    return pick(rng, file.paths, 50, make)


# --- order -----------------------------------------------------------------------------------------


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


# --- ways ------------------------------------------------------------------------------------------


def of_all(kind, change):
    """The same change to all moves of a kind."""

    def defect(file, _):
        changes = {i: [change(line)] for i, line in enumerate(file.lines)
                   if line.kind == kind and file.paths[0].first < i < file.paths[-1].first}
        changes = {i: made for i, made in changes.items() if made != [file.lines[i].text]}
        return edited(file, changes) if len(changes) > 3 else None

    return defect


def way_faster(file, rng):
    feeds = {number(line.feed) for line in file.lines if line.feed}

    def make(found):
        i = found[2][-1]
        line = file.lines[i]
        if number(line.feed * 1.1) in feeds or not long_way(file, found):
            return None
        after = next(k for k in range(i + 1, len(file.lines)) if file.lines[k].kind != "comment")
        return edited(file, {i: [with_f(line.text, line.feed * 1.1)],
                             after: [f"G1 F{number(line.feed)}", file.lines[after].text]})

    return pick(rng, links(file), 20, make)


def lift_lower_by(um):
    def change(line):
        return with_word(line.text, "Z", lambda z: z - um / 1000) if line.end[2] > line.start[2] else line.text

    return change


def way_after_path_missing(file, rng):
    """The head stays where a path ends, and the next path begins there with a line of its own."""

    def make(k):
        one, two = file.paths[k], file.paths[k + 1]
        if one.section != two.section or one.start[2] != two.start[2] or not two.plain:
            return None
        if math.dist(one.end[:2], two.start[:2]) < 1:
            return None
        first = file.lines[two.first]
        link = [i for i in file.link(k) if file.lines[i].kind == "travel"]
        if not link or any("Z" in file.lines[i].text for i in link):
            return None
        changes = {i: [] for i in link}
        changes[two.first] = [f"G1 X{number(two.start[0])} Y{number(two.start[1])} E0.00001", first.text]
        return edited(file, changes)

    return pick(rng, range(len(file.paths) - 1), 100, make)


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("path dropped", "same_print", path_dropped, "free"),
    ("path in another part of the layer", "same_print", path_moved, "free"),
    ("paths of two objects exchanged", "same_print", across_object, "free"),
    ("path with 2 % less filament", "same_print", of_whole_path("E", 0.98), "free"),
    ("path at a feed rate 1 % higher", "same_print", path_faster, "free"),
    ("path 0.2 mm higher", "same_print", path_at_height(0.2), "free"),
    ("path 0.1 mm lower", "same_print", path_at_height(-0.1), "free"),
    ("segment in two parts", "same_print", segment_in_two, "free"),
    ("two segments made one", "same_print", segments_in_one, "free"),
    ("two lines of a path exchanged", "same_print", lines_exchanged, "free"),
    ("retraction within a path", "whole_paths", within(pull_and_push), "free"),
    ("way within a path", "whole_paths", within(there_and_back), "free"),
    ("lift within a path", "whole_paths", within(up_and_down), "free"),
    ("dwell within a path", "same_print", within(lambda file, line: ["G4 P200"]), "free"),
    ("label within a path", "same_print", within(lambda file, line: ["; printing object x id:0 copy 0"]), "free"),
    ("way to a path dropped", "same_print", way_dropped, "free"),
    ("way ends beside its path", "same_print", way_ends_beside, "free"),
    ("way made a thin line", "same_print", way_after_path_missing, "free"),
    ("filament back a segment late", "same_print", primed_late, "free"),
    ("filament back with a segment", "same_print", primed_by_segment, "free"),
    ("filament pulled back a segment early", "same_print", pulled_early, "free"),
    ("retraction dropped, and not its priming", "standstill", only_pulled(("pull", 0)), "free"),
    ("retraction done twice", "same_print", only_pulled(("pull", 2)), "free"),
    ("priming done twice", "standstill", only_pulled(("push", 2)), "free"),
    ("feed rate of a path dropped", "same_print", feed_line_dropped, "free"),
    ("overhanging wall and wall exchanged", "order", overhang_exchanged, "balanced"),
    ("brim behind what it holds", "order", brim_late, "free"),
    ("bridge behind what touches it", "order", bridge_late, "free"),
    ("surface before its wall", "order", surface_before_wall, "free"),
    ("way a tenth faster", "speeds", way_faster, "free"),
    ("all ways a tenth faster", "speeds", of_all("travel", lambda line: with_word(
        line.text, "F", lambda f: f * 1.1)), "free"),
    ("all lifts 0.05 mm lower", "lifts", of_all("z", lift_lower_by(50)), "free"),
    ("all retractions a tenth slower", "speeds", of_all("retract", lambda line: with_word(
        line.text, "F", lambda f: f * 0.9)), "free"),
)
