"""Defects of what is deposited: filament, points, arcs, speed, height. Kinds as in defects.py."""

import re

from edits import body, edited, go, pick, restated, with_f, with_word, without_path
from places import links
from sliced import number


def drop_segment(file, rng):
    """Where the next line is the same it says nothing but some nanometres of filament."""

    def make(path):
        i = rng.choice(path.deposits)
        return None if file.lines[i].text == file.lines[i + 1].text else edited(file, {i: []})

    return pick(rng, file.paths, 5, make)


def cut_path(file, rng):
    """The second half first, the first half behind it."""

    def make(path):
        if not path.plain or len(path.deposits) < 4 or path.closed():
            return None
        k = len(path.deposits) // 2
        lines = body(file, path)
        begin = file.lines[path.first]
        new = ([go(path.points[k], begin)] + restated(file, path.first + k) + lines[k:] +
               [go(path.start, begin)] + restated(file, path.first) + lines[:k] +
               [go(path.end, begin)] + restated(file, path.last))
        changes = {i: [] for i in range(path.first, path.last + 1)}
        changes[path.first] = new
        return edited(file, changes)

    return pick(rng, file.paths, 200, make)


def layer_higher(file, rng):
    """A layer's moves of Z lead 0.05 mm higher."""

    def make(k):
        z = file.paths[k].start[2]
        changes = {}
        for i in range(file.paths[k].first, 0, -1):
            line = file.lines[i]
            if line.kind == "z" and abs(line.end[2] - z) < 1e-6:
                text = re.sub(r"Z\s*-?[0-9.]+", "Z" + number(z + 0.05), line.text)
                changes[i] = [text]
                break
        return edited(file, changes) if changes else None

    return pick(rng, range(len(file.paths)), 20, make)


def arc_turned(file, rng):
    arcs = [i for path in file.paths for i in path.deposits if re.match(r"G[23]\b", file.lines[i].text)]

    def make(i):
        text = file.lines[i].text
        return edited(file, {i: [("G3" if text[1] == "2" else "G2") + text[2:]]})

    return pick(rng, arcs, 1, make)


def extrusion_doubled(file, rng):
    def make(path):
        i = rng.choice(path.deposits)
        line = file.lines[i]
        if line.e < 0.001 or not re.search(r"E\s*[-+]?[0-9.]+", line.text):
            return None
        return edited(file, {i: [re.sub(r"E\s*[-+]?[0-9.]+", "E" + number(2 * line.e), line.text)]})

    return pick(rng, file.paths, 20, make)


def deposit_faster(file, rng):
    """A path is begun at another feed rate."""

    def make(path):
        line = file.lines[path.first]
        text = re.sub(r"\s*F[0-9.]+", "", line.text.split(";")[0].rstrip())
        return edited(file, {path.first: [f"{text} F{number(line.feed * 1.25)}"]})

    return pick(rng, file.paths, 1, make)


def of_deposit(make):
    """A defect of one deposit that has X, Y and E."""

    def defect(file, rng):
        def of_path(path):
            i = rng.choice(path.deposits)
            text = make(file, file.lines[i])
            return None if text is None or text == [file.lines[i].text] else edited(file, {i: text})

        return pick(rng, file.paths, 50, of_path)

    return defect


@of_deposit
def one_percent_more(file, line):
    return [with_word(line.text, "E", lambda e: e * 1.01)] if line.e > 0.01 else None


@of_deposit
def point_off(file, line):
    return [with_word(line.text, "X", lambda x: x + 0.03)]


@of_deposit
def two_passes(file, line):
    if line.text[:2] != "G1" or line.e < 0.01:
        return None
    half = with_word(line.text, "E", lambda _: line.e / 2)
    return [half, go(line.start, line), f"G1 F{number(line.feed)}", half]


def arcs_of(file):
    return [i for path in file.paths for i in path.deposits
            if re.match(r"G[23]\b.* I", file.lines[i].text)]


def center_off(file, rng):
    return pick(rng, arcs_of(file), 1,
                lambda i: edited(file, {i: [with_word(file.lines[i].text, "I", lambda v: v + 0.02)]}))


def arc_to_chord(file, rng):
    return pick(rng, arcs_of(file), 1, lambda i: edited(
        file, {i: [re.sub(r"\s*[IJ]-?[0-9.]+", "", "G1" + file.lines[i].text[2:])]}))


def flow_exchanged(file, rng):
    def make(path):
        for a, b in zip(path.deposits, path.deposits[1:]):
            one, other = file.lines[a], file.lines[b]
            if abs(one.e - other.e) > 0.001 and "E" in one.text and "E" in other.text:
                return edited(file, {a: [with_word(one.text, "E", lambda _: other.e)],
                                     b: [with_word(other.text, "E", lambda _: one.e)]})
        return None

    return pick(rng, file.paths, 50, make)


def path_doubled(file, rng):
    def make(path):
        again = [go(path.start, file.lines[path.first])] + restated(file, path.first) + body(file, path)
        return edited(file, {path.last: [file.lines[path.last].text] + again}) if path.plain else None

    return pick(rng, file.paths, 20, make)


def travel_dribbles(file, rng):
    def make(found):
        i = found[2][-1]
        return edited(file, {i: [file.lines[i].text.split(";")[0].rstrip() + " E0.02"]})

    return pick(rng, links(file), 5, make)


