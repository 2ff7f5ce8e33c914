"""Defects of lifts. Kinds as in defects.py."""

import re

from edits import at_its_feed, edited, pick, restated, with_f, with_word, with_xy, with_z
from places import crosses_wall, down_of, lifted, lines_of, links, long_way, way_of
from sliced import number


def lift_dropped(file, rng):
    def make(found):
        index, z = way_of(file, found)
        return edited(file, {i: [with_z(file.lines[i].text, z)] for i in index}) if (
            long_way(file, found)) else None

    return pick(rng, lifted(file), 50, make)


def lift_halved(file, rng):
    def make(found):
        index, z = way_of(file, found)
        return edited(file, {i: [with_z(file.lines[i].text, z + (file.lines[i].end[2] - z) / 2)]
                             for i in index}) if long_way(file, found) else None

    return pick(rng, lifted(file), 50, make)


def lift_late(file, rng):
    """Up where the way ends."""

    def make(found):
        index, z = way_of(file, found)
        if not long_way(file, found):
            return None
        changes = {i: [re.sub(r"\s*Z-?[0-9.]+", "", file.lines[i].text)]
                   if file.lines[i].kind == "travel" else [] for i in index}
        top = max(file.lines[i].end[2] for i in index)
        changes[index[-1]] = changes[index[-1]] + [f"G1 Z{number(top)}"]
        return edited(file, changes)

    return pick(rng, lifted(file), 50, make)


def lift_copied(file, rng):
    """The number of another layer."""

    def make(found):
        index, z = way_of(file, found)
        top = max(file.lines[i].end[2] for i in index)
        return edited(file, {i: [with_z(file.lines[i].text, top + 0.137)] for i in index}) if (
            any("Z" in file.lines[i].text and file.lines[i].kind == "travel" for i in index)) else None

    return pick(rng, lifted(file), 50, make)


def way_low(file, rng):
    """A way leads through what has been printed."""

    def make(found):
        k, pulls, ways, _ = found
        z = file.paths[k + 1].start[2]
        low = number(z - 0.12)
        if file.paths[k].start[2] != z or not long_way(file, found):
            return None
        changes = {i: [with_z(file.lines[i].text, z - 0.12)]
                   for i in range(pulls[-1] + 1, ways[-1] + 1) if file.lines[i].kind in ("z", "travel")}
        changes[ways[0]] = [f"G1 Z{low}"] + changes[ways[0]]
        changes[ways[-1]] = (changes[ways[-1]] if ways[-1] != ways[0] else changes[ways[0]]) + [
            f"G1 Z{number(z)}"]
        return edited(file, changes)

    return pick(rng, links(file), 50, make)


def lift_higher(file, rng):
    """By a height that no lift has."""

    def make(found):
        index, z = way_of(file, found)
        if not any(file.lines[i].kind == "z" for i in index):
            return None
        return edited(file, {i: [with_z(file.lines[i].text, file.lines[i].end[2] + 0.313)]
                             for i in index if file.lines[i].end[2] > z + 0.01})

    return pick(rng, lifted(file), 50, make)


def lift_invented(file, rng):
    feed = number(max((line.feed for line in file.lines if line.kind == "z"), default=600))

    def make(found):
        k, pulls, ways, _ = found
        z = file.paths[k + 1].start[2]
        index = range(pulls[-1] + 1, ways[-1] + 1)
        if any(file.lines[i].end[2] != z for i in index) or file.paths[k].start[2] != z:
            return None
        changes = {i: [file.lines[i].text] for i in ways}
        changes[ways[0]] = [f"G1 Z{number(z + 0.117)} F{feed}"] + at_its_feed(file, ways[0])
        changes[ways[-1]] = changes[ways[-1]] + [f"G1 Z{number(z)} F{feed}"] + restated(file, ways[-1])
        return edited(file, changes)

    return pick(rng, links(file), 50, make)


def lift_dropped_in_layer(file, rng):
    """In a layer whose retracted ways are all lifted, whatever the other layers do."""
    up = {}
    for k, pulls, ways, _ in links(file):
        z = file.paths[k + 1].start[2]
        if file.paths[k].start[2] != z:
            continue
        high = max(file.lines[i].end[2] for i in ways) > z + 0.05
        up.setdefault(z, []).append((high, (k, pulls, ways, z)))
    found = [way for all_ways in up.values() if len(all_ways) > 3 and all(high for high, _ in all_ways)
             for _, way in all_ways]

    def make(way):
        index, z = way_of(file, way)
        return edited(file, {i: [with_z(file.lines[i].text, z)] for i in index}) if long_way(file, way) else None

    return pick(rng, found, 50, make)


