"""Defects of what is done between paths: ways, lifts, retractions, wipes. Kinds as in defects.py."""

import math
import re

from defects import (crosses_wall, edited, go, lifted, links, long_way, pick, restated, way_of, wiped, with_e,
                     with_f, with_xy, with_z)
from further_defects import at_its_feed, down_of, with_word
from sliced import number


def travel_feed(file, ways):
    return file.lines[ways[-1]].feed


def way_points(file, ways):
    return file.lines[ways[0]].start, file.lines[ways[-1]].end


def level(file, found):
    """The whole way lies at the height of both paths."""
    k, pulls, ways, pushes = found
    z = file.paths[k].start[2]
    return file.paths[k + 1].start[2] == z and all(
        file.lines[i].start[2] == file.lines[i].end[2] == z for i in range(pulls[0], pushes[-1] + 1)
        if file.lines[i].kind != "comment" and file.lines[i].kind != "command")


# --- where the head goes ---------------------------------------------------------------------------


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
            return edited(file, {i: [go(file, corner).rsplit(" ", 1)[0] + f" F{number(line.feed)}", line.text]})

        if retracted:
            return pick(rng, [found[2] for found in links(file)], 50, make)
        return pick(rng, open_ways(file), 50, make)

    return defect


def open_ways(file):
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

    return pick(rng, open_ways(file), 50, make)


def lift_twice(file, rng):
    """Up, down and up again before the way."""

    def make(found):
        index, z = way_of(file, found)
        ups = [i for i in index if file.lines[i].kind == "z" and file.lines[i].end[2] > file.lines[i].start[2]]
        if not ups:
            return None
        up = file.lines[ups[0]]
        return edited(file, {ups[0]: [up.text, f"G1 Z{number(up.start[2])}", f"G1 Z{number(up.end[2])}"]})

    return pick(rng, lifted(file), 50, make)


def some_lift_dropped(file, rng):
    """Of a way across a wall, whatever other ways do."""

    def make(found):
        k, pulls, ways, _ = found
        z = file.paths[k + 1].start[2]
        if file.paths[k].start[2] != z or max(file.lines[i].end[2] for i in ways) < z + 0.05 or (
                not long_way(file, found) or not crosses_wall(file, k, ways)):
            return None
        index = range(pulls[-1] + 1, ways[-1] + 1)
        return edited(file, {i: [with_z(file.lines[i].text, z)] for i in index
                             if file.lines[i].kind in ("z", "travel")})

    return pick(rng, links(file), 150, make)


def descends_on_way(file, rng):
    """Down to the layer halfway."""

    def make(found):
        k, _, ways, _ = found
        index, z = way_of(file, found)
        i = ways[-1]
        line = file.lines[i]
        down = down_of(file, (k, None, ways, found_pushes(file, k)))
        if line.length() < 6 or down is None or line.start[2] != line.end[2]:
            return None
        middle = [(line.start[a] + line.end[a]) / 2 for a in (0, 1)]
        return edited(file, {i: [with_xy(line.text, middle), file.lines[down].text,
                                 f"G1 X{number(line.end[0])} Y{number(line.end[1])} F{number(line.feed)}"],
                             down: []})

    return pick(rng, lifted(file), 50, make)


def found_pushes(file, k):
    return [i for i in file.link(k) if file.lines[i].kind == "prime"] or [file.paths[k + 1].first]


def spiral_wider(file, rng):
    """A spiral lift goes round a wider circle."""
    found = [i for i, line in enumerate(file.lines) if line.kind == "z" and re.match(r"G[23] .*I", line.text)]
    return pick(rng, found, 1, lambda i: edited(
        file, {i: [with_word(file.lines[i].text, "I", lambda v: v * 3 + 2)]}))


def wipe_arc_wider(file, rng):
    found = [i for i, line in enumerate(file.lines) if line.kind == "wipe" and re.match(r"G[23] .*I", line.text)]
    return pick(rng, found, 1, lambda i: edited(
        file, {i: [("G3" if file.lines[i].text[1] == "2" else "G2") + file.lines[i].text[2:]]}))


# --- filament --------------------------------------------------------------------------------------


def halves(text):
    e = float(re.search(r"E(-?[0-9.]+)", text).group(1))
    return with_e(text, lambda _: e / 2), f"G1 E{number(e / 2)}"


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


def plain_way(file, found):
    """No filament moves sideways in the link."""
    _, pulls, ways, pushes = found
    line = file.lines[ways[-1]]
    return all(file.lines[i].kind == "retract" for i in pulls) and len(pushes) == 1 and (
        line.length() > 2 and line.start[2] == line.end[2] and line.text.startswith(("G0", "G1")))