def path_dropped(file, rng):
    """The head goes on from where the path ends."""
    return pick(rng, file.paths, 5, lambda p: edited(file, without_path(p, [go(p.end, file.lines[p.first])])))


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


def other_command(file, rng):
    """G1 that prints becomes G0."""
    found = [i for p in file.paths for i in p.deposits if file.lines[i].text.startswith("G1 ")]
    return pick(rng, found, 1, lambda i: edited(file, {i: ["G0" + file.lines[i].text[2:]]}))


def turns_of_arc(file, rng):
    found = [i for p in file.paths for i in p.deposits if re.match(r"G[23] ", file.lines[i].text)]
    return pick(rng, found, 1, lambda i: edited(
        file, {i: [file.lines[i].text.split(";")[0].rstrip() + " P2"]}))


@of_deposit
def point_slightly_off(file, line):
    return [with_word(line.text, "Y", lambda y: y + 0.002)]


def filament_to_next(file, rng):
    """A little of what a segment pushes is pushed by the next one."""

    def make(path):
        for a, b in zip(path.deposits, path.deposits[1:]):
            one, other = file.lines[a], file.lines[b]
            if one.e > 0.02 and re.search("E[-0-9.]", one.text) and re.search("E[-0-9.]", other.text):
                return edited(file, {a: [with_word(one.text, "E", lambda e: e - 0.002)],
                                     b: [with_word(other.text, "E", lambda e: e + 0.002)]})
        return None

    return pick(rng, file.paths, 50, make)


def feed_late(file, rng):
    """The feed rate of a segment comes with the next one."""

    def make(path):
        for a, b in zip(path.deposits, path.deposits[1:]):
            one, other = file.lines[a].text, file.lines[b].text
            word = re.search(r" ?F[0-9.]+", one)
            if word and " F" not in other and file.lines[a].feed != file.lines[a - 1].feed:
                return edited(file, {a: [one.replace(word.group(), "")], b: [with_f(other, file.lines[a].feed)]})
        return None

    return pick(rng, file.paths, 200, make)


@of_deposit
def word_twice(file, line):
    """Printers take the first or the last of two words."""
    return [f"{line.text} E0"] if line.e > 0.01 and ";" not in line.text and " E" in line.text else None


@of_deposit
def line_left_out(file, line):
    """Printers may skip lines that begin with a slash."""
    return ["/" + line.text] if line.e > 0.01 else None


def path_a_layer_late(file, rng):
    """A path is printed behind the first one of the next layer, at its own height."""

    def make(k):
        path = file.paths[k]
        later = next((p for p in file.paths[k:] if p.start[2] > path.start[2]), None)
        if later is None or not path.plain or not later.plain:
            return None
        changes = without_path(path, [go(path.end, file.lines[path.first])])
        changes[later.last] = ([file.lines[later.last].text, f"G1 Z{number(path.start[2])}",
                                go(path.start, file.lines[path.first])] + restated(file, path.first) +
                               body(file, path) + [f"G1 Z{number(later.start[2])}"])
        return edited(file, changes)

    return pick(rng, range(len(file.paths) - 1), 20, make)


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("segment dropped", "same_print", drop_segment, "free"),
    ("path cut and printed apart", "whole_paths", cut_path, "free"),
    ("layer higher", "same_print", layer_higher, "free"),
    ("arc turned", "same_print", arc_turned, "free"),
    ("extrusion doubled", "same_print", extrusion_doubled, "free"),
    ("path at another speed", "same_print", deposit_faster, "free"),
    ("1 % more filament in a segment", "same_print", one_percent_more, "free"),
    ("a point off by 0.03 mm", "same_print", point_off, "free"),
    ("segment in two passes of half the flow", "same_print", two_passes, "free"),
    ("center of an arc off by 0.02 mm", "same_print", center_off, "free"),
    ("arc made a chord", "same_print", arc_to_chord, "free"),
    ("flow of two segments exchanged", "same_print", flow_exchanged, "free"),
    ("path printed twice", "same_print", path_doubled, "free"),
    ("filament on a travel", "same_print", travel_dribbles, "free"),
    ("path dropped", "same_print", path_dropped, "free"),
    ("path with 2 % less filament", "same_print", of_whole_path("E", 0.98), "free"),
    ("path at a feed rate 1 % higher", "same_print", path_faster, "free"),
    ("path 0.2 mm higher", "same_print", path_at_height(0.2), "free"),
    ("path 0.1 mm lower", "same_print", path_at_height(-0.1), "free"),
    ("segment in two parts", "same_print", segment_in_two, "free"),
    ("two segments made one", "same_print", segments_in_one, "free"),
    ("two lines of a path exchanged", "same_print", lines_exchanged, "free"),
    ("G1 made G0", "same_print", other_command, "free"),
    ("turns of an arc", "same_print", turns_of_arc, "free"),
    ("path 0.01 mm lower", "same_print", path_at_height(-0.01), "free"),
    ("a point off by 0.002 mm", "same_print", point_slightly_off, "free"),
    ("0.002 mm of filament a segment late", "same_print", filament_to_next, "free"),
    ("feed rate of a segment late", "same_print", feed_late, "free"),
    ("filament stated twice", "same_print", word_twice, "free"),
    ("segment behind a slash", "same_print", line_left_out, "free"),
    ("path a layer late", "same_print", path_a_layer_late, "free"),
)
