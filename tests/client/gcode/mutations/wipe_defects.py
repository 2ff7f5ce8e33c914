"""Defects of wipes. Kinds as in defects.py."""

import re

from edits import edited, pick, with_e, with_f
from places import links, to_piece, wiped
from sliced import number


def wipe_dropped(file, rng):
    def make(found):
        k, wipes = found
        pulled = sum(file.lines[i].e for i in wipes)
        changes = {i: [] for i in wipes}
        changes[wipes[-1]] = [f"G1 E{number(pulled)}"]
        return edited(file, changes)

    return pick(rng, wiped(file), 5, make)


def wipe_moved(file, rng):
    def make(found):
        _, wipes = found
        changes = {}
        for i in wipes:
            line = file.lines[i]
            if "J" in line.text:
                return None
            changes[i] = [f"G1 X{number(line.end[0] + 0.7)} Y{number(line.end[1] + 0.9)} "
                          f"E{number(line.e)}"]
        return edited(file, changes)

    return pick(rng, wiped(file), 20, make)


def straight_wipe(file, wipes):
    """The line of a wipe that is one straight move of 0.5 mm or more; None for others."""
    line = file.lines[wipes[-1]]
    return line if len(wipes) == 1 and line.length() >= 0.5 and line.text.startswith("G1") else None


def wipe_halved(file, rng):
    """The wipe leads half as far along the path, all of its filament on the way."""

    def make(found):
        _, wipes = found
        line = straight_wipe(file, wipes)
        if line is None:
            return None
        middle = [(line.start[i] + line.end[i]) / 2 for i in (0, 1)]
        return edited(file, {wipes[0]: [f"G1 X{number(middle[0])} Y{number(middle[1])} E{number(line.e)}"]})

    return pick(rng, wiped(file), 50, make)


def wipe_across(file, rng):
    """The wipe of a loop takes the straight way to a point of the loop that lies far."""

    def make(found):
        k, wipes = found
        path = file.paths[k]
        if not path.closed() or len(wipes) != 1:
            return None
        line = file.lines[wipes[0]]
        middle_of = [((line.start[0] + p[0]) / 2, (line.start[1] + p[1]) / 2) for p in path.points]
        far = [p for p, middle in zip(path.points, middle_of)
               if min(to_piece(middle, a, b) for a, b in zip(path.points, path.points[1:])) > 1]
        if not far:
            return None
        return edited(file, {wipes[0]: [f"G1 X{number(far[0][0])} Y{number(far[0][1])} E{number(line.e)}"]})

    return pick(rng, wiped(file), 100, make)


def wipe_arc_wider(file, rng):
    found = [i for i, line in enumerate(file.lines) if line.kind == "wipe" and re.match(r"G[23] .*I", line.text)]
    return pick(rng, found, 1, lambda i: edited(
        file, {i: [("G3" if file.lines[i].text[1] == "2" else "G2") + file.lines[i].text[2:]]}))


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


def wipe_mark_early(file, rng):
    """The mark of a wipe stands before the last segment of its path."""

    def make(k):
        link = list(file.link(k))
        begins = [i for i in link if "WIPE_START" in file.lines[i].text]
        path = file.paths[k]
        if not begins or len(path.deposits) < 2:
            return None
        last = path.deposits[-1]
        return edited(file, {begins[0]: [], last: [file.lines[begins[0]].text, file.lines[last].text]})

    return pick(rng, range(len(file.paths) - 1), 200, make)


def wipe_there_and_back(file, rng):
    """The wipe returns to the end of its path."""

    def make(found):
        _, wipes = found
        line = straight_wipe(file, wipes)
        if line is None:
            return None
        there = with_e(line.text, lambda e: e / 2)
        back = f"G1 X{number(line.start[0])} Y{number(line.start[1])} E{number(line.e / 2)}"
        return edited(file, {wipes[0]: [there, back]})

    return pick(rng, wiped(file), 50, make)


def wipe_pulls_more(file, rng):
    """The wipe pulls half of what is pulled at a standstill around it as well."""

    def make(found):
        k, wipes = found
        still = [i for i in file.link(k) if file.lines[i].kind == "retract"]
        if not still or file.lines[still[0]].e > -0.02:
            return None
        half = file.lines[still[0]].e / 2
        return edited(file, {still[0]: [with_e(file.lines[still[0]].text, lambda e: e - half)],
                             wipes[-1]: [with_e(file.lines[wipes[-1]].text, lambda e: e + half)]})

    return pick(rng, wiped(file), 50, make)


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("wipe dropped", "wipes", wipe_dropped, "free"),
    ("wipe beside its path", "wipes", wipe_moved, "free"),
    ("wipe half as long", "wipes", wipe_halved, "free"),
    ("wipe across its loop", "wipes", wipe_across, "free"),
    ("arc of a wipe turned", "wipes", wipe_arc_wider, "free"),
    ("wipe at another speed", "speeds", wipe_slow, "free"),
    ("wipe pulls all at once", "wipes", wipe_pulls_at_once, "free"),
    ("wipe's filament pulled before it", "wipes", wipe_without_filament, "free"),
    ("mark of a wipe before its path ends", "wipes", wipe_mark_early, "free"),
    ("wipe beside a path that had none", "wipes", wipe_of_other_path, "free"),
    ("wipe there and back", "wipes", wipe_there_and_back, "free"),
    ("wipe pulls more, the rest less", "wipes", wipe_pulls_more, "free"),
)