def primed_on_way(file, rng):
    """Half of the filament comes back halfway."""

    def make(found):
        _, _, ways, pushes = found
        if not plain_way(file, found):
            return None
        one, two = halves(file.lines[pushes[0]].text)
        one = with_f(one, file.lines[pushes[0]].feed)
        return edited(file, {ways[-1]: cut_way(file, ways, [one]),
                             pushes[0]: [with_f(two, file.lines[pushes[0]].feed)]})

    return pick(rng, links(file), 50, make)


def pulled_late(share):
    """Filament, or half of it, is pulled back halfway."""

    def defect(file, rng):
        def make(found):
            k, pulls, ways, _ = found
            if not plain_way(file, found) or len(pulls) != 1 or len(ways) != 1 or not level(file, found) or (
                    crosses_wall(file, k, ways)):
                return None
            pull = file.lines[pulls[0]]
            one, two = halves(pull.text)
            between = [with_f(two if share == 0.5 else pull.text, pull.feed)]
            return edited(file, {pulls[0]: [one] if share == 0.5 else [],
                                 ways[0]: cut_way(file, ways, between)})

        return pick(rng, links(file), 400, make)

    return defect


def longest_open(file):
    return max((sum(file.lines[i].length() for i in ways) for ways in open_ways(file)), default=0)


def retraction_dropped_within(file, rng):
    """Of the longest ways that cross no wall, where no open way is as long by far."""
    least = 2 * longest_open(file) + 2
    found = [found for found in links(file) if level(file, found) and
             sum(file.lines[i].length() for i in found[2]) > least]
    found.sort(key=lambda one: -sum(file.lines[i].length() for i in one[2]))
    found = [one for one in found[:200] if not crosses_wall(file, one[0], one[2])][:5]

    def make(one):
        _, pulls, _, pushes = one
        if any(file.lines[i].kind != "retract" for i in pulls):
            return None
        return edited(file, {i: [] for i in list(pulls) + list(pushes)})

    return pick(rng, found, 5, make)


def retraction_to_layer_dropped(file, rng):
    def make(k):
        index = list(file.link(k))
        pulls = [i for i in index if file.lines[i].kind in ("retract", "wipe") and file.lines[i].e < 0]
        pushes = [i for i in index if file.lines[i].kind == "prime"]
        ways = [i for i in index if file.lines[i].kind == "travel"]
        if not pulls or not pushes or file.paths[k].start[2] >= file.paths[k + 1].start[2] or (
                sum(file.lines[i].e for i in pulls + pushes) > 0.001 or not ways):
            return None
        changes = {i: [re.sub(r"\s*E-?[0-9.]+", "", file.lines[i].text)] if file.lines[i].kind == "wipe" else []
                   for i in pulls}
        changes.update({i: [] for i in pushes})
        return edited(file, changes)

    return pick(rng, range(len(file.paths) - 1), len(file.paths), make)


def own_habits(file):
    """What the file does itself between two paths: ("idle", pulls and pushes without a way),
    ("early", goes on when filament is back)."""
    habits = set()
    for k in range(len(file.paths) - 1):
        kinds = [file.lines[i].kind for i in file.link(k)
                 if file.lines[i].kind in ("retract", "prime", "travel")]
        for one, two in zip(kinds, kinds[1:]):
            habits.add((one, two))
    return {name for name, pair in (("idle", ("retract", "prime")), ("early", ("prime", "travel")))
            if pair in habits}


def needless_retraction(file, rng):
    """Pulled back and pushed again where nothing moves."""
    if "idle" in own_habits(file):
        return None

    def make(found):
        _, pulls, _, pushes = found
        if any(file.lines[i].kind != "retract" for i in pulls) or len(pushes) != 1:
            return None
        again = [with_f(file.lines[i].text, file.lines[i].feed) for i in pulls + pushes]
        return edited(file, {pushes[0]: [file.lines[pushes[0]].text] + again})

    return pick(rng, links(file), 20, make)


def all_off(kind, by):
    """All retractions, or all that undoes them, by a little more or less."""

    def defect(file, _):
        changes = {i: [with_e(line.text, lambda e: e + by)] for i, line in enumerate(file.lines)
                   if line.kind == kind and abs(line.e) > 0.2 and file.paths[0].first < i < file.paths[-1].first}
        return edited(file, changes) if len(changes) > 5 else None

    return defect


def firmware_doubled(name):
    def defect(file, rng):
        found = [i for i, line in enumerate(file.lines) if re.fullmatch(name + r"\s*(;.*)?", line.text) and
                 i > file.paths[0].first]
        return pick(rng, found, 1, lambda i: edited(file, {i: [file.lines[i].text] * 2}))

    return defect


def prime_slow(file, rng):
    return pick(rng, links(file), 20, lambda found: edited(
        file, {found[3][-1]: [with_f(file.lines[found[3][-1]].text, 77),
                              f"G1 F{number(file.lines[found[3][-1]].feed)}"]}))