def low_to_next_layer(file, rng):
    """The head rises to the layer where the way ends, not where it begins."""

    def make(k):
        link = list(file.link(k))
        ups = [i for i in link if file.lines[i].kind == "z"]
        ways = [i for i in link if file.lines[i].kind == "travel"]
        rises = file.paths[k + 1].start[2] - file.paths[k].start[2]
        if not 0.03 < rises < 1 or len(ups) != 1 or not ways or ups[0] > ways[0]:
            return None
        if any("Z" in file.lines[i].text for i in ways) or sum(file.lines[i].length() for i in ways) < 3:
            return None
        up = with_f(file.lines[ups[0]].text, file.lines[ups[0]].feed)
        return edited(file, {ups[0]: [f"G1 F{number(file.lines[ups[0]].feed)}"],
                             ways[-1]: [file.lines[ways[-1]].text, up] + restated(file, ways[-1])})

    return pick(rng, range(len(file.paths) - 1), len(file.paths), make)


def down_before_way(file, rng):
    """Between objects printed one after the other: down first, then through what stands there."""

    def make(k):
        link = list(file.link(k))
        downs = [i for i in link if file.lines[i].kind == "z" and file.lines[i].end[2] < file.lines[i].start[2]]
        ways = [i for i in link if file.lines[i].kind == "travel"]
        falls = file.paths[k].start[2] - file.paths[k + 1].start[2]
        if falls < 0.5 or not downs or not ways or downs[-1] < ways[0]:
            return None
        return edited(file, {downs[-1]: [], ways[0]: [file.lines[downs[-1]].text, file.lines[ways[0]].text]})

    return pick(rng, range(len(file.paths) - 1), len(file.paths), make)


def sinks_over_object(file, rng):
    """Between objects printed one after the other: the way aside, before the head goes down, is gone."""

    def make(k):
        link = list(file.link(k))
        downs = [i for i in link if file.lines[i].kind == "z" and file.lines[i].end[2] < file.lines[i].start[2]]
        falls = file.paths[k].start[2] - file.paths[k + 1].start[2]
        if falls < 0.5 or not downs:
            return None
        aside = [i for i in link if file.lines[i].kind == "travel" and i < downs[-1]]
        behind = [i for i in link if file.lines[i].kind == "travel" and i > downs[-1]]
        return edited(file, {i: [] for i in aside}) if aside and behind else None

    return pick(rng, range(len(file.paths) - 1), len(file.paths), make)


def down_first_behind_script(file, rng):
    """Behind lines that nobody knows: down before the way in place of behind it."""

    def make(k):
        link = list(file.link(k))
        scripts = [i for i in link if file.lines[i].kind == "command" and file.lines[i].text.startswith(("M6", "M97"))]
        behind = [i for i in link if scripts and i > scripts[-1]]
        ways = [i for i in behind if file.lines[i].kind == "travel"]
        downs = [i for i in behind if file.lines[i].kind == "z" and file.lines[i].end[2] < file.lines[i].start[2]]
        if not ways or not downs or downs[-1] < ways[-1] or "Z" in file.lines[ways[-1]].text:
            return None
        return edited(file, {downs[-1]: [], ways[0]: [file.lines[downs[-1]].text, file.lines[ways[0]].text]})

    return pick(rng, range(len(file.paths) - 1), len(file.paths), make)


def of_all(kind, change):
    """The same change to all moves of a kind."""

    def defect(file, _):
        changes = {i: [change(line)] for i, line in enumerate(file.lines)
                   if line.kind == kind and file.paths[0].first < i < file.paths[-1].first}
        changes = {i: made for i, made in changes.items() if made != [file.lines[i].text]}
        return edited(file, changes) if len(changes) > 3 else None

    return defect


def lift_lower_by(um):
    def change(line):
        return with_word(line.text, "Z", lambda z: z - um / 1000) if line.end[2] > line.start[2] else line.text

    return change


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


def some_lift(wanted, share):
    """Of a way that is `wanted` a share of the lift is left, whatever other ways do."""

    def defect(file, rng):
        def make(found):
            k, pulls, ways, _ = found
            z = file.paths[k + 1].start[2]
            top = max(file.lines[i].end[2] for i in ways)
            if file.paths[k].start[2] != z or top < z + 0.05 or not long_way(file, found) or (
                    not wanted(file, k, ways)):
                return None
            index = range(pulls[-1] + 1, ways[-1] + 1)
            return edited(file, {i: [with_z(file.lines[i].text, z + share * (top - z))] for i in index
                                 if file.lines[i].kind in ("z", "travel")})

        return pick(rng, links(file), 150, make)

    return defect


def any_way(file, k, ways):
    del file, k, ways
    return True


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


