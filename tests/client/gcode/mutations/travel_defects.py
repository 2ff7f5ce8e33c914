"""Defects of the ways between paths: where they lead. Kinds as in defects.py."""

import math
import re

from edits import at_its_feed, edited, go, pick, restated, with_f, with_xy
from places import down_of, is_outer, lifted_links, links
from sliced import number


def way_far(file, rng):
    """A way leads to a point far from all the others."""
    return pick(rng, links(file), 5, lambda found: edited(
        file, {found[2][-1]: [go((-400, 700), file.lines[found[2][-1]]), file.lines[found[2][-1]].text]}))


def travel_feed(file, ways):
    return file.lines[ways[-1]].feed


def way_points(file, ways):
    return file.lines[ways[0]].start, file.lines[ways[-1]].end


def middle_of(file, i):
    line = file.lines[i]
    return [(line.start[a] + line.end[a]) / 2 for a in (0, 1)]


def cut_way(file, ways, between):
    """The last way in two parts with lines between them."""
    line = file.lines[ways[-1]]
    feed = number(line.feed)
    middle = middle_of(file, ways[-1])
    return [with_xy(line.text, middle)] + between + [
        f"G1 X{number(line.end[0])} Y{number(line.end[1])} F{feed}"]


def dip(file, rng):
    """The nozzle goes down into what is printed, and up again, where the way ends."""

    def make(found):
        k, _, ways, pushes = found
        z, behind = file.paths[k + 1].start[2], pushes[0]
        if file.lines[behind].start[2] != z:
            return None
        feed = max((line.feed for line in file.lines if line.kind == "z"), default=600)
        return edited(file, {behind: [f"G1 Z{number(z - 0.15)} F{number(feed)}", f"G1 Z{number(z)}"] +
                             at_its_feed(file, behind)})

    return pick(rng, links(file), 50, make)


def most_winding(file):
    """How much longer than straight the file's own ways are, at most."""
    most = 0
    for k in range(len(file.paths) - 1):
        ways = [file.lines[i] for i in file.link(k) if file.lines[i].kind == "travel"]
        if ways:
            most = max(most, sum(way.length() for way in ways) - math.dist(ways[0].start[:2], ways[-1].end[:2]))
    return most


def stray(retracted):
    """A way leads by a point that lies far off its line, within the room of the print."""

    def defect(file, rng):
        xs, ys = zip(*(path.start[:2] for path in file.paths))
        least = 3 * most_winding(file) + 2

        def make(found):
            ways = found
            i = ways[-1]
            line = file.lines[i]
            corner = max(((x, y) for x in (min(xs), max(xs)) for y in (min(ys), max(ys))),
                         key=lambda p: math.dist(p, line.start[:2]))
            farther = math.dist(corner, line.start[:2]) + math.dist(corner, line.end[:2]) - line.length()
            if farther < least or math.dist(corner, line.end[:2]) < 8 or line.start[2] != line.end[2] or (
                    "Z" in line.text):
                return None
            return edited(file, {i: [go(corner, line), line.text]})

        if retracted:
            return pick(rng, [found[2] for found in links(file)], 50, make)
        return pick(rng, open_travel(file), 50, make)

    return defect


def open_travel(file):
    """Travels within a layer with nothing pulled back."""
    found = []
    for k in range(len(file.paths) - 1):
        index = file.link(k)
        kinds = {file.lines[i].kind for i in index}
        if kinds <= {"travel", "feed", "comment", "command"} and "travel" in kinds and (
                file.paths[k].section == file.paths[k + 1].section):
            found.append([i for i in index if file.lines[i].kind == "travel"])
    return found


def way_twice(file, rng):
    """To the next path, back, and there again."""

    def make(found):
        _, _, ways, _ = found
        i = ways[-1]
        line = file.lines[i]
        if line.length() < 3 or line.start[2] != line.end[2]:
            return None
        back = f"G1 X{number(line.start[0])} Y{number(line.start[1])} F{number(line.feed)}"
        return edited(file, {i: [line.text, back, line.text]})

    return pick(rng, links(file), 50, make)


