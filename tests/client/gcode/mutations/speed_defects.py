"""Defects of the speed and acceleration between paths. Kinds as in defects.py."""

import re

from edits import edited, pick, with_f
from places import links, long_way
from sliced import number


def travel_slow(file, rng):
    travel = {line.feed for line in file.lines if line.kind == "travel"}

    def make(found):
        k, _, ways, _ = found
        feed = next((f for f in (file.lines[file.paths[k].last].feed, 1234) if f not in travel))
        follower = next(i for i in range(ways[-1] + 1, len(file.lines)) if file.lines[i].kind != "comment")
        return edited(file, {ways[-1]: [with_f(file.lines[ways[-1]].text, feed)],
                             follower: [f"G1 F{number(file.lines[ways[-1]].feed)}",
                                        file.lines[follower].text]})

    return pick(rng, links(file), 20, make)


def retraction_slow(file, rng):
    def make(found):
        _, pulls, _, _ = found
        i = pulls[0]
        return edited(file, {i: [with_f(file.lines[i].text, 777),
                                 f"G1 F{number(file.lines[i].feed)}"]})

    return pick(rng, links(file), 20, make)


def last_retraction_slow(file, rng):
    """Behind the last path, in front of the end script."""
    end = min(len(file.lines), file.paths[-1].last + 40)
    index = next((i for i in range(file.paths[-1].last + 1, end)
                  if file.lines[i].kind in ("retract", "command", "other")), None)
    if index is None or file.lines[index].kind != "retract":
        return None
    line = file.lines[index]
    return edited(file, {index: [with_f(line.text, line.feed / 2), f"G1 F{number(line.feed)}"]})


def travel_acceleration(file, rng):
    def make(found):
        _, _, ways, _ = found
        i = ways[-1]
        setter = file.lines[i].state.get("M204")
        if setter is None:
            return None
        other = re.sub(r"([SPT])[0-9.]+", r"\g<1>333", setter)
        return edited(file, {i: [other, file.lines[i].text, setter]})

    return pick(rng, links(file), 20, make)


def around(wanted):
    """The first move of a link that is `wanted` is done under another acceleration."""

    def defect(file, rng):
        def make(found):
            i = wanted(file, found)
            setter = i is not None and file.lines[i].state.get("M204")
            if not setter:
                return None
            other = re.sub(r"([SPTR])[0-9.]+", r"\g<1>333", setter)
            return edited(file, {i: [other, file.lines[i].text, setter]})

        return pick(rng, links(file), 50, make)

    return defect


def retraction_of(file, found):
    return next((i for i in found[1] if file.lines[i].kind == "retract"), None)


def wipe_of(file, found):
    return next((i for i in found[1] if file.lines[i].kind == "wipe"), None)


def lift_of(file, found):
    return next((i for i in range(found[1][-1], found[2][0]) if file.lines[i].kind == "z"), None)


def lift_slow(file, rng):
    def make(found):
        i = lift_of(file, found)
        return None if i is None else edited(file, {i: [with_f(file.lines[i].text, 123),
                                                        f"G1 F{number(file.lines[i].feed)}"]})

    return pick(rng, links(file), 50, make)


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


def way_of_other_layer(file, rng):
    """As fast as the ways of other layers, and as none of its own."""
    feeds, layers = [set()], []
    for line in file.lines:
        if file.is_layer(line.text):
            feeds.append(set())
        if line.kind == "travel":
            feeds[-1].add(number(line.feed))
        layers.append(len(feeds) - 1)
    known = set().union(*feeds[1:])

    def make(found):
        i = found[2][-1]
        line = file.lines[i]
        others = sorted(known - feeds[layers[i]])
        if not others or layers[i] == 0:
            return None
        after = next(k for k in range(i + 1, len(file.lines)) if file.lines[k].kind != "comment")
        return edited(file, {i: [with_f(line.text, float(rng.choice(others)))],
                             after: [f"G1 F{number(line.feed)}", file.lines[after].text]})

    return pick(rng, links(file), 20, make)


def as_fast_as_travel(kind, place):
    """The last move of `kind` in list `place` of a link is as fast as travel, and as no such move of its
    layer."""

    def defect(file, rng):
        feeds, layers = [set()], []
        for line in file.lines:
            if file.is_layer(line.text):
                feeds.append(set())
            if line.kind == kind:
                feeds[-1].add(number(line.feed))
            layers.append(len(feeds) - 1)
        travel = {number(line.feed) for line in file.lines if line.kind == "travel"}

        def make(found):
            i = found[place][-1]
            line = file.lines[i]
            others = sorted(travel - feeds[layers[i]])
            if line.kind != kind or not others or layers[i] == 0:
                return None
            return edited(file, {i: [with_f(line.text, float(rng.choice(others))),
                                     f"G1 F{number(line.feed)}"]})

        return pick(rng, links(file), 50, make)

    return defect


def tail_at_half_speed(file, rng):
    """What goes on along a path without filament is half as fast."""

    def make(k):
        link = list(file.link(k))
        ways = [i for i in link if file.lines[i].kind == "travel"]
        printed = file.lines[file.paths[k].last].feed
        if len(ways) < 2 or ways[0] != link[0] or file.lines[ways[0]].length() < 0.02:
            return None
        if file.lines[ways[0]].feed != printed or file.lines[ways[1]].feed <= printed:
            return None
        return edited(file, {ways[0]: [with_f(file.lines[ways[0]].text, printed / 2)],
                             ways[1]: [with_f(file.lines[ways[1]].text, file.lines[ways[1]].feed)]})

    return pick(rng, range(len(file.paths) - 1), 400, make)


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("travel at another speed", "speeds", travel_slow, "free"),
    ("retraction at another speed", "speeds", retraction_slow, "free"),
    ("last retraction at half its speed", "speeds", last_retraction_slow, "free"),
    ("travel under another acceleration", "speeds", travel_acceleration, "free"),
    ("lift at another speed", "speeds", lift_slow, "free"),
    ("retraction under another acceleration", "speeds", around(retraction_of), "free"),
    ("wipe under another acceleration", "speeds", around(wipe_of), "free"),
    ("lift under another acceleration", "speeds", around(lift_of), "free"),
    ("way at the speed of another layer", "speeds", way_of_other_layer, "free"),
    ("retraction as fast as travel", "speeds", as_fast_as_travel("retract", 1), "free"),
    ("priming as fast as travel", "speeds", as_fast_as_travel("prime", 3), "free"),
    ("along a path's end at half its speed", "path_ends", tail_at_half_speed, "free"),
    ("way a tenth faster", "speeds", way_faster, "free"),
)
