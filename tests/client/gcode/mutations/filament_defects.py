"""Defects of the filament on the way, and of all retractions at once. Kinds as in defects.py."""

import re

from edits import edited, pick, restated, with_e, with_f, with_xy
from places import crosses_wall, level, links
from sliced import number
from travel_defects import cut_way, open_travel


def halves(text):
    e = float(re.search(r"E(-?[0-9.]+)", text).group(1))
    return with_e(text, lambda _: e / 2), f"G1 E{number(e / 2)}"


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
    return max((sum(file.lines[i].length() for i in ways) for ways in open_travel(file)), default=0)


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


def retraction_before_tool_dropped(file, rng):
    """The tool is taken with its filament pushed to the tip."""

    def make(i):
        pull = next((k for k in range(i - 1, max(0, i - 40), -1) if file.lines[k].kind in ("retract", "deposit")), None)
        return edited(file, {pull: []}) if pull is not None and file.lines[pull].kind == "retract" else None

    tools = [i for i, line in enumerate(file.lines) if re.match(r"T\d", line.text) and i > file.paths[0].first]
    return pick(rng, tools, 20, make)


def primed_in_parts(file, rng):
    """Two halves, one behind the other."""

    def make(found):
        push = found[3][0]
        line = file.lines[push]
        if len(found[3]) != 1 or not re.match(r"G1 .*E", line.text):
            return None
        half = with_e(line.text, lambda e: e / 2)
        return edited(file, {push: [half, half]})

    return pick(rng, links(file), 50, make)


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("half of the filament back halfway", "retractions", primed_on_way, "free"),
    ("filament pulled back halfway", "retractions", pulled_late(1), "free"),
    ("half of the filament pulled back halfway", "retractions", pulled_late(0.5), "free"),
    ("retraction of a long way dropped", "open_travel", retraction_dropped_within, "free"),
    ("retraction before a layer dropped", "open_travel", retraction_to_layer_dropped, "free"),
    ("retraction without a way", "retractions", needless_retraction, "free"),
    ("all primings less by 0.003 mm", "retractions", all_off("prime", -0.003), "free"),
    ("all primings more by 0.0009 mm", "retractions", all_off("prime", 0.0009), "free"),
    ("all retractions deeper by 0.003 mm", "retractions", all_off("retract", -0.003), "free"),
    ("G10 doubled", "retractions", firmware_doubled("G10"), "free"),
    ("G11 doubled", "retractions", firmware_doubled("G11"), "free"),
    ("priming at another speed", "speeds", prime_slow, "free"),
    ("filament back 0.4 mm early", "retractions", primed_elsewhere, "free"),
    ("retraction before a tool dropped", "retractions", retraction_before_tool_dropped, "free"),
    ("priming in two halves", "retractions", primed_in_parts, "free"),
)
