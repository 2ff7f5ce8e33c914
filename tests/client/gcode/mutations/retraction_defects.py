"""Defects of single retractions and primings. Kinds as in defects.py."""

import re

from edits import edited, go, next_deposit, pick, restated, with_e, with_word, with_xy, without_e
from places import crosses_wall, down_of, level, lifted_links, lines_of, links
from sliced import number


def retraction_dropped(file, rng):
    def make(found):
        k, pulls, ways, pushes = found
        if not crosses_wall(file, k, ways):
            return None
        changes = {i: [without_e(file.lines[i].text)] if file.lines[i].kind == "wipe" else []
                   for i in pulls}
        changes.update({i: [] for i in pushes})
        return edited(file, changes)

    return pick(rng, links(file), 150, make)


def retraction_to_other_way(file, rng):
    """Filament is pulled back for an open way of the layer instead of for its own."""
    ways = {k: pulled for k, *pulled in links(file)}

    def open_way(k):
        index = file.link(k)
        kinds = [file.lines[i].kind for i in index]
        travels = [i for i in index if file.lines[i].kind == "travel"]
        if not travels or set(kinds) & {"retract", "prime", "wipe", "z", "other"}:
            return None
        return travels if sum(file.lines[i].length() for i in travels) > 0.6 else None

    def make(k):
        pulls, own, pushes = ways[k]
        if not level(file, (k, pulls, own, pushes)) or any(file.lines[i].kind == "wipe" for i in pulls):
            return None
        if sum(file.lines[i].length() for i in own) < 0.6:
            return None
        for other in list(range(k + 1, k + 30)) + list(range(k - 30, k)):
            if not 0 <= other < len(file.paths) - 1 or other in ways:
                continue
            if {file.paths[other].section, file.paths[other + 1].section} != {file.paths[k].section}:
                continue
            travels = open_way(other)
            if travels is None:
                continue
            changes = {i: [] for i in pulls + pushes}
            changes[pulls[0]] = [f"G1 F{number(file.lines[pulls[-1]].feed)}"]
            changes[pushes[-1]] = [f"G1 F{number(file.lines[pushes[-1]].feed)}"]
            changes[travels[0]] = ([file.lines[i].text for i in pulls] +
                                   [f"G1 F{number(file.lines[travels[0]].feed)}", file.lines[travels[0]].text])
            changes.setdefault(travels[-1], [file.lines[travels[-1]].text])
            changes[travels[-1]] = (changes[travels[-1]] + [file.lines[i].text for i in pushes] +
                                    [f"G1 F{number(file.lines[travels[-1]].feed)}"])
            return edited(file, changes)
        return None

    return pick(rng, ways, 200, make)


def primed_early(file, rng):
    def make(found):
        k, pulls, ways, pushes = found
        if not crosses_wall(file, k, ways):
            return None
        pushed = [file.lines[i].text for i in pushes]
        changes = {i: [] for i in pushes}
        changes[ways[0]] = pushed + [go(file.lines[ways[0]].end, file.lines[ways[0]])] if (
            file.lines[ways[0]].start[2] == file.lines[ways[0]].end[2]) else (
            pushed + [file.lines[ways[0]].text])
        return edited(file, changes)

    return pick(rng, links(file), 150, make)


def retraction_deeper(file, rng):
    def make(found):
        _, pulls, _, pushes = found
        return edited(file, {pulls[-1]: [with_e(file.lines[pulls[-1]].text, lambda e: e - 0.8)],
                             pushes[-1]: [with_e(file.lines[pushes[-1]].text, lambda e: e + 0.8)]})

    return pick(rng, links(file), 5, make)


def retraction_halved(file, rng):
    def make(found):
        _, pulls, _, pushes = found
        half = file.lines[pulls[-1]].e / 2
        if abs(half) < 0.02:
            return None
        return edited(file, {pulls[-1]: [with_e(file.lines[pulls[-1]].text, lambda e: e - half)],
                             pushes[-1]: [with_e(file.lines[pushes[-1]].text, lambda e: e + half)]})

    return pick(rng, links(file), 50, make)


def blob(file, rng):
    amounts = [line.e for line in file.lines if line.kind == "prime" and line.e > 0.05] or [0.5]

    def make(path):
        text = f"G1 E{number(rng.choice(amounts))} F1800"
        return edited(file, {path.first: [text] + restated(file, path.first) +
                             [file.lines[path.first].text]})

    return pick(rng, file.paths, 5, make)


def last_retraction_deeper(file, rng):
    end = min(len(file.lines), file.paths[-1].last + 40)
    pulls = [i for i in range(file.paths[-1].last + 1, end) if file.lines[i].kind == "retract"]
    return pick(rng, pulls[:1], 1, lambda i: edited(
        file, {i: [with_word(file.lines[i].text, "E", lambda e: e - 0.9)]}))


def primed_above(file, rng):
    """Filament comes back while the nozzle is still lifted."""

    def make(found):
        i = down_of(file, found)
        if i is None:
            return None
        changes = {p: [] for p in found[3]}
        changes[i] = [file.lines[p].text for p in found[3]] + [file.lines[i].text]
        changes[found[3][-1]] = restated(file, found[3][-1])
        return edited(file, changes)

    return pick(rng, links(file), 50, make)


def pulled_above(file, rng):
    """The nozzle is lifted before filament is pulled back."""

    def make(found):
        _, pulls, ways, _ = found
        i = next((i for i in range(pulls[-1] + 1, ways[0]) if file.lines[i].kind == "z"), None)
        if i is None or any(file.lines[p].kind != "retract" for p in pulls):
            return None
        changes = {p: [] for p in pulls}
        changes[i] = [file.lines[i].text] + [file.lines[p].text for p in pulls]
        return edited(file, changes)

    return pick(rng, lifted_links(file), 50, make)