def open_way_slow(file, rng):
    travel = {line.feed for line in file.lines if line.kind == "travel"}

    def make(ways):
        i = ways[-1]
        if 1234 in travel or file.lines[i].length() < 1:
            return None
        after = next(k for k in range(i + 1, len(file.lines)) if file.lines[k].kind != "comment")
        return edited(file, {i: [with_f(file.lines[i].text, 1234)],
                             after: [f"G1 F{number(file.lines[i].feed)}", file.lines[after].text]})

    return pick(rng, open_travel(file), 50, make)


def way_beyond(file, rng):
    """A way leads 1 mm beyond its end, and back."""

    def make(found):
        _, _, ways, _ = found
        i = ways[-1]
        line = file.lines[i]
        if line.length() < 3 or line.start[2] != line.end[2] or not line.text.startswith(("G0 ", "G1 ")):
            return None
        beyond = [line.end[a] + (line.end[a] - line.start[a]) / line.length() for a in (0, 1)]
        return edited(file, {i: [with_xy(line.text, beyond), line.text]})

    return pick(rng, links(file), 60, make)


def way_along_wall(file, rng):
    """An open way is led along a stretch of an outer wall near to it."""
    walls = [p for p in file.paths if is_outer(p)]

    def make(ways):
        line = file.lines[ways[0]]
        if len(ways) != 1 or line.length() < 2 or not line.text.startswith(("G0 ", "G1 ")):
            return None
        for wall in walls:
            if wall.start[2] != line.end[2]:
                continue
            for one, other in zip(wall.points, wall.points[1:]):
                near = min(math.dist(one, line.start[:2]), math.dist(other, line.start[:2])) < 4
                if near and 1.5 < math.dist(one, other) < 8:
                    return edited(file, {ways[0]: [with_xy(line.text, one), with_xy(line.text, other), line.text]})
        return None

    return pick(rng, open_travel(file), 200, make)


def way_on_arc(file, rng):
    """A way sweeps along half a circle."""

    def make(found):
        line = file.lines[found[2][-1]]
        if line.length() < 4 or line.start[2] != line.end[2] or not line.text.startswith(("G0 ", "G1 ")):
            return None
        center = [number((line.end[a] - line.start[a]) / 2) for a in (0, 1)]
        text = f"G2{line.text.split(';')[0].rstrip()[2:]} I{center[0]} J{center[1]}"
        return edited(file, {found[2][-1]: [text]})

    return pick(rng, links(file), 60, make)


def in_short_legs(retracted):
    """A short way leads along X and then along Y."""

    def defect(file, rng):
        def make(i):
            line = file.lines[i]
            legs = sorted(abs(line.end[a] - line.start[a]) for a in (0, 1))
            if not 0.15 < legs[0] or legs[1] > 1.2 or line.start[2] != line.end[2]:
                return None
            return edited(file, {i: [go((line.end[0], line.start[1]), line), line.text]})

        pulled = {i for _, pulls, ways, _ in links(file) for i in ways}
        found = [i for k in range(len(file.paths) - 1) for i in file.link(k)
                 if file.lines[i].kind == "travel" and (i in pulled) == retracted and
                 file.paths[k].section == file.paths[k + 1].section]
        return pick(rng, found, 300, make)

    return defect


def kept_links(file, rng, make):
    """Of links that retract once, before they lead away."""
    found = [found for found in links(file) if len(found[1]) == 1 and found[1][0] < found[2][0]]
    return pick(rng, found, 200, make)


def along(start, end, length):
    """The point of the way that far from its start."""
    share = length / math.dist(start[:2], end[:2])
    return [start[a] + share * (end[a] - start[a]) for a in (0, 1)]