def spiral_changed(change):
    """A spiral lift sweeps elsewhere: the other way round, or around another center."""

    def defect(file, rng):
        found = [i for i, line in enumerate(file.lines) if line.kind == "z" and re.match(r"G[23] .*I", line.text)
                 and file.paths[0].first < i < file.paths[-1].first]
        return pick(rng, found, 1, lambda i: edited(file, {i: [change(file.lines[i].text)]}))

    return defect


def other_way_round(text):
    return ("G2" if text.startswith("G3") else "G3") + text[2:]


def mirrored(text):
    return with_word(with_word(text, "I", lambda v: -v), "J", lambda v: -v)


def lifts_of_layer(higher_by):
    """All lifts of one layer lead to another height."""

    def defect(file, rng):
        layers = {}
        for found in lifted(file):
            layers.setdefault(file.paths[found[0] + 1].start[2], []).append(found)

        def make(ways):
            changes = {}
            for way in ways:
                index, z = way_of(file, way)
                changes.update({i: [with_z(file.lines[i].text, file.lines[i].end[2] + higher_by)] for i in index
                                if "Z" in file.lines[i].text and file.lines[i].end[2] > z + 0.06})
            return edited(file, changes) if changes else None

        return pick(rng, list(layers.values()), 3, make)

    return defect


def lift_again(file, rng):
    """Down, up and down again where a way ends."""

    def make(found):
        lines = file.lines
        down = [i for i in file.link(found[0]) if lines[i].kind == "z" and lines[i].end[2] < lines[i].start[2]]
        if len(down) != 1 or not re.match(r"G[01] Z", file.lines[down[0]].text):
            return None
        line = file.lines[down[0]]
        return edited(file, {down[0]: [line.text, f"G1 Z{number(line.start[2])} F{number(line.feed)}", line.text]})

    return pick(rng, lifted(file), 50, make)


def label_before_lift(file, rng):
    """A label of an object comes before the lift that stood before it, or the other way."""
    labels = r"; (?:printing|stop printing) object|M486 S|EXCLUDE_OBJECT_(?:START|END)|M62[45]"

    def make(i):
        for k in (i - 1, i + 1):
            line = file.lines[k]
            if line.kind == "z" and line.text.startswith("G1") and line.start[2] < line.end[2] and not line.e:
                first = min(i, k)
                return edited(file, {first: [file.lines[first + 1].text], first + 1: [file.lines[first].text]})
        return None

    return pick(rng, lines_of(file, labels, file.paths[0].last, file.paths[-1].first), 50, make)


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("lift dropped", "lifts", lift_dropped, "free"),
    ("lift halved", "lifts", lift_halved, "free"),
    ("lift behind the way", "lifts", lift_late, "free"),
    ("height copied from elsewhere", "lifts", lift_copied, "free"),
    ("way below the layer", "lifts", way_low, "free"),
    ("lift higher", "lifts", lift_higher, "free"),
    ("lift invented", "lifts", lift_invented, "free"),
    ("lift dropped in a layer that has them", "lifts", lift_dropped_in_layer, "free"),
    ("rises where the way to the layer ends", "lifts", low_to_next_layer, "free"),
    ("down before the way to the next object", "lifts", down_before_way, "free"),
    ("no way aside before the next object", "lifts", sinks_over_object, "free"),
    ("down before the way behind a script", "scripts", down_first_behind_script, "free"),
    ("all ways a tenth faster", "speeds", of_all("travel", lambda line: with_word(
        line.text, "F", lambda f: f * 1.1)), "free"),
    ("all lifts 0.05 mm lower", "lifts", of_all("z", lift_lower_by(50)), "free"),
    ("all retractions a tenth slower", "speeds", of_all("retract", lambda line: with_word(
        line.text, "F", lambda f: f * 0.9)), "free"),
    ("lifted again behind the way", "lifts", lift_again, "free"),
    ("lifted twice", "lifts", lift_twice, "free"),
    ("lift of any way dropped", "lifts", some_lift(any_way, 0), "free"),
    ("lift of any way halved", "lifts", some_lift(any_way, 0.5), "free"),
    ("lift across a wall dropped", "lifts", some_lift(crosses_wall, 0), "free"),
    ("down halfway", "lifts", descends_on_way, "free"),
    ("spiral lift wider", "lifts", spiral_wider, "free"),
    ("spiral lift the other way round", "lifts", spiral_changed(other_way_round), "free"),
    ("spiral lift on the other side", "lifts", spiral_changed(mirrored), "free"),
    ("lifts of a layer higher", "lifts", lifts_of_layer(0.05), "free"),
    ("lift moved across a label", "lifts", label_before_lift, "free"),
    ("lifts of a layer lower", "lifts", lifts_of_layer(-0.05), "free"),
)