def primed_elsewhere(file, rng):
    """Filament comes back a little before the path, and the rest of the way is open."""
    if "early" in own_habits(file):
        return None

    def make(found):
        _, _, ways, pushes = found
        line = file.lines[ways[-1]]
        if not plain_way(file, found) or line.length() < 3:
            return None
        t = 1 - 0.4 / line.length()
        near = [line.start[a] + (line.end[a] - line.start[a]) * t for a in (0, 1)]
        rest = f"G1 X{number(line.end[0])} Y{number(line.end[1])} F{number(line.feed)}"
        return edited(file, {ways[-1]: [with_xy(line.text, near)],
                             pushes[0]: [file.lines[pushes[0]].text, rest] + restated(file, pushes[0])})

    return pick(rng, links(file), 50, make)


# --- wipes -----------------------------------------------------------------------------------------


def wipe_slow(file, rng):
    def make(found):
        _, wipes = found
        i = wipes[0]
        return edited(file, {i: [with_f(file.lines[i].text, 321)],
                             i + 1: [f"G1 F{number(file.lines[i].feed)}", file.lines[i + 1].text]})

    return pick(rng, wiped(file), 20, make)


def wipe_pulls_at_once(file, rng):
    """All of a wipe's filament is pulled in its first move."""

    def make(found):
        _, wipes = found
        if len(wipes) < 2 or file.lines[wipes[0]].length() > 0.5 * sum(file.lines[i].length() for i in wipes):
            return None
        pulled = sum(file.lines[i].e for i in wipes)
        changes = {i: [with_e(file.lines[i].text, lambda _: 0)] for i in wipes[1:]}
        changes[wipes[0]] = [with_e(file.lines[wipes[0]].text, lambda _: pulled)]
        return edited(file, changes)

    return pick(rng, wiped(file), 200, make)


def wipe_without_filament(file, rng):
    """The wipe's filament is pulled before it."""

    def make(found):
        _, wipes = found
        pulled = sum(file.lines[i].e for i in wipes)
        changes = {i: [re.sub(r"\s*E-?[0-9.]+", "", file.lines[i].text)] for i in wipes}
        changes[wipes[0]] = [f"G1 E{number(pulled)}"] + changes[wipes[0]]
        return edited(file, changes)

    return pick(rng, wiped(file), 20, make)


def wipe_of_other_path(file, rng):
    """A path that is not wiped gets the wipe of none."""

    def make(found):
        _, pulls, ways, _ = found
        if any(file.lines[i].kind != "retract" for i in pulls):
            return None
        pull, at = file.lines[pulls[-1]], file.lines[pulls[-1]].start
        return edited(file, {pulls[-1]: [f"G1 X{number(at[0] + 1.3)} Y{number(at[1] + 0.8)} E{number(pull.e)} "
                                         f"F{number(pull.feed)}"]})

    return pick(rng, links(file), 20, make)


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("dip into the layer", "lifts", dip, "free"),
    ("retracted way astray", "bounds", stray(True), "free"),
    ("open way astray", "bounds", stray(False), "free"),
    ("way there, back and there", "bounds", way_twice, "free"),
    ("open way at another speed", "speeds", open_way_slow, "free"),
    ("lifted twice", "lifts", lift_twice, "free"),
    ("lift across a wall dropped", "lifts", some_lift_dropped, "free"),
    ("down halfway", "lifts", descends_on_way, "free"),
    ("spiral lift wider", "lifts", spiral_wider, "free"),
    ("arc of a wipe turned", "wipes", wipe_arc_wider, "free"),
    ("half of the filament back halfway", "retractions", primed_on_way, "free"),
    ("filament pulled back halfway", "retractions", pulled_late(1), "free"),
    ("half of the filament pulled back halfway", "retractions", pulled_late(0.5), "free"),
    ("retraction of a long way dropped", "open_ways", retraction_dropped_within, "free"),
    ("retraction before a layer dropped", "open_ways", retraction_to_layer_dropped, "free"),
    ("retraction without a way", "retractions", needless_retraction, "free"),
    ("all primings less by 0.003 mm", "retractions", all_off("prime", -0.003), "free"),
    ("all primings more by 0.0009 mm", "retractions", all_off("prime", 0.0009), "free"),
    ("all retractions deeper by 0.003 mm", "retractions", all_off("retract", -0.003), "free"),
    ("G10 doubled", "retractions", firmware_doubled("G10"), "free"),
    ("G11 doubled", "retractions", firmware_doubled("G11"), "free"),
    ("priming at another speed", "speeds", prime_slow, "free"),
    ("filament back 0.4 mm early", "retractions", primed_elsewhere, "free"),
    ("wipe at another speed", "speeds", wipe_slow, "free"),
    ("wipe pulls all at once", "wipes", wipe_pulls_at_once, "free"),
    ("wipe's filament pulled before it", "wipes", wipe_without_filament, "free"),
    ("wipe beside a path that had none", "wipes", wipe_of_other_path, "free"),
)