def pulled_late(file, rng):
    """The filament is pulled back 0.2 mm behind the end of the path."""

    def make(found):
        _, (pull,), (way, *_), _ = found
        line = file.lines[way]
        moved = any(file.lines[i].kind == "z" for i in range(pull + 1, way))
        if file.lines[pull].kind != "retract" or line.length() < 1 or moved:
            return None
        begin = go(along(line.start, line.end, 0.2), line)
        return edited(file, {pull: [], way: [begin, file.lines[pull].text, restated(file, way)[-1], line.text]})

    return kept_links(file, rng, make)


def poke(file, rng):
    """Before the way, the nozzle goes 0.3 mm back along the path and returns."""

    def make(found):
        path = file.paths[found[0]]
        line = file.lines[path.last]
        if line.text[:2] != "G1" or line.length() < 0.5:
            return None
        poked = [go(along(line.end, line.start, 0.3), line), go(path.end, line), restated(file, path.last)[-1]]
        return edited(file, {path.last: [line.text] + poked})

    return kept_links(file, rng, make)


def lifted_early(file, rng):
    """The head rises before it retracts."""

    def make(found):
        _, (pull,), (way, *_), _ = found
        rises = [i for i in range(pull + 1, way) if file.lines[i].kind == "z"]
        if len(rises) != 1 or file.lines[pull].kind != "retract":
            return None
        rise = file.lines[rises[0]]
        if rise.end[2] <= rise.start[2] or " F" not in rise.text or " F" not in file.lines[pull].text:
            return None
        return edited(file, {pull: [rise.text], rises[0]: [file.lines[pull].text]})

    return kept_links(file, rng, make)


def lift_with_way(file, rng):
    """The head rises while it leads away, not before."""

    def make(found):
        _, pulls, ways, _ = found
        up = next((i for i in range(pulls[-1] + 1, ways[0])
                   if file.lines[i].kind == "z" and re.match(r"G1 (F\S+ )?Z", file.lines[i].text)), None)
        if up is None or file.lines[up].end[2] <= file.lines[up].start[2] or "Z" in file.lines[ways[0]].text:
            return None
        line = file.lines[ways[0]]
        z = number(file.lines[up].end[2])
        return edited(file, {up: [], ways[0]: [f"{line.text.split(';')[0].rstrip()} Z{z}"]})

    return pick(rng, lifted_links(file), 50, make)


def down_with_way(file, rng):
    """The head sinks on its way, not where it ends."""

    def make(found):
        _, _, ways, _ = found
        down, line = down_of(file, found), file.lines[found[2][-1]]
        if down is None or "Z" in line.text or line.length() < 1 or (
                not re.match(r"G1 (F\S+ )?Z", file.lines[down].text)):
            return None
        z = number(file.lines[down].end[2])
        return edited(file, {down: [], ways[-1]: [f"{line.text.split(';')[0].rstrip()} Z{z}"]})

    return pick(rng, lifted_links(file), 50, make)


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("way to far away", "speeds", way_far, "free"),
    ("dip into the layer", "lifts", dip, "free"),
    ("retracted way astray", "bounds", stray(True), "free"),
    ("open way astray", "bounds", stray(False), "free"),
    ("short open way along X, then along Y", "bounds", in_short_legs(False), "free"),
    ("short retracted way along X, then along Y", "bounds", in_short_legs(True), "free"),
    ("way there, back and there", "bounds", way_twice, "free"),
    ("way beyond its end and back", "bounds", way_beyond, "free"),
    ("open way along a wall", "bounds", way_along_wall, "free"),
    ("way along an arc", "bounds", way_on_arc, "free"),
    ("retraction 0.2 mm late", "kept_travel", pulled_late, "free"),
    ("poke of 0.3 mm back along the path", "kept_travel", poke, "free"),
    ("lift before the retraction", "made_of_parts", lifted_early, "free"),
    ("open way at another speed", "speeds", open_way_slow, "free"),
    ("lift while leading away", "lifts", lift_with_way, "free"),
    ("down while leading there", "lifts", down_with_way, "free"),
)