def retraction_in_two(file, rng):
    """Two retractions of less in sum, and as much pushed."""

    def make(found):
        _, pulls, _, pushes = found
        pull, push = file.lines[pulls[-1]], file.lines[pushes[-1]]
        if pull.kind != "retract" or pull.e > -0.1 or push.e < 0.1:
            return None
        part = with_word(pull.text, "E", lambda e: e * 0.4)
        return edited(file, {pulls[-1]: [part, part],
                             pushes[-1]: [with_word(push.text, "E", lambda e: e + 0.2 * pull.e)]})

    return pick(rng, links(file), 20, make)


def prime_dropped(file, rng):
    return pick(rng, links(file), 5, lambda found: edited(file, {i: [] for i in found[3]}))


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


def label_before_retraction(file, rng):
    """A label of an object comes before the retraction that stood before it, or the other way."""
    labels = r"; (?:printing|stop printing) object|M486 S|EXCLUDE_OBJECT_(?:START|END)|M62[45]"

    def make(i):
        for k in range(i + 1, min(i + 8, len(file.lines))):
            if file.lines[k].kind == "retract":
                return edited(file, {i: [], k: [file.lines[k].text, file.lines[i].text]})
            if file.lines[k].kind in ("deposit", "travel"):
                return None
        return None

    return pick(rng, lines_of(file, labels, file.paths[0].first), 50, make)


def all_primed_more(file, _):
    """By too little for each to be told from the pair that it was."""
    changes = {i: [with_e(line.text, lambda e: e + 0.0001)] for i, line in enumerate(file.lines)
               if line.kind == "prime" and "E" in line.text and file.paths[0].first < i < file.paths[-1].first}
    return edited(file, changes) if len(changes) > 20 else None


def retraction_in_parts(file, rng):
    """Two halves, one behind the other."""

    def make(found):
        _, pulls, _, _ = found
        line = file.lines[pulls[0]]
        if len(pulls) != 1 or line.kind != "retract" or not line.text.startswith("G1"):
            return None
        half = with_e(line.text, lambda e: e / 2)
        return edited(file, {pulls[0]: [half, half]})

    return pick(rng, links(file), 50, make)


def short_move_before_retraction_dropped(file, rng):
    """Travel retracts at the end of the path, which it left before."""

    def make(found):
        k, pulls, _, _ = found
        moves = [i for i in file.link(k) if file.lines[i].kind != "command" and file.lines[i].kind != "comment"]
        if len(moves) < 2 or moves[1] != pulls[0] or len(pulls) != 1 or file.lines[pulls[0]].kind != "retract":
            return None
        line = file.lines[moves[0]]
        if line.kind != "travel" or not 0.1 < line.length() < 0.95 or line.feed == file.lines[moves[0] - 1].feed:
            return None
        return edited(file, {moves[0]: [f"G1 F{number(line.feed)}"]})

    return pick(rng, links(file), 500, make)


def left_to_another_side(file, rng):
    """Travel leaves its path by a short move to another side before it retracts."""

    def make(found):
        k, pulls, _, _ = found
        moves = [i for i in file.link(k) if file.lines[i].kind not in ("command", "comment")]
        if len(moves) < 2 or moves[1] != pulls[0] or file.lines[pulls[0]].kind != "retract":
            return None
        line = file.lines[moves[0]]
        if line.kind != "travel" or not 0.1 < line.length() < 0.95 or line.feed == file.lines[moves[0] - 1].feed:
            return None
        (x, y), (to_x, to_y) = line.start[:2], line.end[:2]
        aside = rng.choice(((x - to_y + y, y + to_x - x), (x + to_y - y, y - to_x + x)))
        return edited(file, {moves[0]: [with_xy(line.text, aside)]})

    return pick(rng, links(file), 500, make)


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("retraction dropped across a wall", "open_travel", retraction_dropped, "free"),
    ("retraction moved to another way", "open_travel", retraction_to_other_way, "free"),
    ("filament back before a wall", "retractions", primed_early, "free"),
    ("retraction deeper by 0.8 mm", "retractions", retraction_deeper, "free"),
    ("retraction halved", "retractions", retraction_halved, "free"),
    ("blob of an amount of the file", "standstill", blob, "free"),
    ("last retraction deeper", "retractions", last_retraction_deeper, "free"),
    ("retraction in two, and less", "retractions", retraction_in_two, "free"),
    ("priming dropped", "same_print", prime_dropped, "free"),
    ("filament back above the layer", "retractions", primed_above, "free"),
    ("filament pulled back above the layer", "retractions", pulled_above, "free"),
    ("filament back a segment late", "same_print", primed_late, "free"),
    ("filament back with a segment", "same_print", primed_by_segment, "free"),
    ("filament pulled back a segment early", "same_print", pulled_early, "free"),
    ("retraction dropped, and not its priming", "standstill", only_pulled(("pull", 0)), "free"),
    ("retraction done twice", "same_print", only_pulled(("pull", 2)), "free"),
    ("priming done twice", "standstill", only_pulled(("push", 2)), "free"),
    ("all primings 0.1 um longer", "retractions", all_primed_more, "free"),
    ("retraction in two halves", "retractions", retraction_in_parts, "free"),
    ("short move before a retraction dropped", "path_ends", short_move_before_retraction_dropped, "free"),
    ("short move before a retraction to another side", "path_ends", left_to_another_side, "free"),
    ("retraction moved across a label", "retractions", label_before_retraction, "free"),
)
