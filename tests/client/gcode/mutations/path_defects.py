"""Defects of what is done within a path, and on the way to it. Kinds as in defects.py."""

import math
import re

from edits import edited, go, pick, with_xy
from places import links
from sliced import number


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
    return [go((x, y), line), go(line.start, line)]


def up_and_down(file, line):
    z = line.start[2]
    return [f"G1 Z{number(z + 0.4)} F600", f"G1 Z{number(z)}"]


def way_dropped(file, rng):
    """The path is drawn from where the head happens to be."""

    def make(k):
        ways = [i for i in file.link(k) if file.lines[i].kind == "travel"]
        if not ways or max(file.lines[i].length() for i in ways) < 0.2 or (
                any("Z" in file.lines[i].text for i in ways)):
            return None
        return edited(file, {i: [] for i in ways})

    return pick(rng, range(len(file.paths) - 1), 50, make)


def travel_ends_beside(file, rng):
    def make(k):
        ways = [i for i in file.link(k) if file.lines[i].kind == "travel"]
        if not ways or file.lines[ways[-1]].length() < 1 or not re.search(r" X.* Y", file.lines[ways[-1]].text):
            return None
        line = file.lines[ways[-1]]
        return edited(file, {ways[-1]: [with_xy(line.text, (line.end[0] + 0.2, line.end[1]))]})

    return pick(rng, range(len(file.paths) - 1), 50, make)


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
    ("retraction within a path", "whole_paths", within(pull_and_push), "free"),
    ("way within a path", "whole_paths", within(there_and_back), "free"),
    ("lift within a path", "whole_paths", within(up_and_down), "free"),
    ("dwell within a path", "same_print", within(lambda file, line: ["G4 P200"]), "free"),
    ("label within a path", "same_print", within(lambda file, line: ["; printing object x id:0 copy 0"]), "free"),
    ("way to a path dropped", "same_print", way_dropped, "free"),
    ("way ends beside its path", "same_print", travel_ends_beside, "free"),
    ("way made a thin line", "same_print", way_after_path_missing, "free"),
    ("feed rate of a path dropped", "same_print", feed_line_dropped, "free"),
)
