"""Defects of lines that print nothing: settings, comments, marks, line ends. Kinds as in defects.py."""

import re

from defects import distance, edited, is_outer, pick, swap
from further_defects import moved_behind, next_path, start_script_end, with_word

SETTERS = re.compile(r"M(?:106|107|201|204|205|221|572|900)\b|SET_(?:VELOCITY_LIMIT|PRESSURE_ADVANCE)")


def lines_of(file, pattern, first=0, end=None):
    found = re.compile(pattern) if isinstance(pattern, str) else pattern
    return [i for i in range(first, len(file.lines) if end is None else end)
            if found.match(file.lines[i].text)]


def without(file, rng, found):
    return pick(rng, found, 1, lambda i: edited(file, {i: []}))


# --- settings --------------------------------------------------------------------------------------


def start_setting_dropped(file, rng):
    """In the start script, where nothing is printed under it."""
    return without(file, rng, lines_of(file, SETTERS, 0, start_script_end(file)))


def end_setting_dropped(file, rng):
    return without(file, rng, lines_of(file, SETTERS, file.paths[-1].last + 1))


def into_end_script(text):
    def defect(file, rng):
        found = lines_of(file, r"M104 S0|M104 T\d S0|M84|M140 S0|M18\b", file.paths[-1].last + 1)
        if text.startswith("G1"):
            # A move that says no feed rate follows.
            behind = [i for i in range(found[0] if found else len(file.lines), len(file.lines))
                      if re.match(r"G[01] ", file.lines[i].text)]
            found = [i for i in behind[:1] if "F" not in file.lines[i].text]
        return pick(rng, found[:1], 1, lambda i: edited(file, {i: [text, file.lines[i].text]}))

    return defect


def before_macro(text):
    """Another setting is in force where a line comes that nothing is known of."""

    def defect(file, rng):
        found = lines_of(file, r"M400\b|M600\b|G4 [PS]\d*[1-9]|M1002\b|M622\b|T\d\s*$|G29|M0\b|M1\b|G28",
                         file.paths[0].first)
        return pick(rng, found, 1, lambda i: edited(file, {i: [text, file.lines[i].text]}))

    return defect


def value_slightly_off(pattern, letter, factor):
    def defect(file, rng):
        found = [i for i in lines_of(file, pattern) if re.search(letter + r"[1-9]", file.lines[i].text)]
        return pick(rng, found, 1, lambda i: edited(
            file, {i: [with_word(file.lines[i].text, letter, lambda v: v * factor)]}))

    return defect


def across_fan(file, rng):
    """Two paths far from each other change places though the fan changes between them."""

    def fan(path):
        return {key: text for key, text in file.lines[path.first].state.items() if key.startswith("M106")}

    def make(k):
        for other in range(k + 1, min(k + 30, len(file.paths))):
            one, two = file.paths[k], file.paths[other]
            if one.section != two.section or one.start[2] != two.start[2]:
                return None
            if one.plain and two.plain and fan(one) and fan(two) and fan(one) != fan(two) and (
                    distance(one, two, 1.0) > 1.0):
                return swap(file, k, other)
        return None

    return pick(rng, range(len(file.paths)), 400, make)


# --- comments --------------------------------------------------------------------------------------


def neighbours_exchanged(file, rng, found):
    pairs = [i for i in found if file.lines[i + 1].text != file.lines[i].text and i + 1 in set(found)]
    return pick(rng, pairs, 1, lambda i: edited(file, {i: [file.lines[i + 1].text],
                                                       i + 1: [file.lines[i].text]}))


def thumbnail_lines_exchanged(file, rng):
    begin = lines_of(file, r"; thumbnail\w* begin")
    if not begin:
        return None
    end = lines_of(file, r"; thumbnail\w* end", begin[0])[0]
    return neighbours_exchanged(file, rng, list(range(begin[0] + 1, end)))


def settings_lines_exchanged(file, rng):
    return neighbours_exchanged(file, rng, lines_of(file, r"; \w+ = |;SETTING_3 "))


def in_thumbnail(text):
    def defect(file, rng):
        begin = lines_of(file, r"; thumbnail\w* begin")
        if not begin:
            return None
        end = lines_of(file, r"; thumbnail\w* end", begin[0])[0]
        i = rng.randrange(begin[0] + 1, end)
        return edited(file, {i: [text, file.lines[i].text]})

    return defect


def header_notes(file):
    """Comments that stand directly behind the mark of a layer, and say something of it."""
    found = []
    for i, line in enumerate(file.lines):
        if not file._is_layer(line.text):
            continue
        k = i + 1
        while k < len(file.lines) and file.lines[k].text.startswith(";"):
            if re.match(r"; ?(?:Z|HEIGHT|Z_HEIGHT|LAYER_HEIGHT): ?[0-9.]", file.lines[k].text):
                found.append(k)
            k += 1
    return [i for i in found if file.paths[0].first < i < file.paths[-1].first]


def layer_note_late(file, rng):
    """What says how high a layer is comes behind its first path."""
    notes = [i for i in header_notes(file) if re.match(r"; ?(?:Z|Z_HEIGHT):", file.lines[i].text)]

    def make(i):
        path = next_path(file, i)
        return moved_behind(file, i, path.last) if path else None

    return pick(rng, notes, 5, make)


def layer_height_dropped(file, rng):
    return without(file, rng, [i for i in header_notes(file) if "HEIGHT:" in file.lines[i].text and
                               "Z_HEIGHT" not in file.lines[i].text])


def mark_dropped(pattern):
    return lambda file, rng: without(file, rng, lines_of(file, pattern, file.paths[0].first,
                                                         file.paths[-1].last))


def mark_inserted(text):
    """A mark where there is none, in front of a path."""
    return lambda file, rng: pick(rng, file.paths[1:], 1, lambda p: edited(
        file, {p.first: [text, file.lines[p.first].text]}))


def move_comment_dropped(file, rng):
    found = [i for p in file.paths for i in p.deposits if ";" in file.lines[i].text]
    return pick(rng, found, 1, lambda i: edited(
        file, {i: [file.lines[i].text.split(";")[0].rstrip()]}))


def move_comment_renamed(file, rng):
    found = [i for p in file.paths for i in p.deposits if ";" in file.lines[i].text]
    return pick(rng, found, 1, lambda i: edited(
        file, {i: [file.lines[i].text.split(";")[0] + "; bridge"]}))


def comments_exchanged(file, rng):
    """Two comments of one layer that are about no path."""
    notes = re.compile(r";(?!TYPE|WIDTH|HEIGHT|WIPE|LAYER|MESH|reset| ?FEATURE| LINE_W| WIPE| '|PRINTING)\S.*\S")
    found = lines_of(file, notes, file.paths[0].first, file.paths[-1].last)
    pairs = [(a, b) for a, b in zip(found, found[1:]) if file.lines[a].text != file.lines[b].text and
             b - a < 200]
    return pick(rng, pairs, 1, lambda pair: edited(file, {pair[0]: [file.lines[pair[1]].text],
                                                          pair[1]: [file.lines[pair[0]].text]}))


# --- lines -----------------------------------------------------------------------------------------


def byte_order_mark(file, _):
    return "\xef\xbb\xbf" + file.text()


def second_mark(file, rng):
    """What looks like the line of this program hides a command behind a carriage return."""
    text = "; optimised by Traverse 1.0, policy safe: x\rM104 S300"
    return pick(rng, file.paths[1:], 1, lambda p: edited(file, {p.first: [text, file.lines[p.first].text]}))


def hidden_command(file, rng):
    """Behind a comment on a move, and a carriage return, there is a command."""

    def make(path):
        text = file.lines[path.first].text.split(";")[0].rstrip()
        return edited(file, {path.first: [text + " ; x\rM106 S13"]})

    return pick(rng, file.paths[1:], 1, make)


def line_end_changed(file, rng):
    """One line ends with CR LF though none else does."""
    i = rng.choice(file.paths).first
    return edited(file, {i: [file.lines[i].text + "\r"]})


def zero_byte(file, rng):
    i = rng.choice(file.paths).first
    return edited(file, {i: [file.lines[i].text + " ;\0"]})


def other_command(file, rng):
    """G1 that prints becomes G0."""
    found = [i for p in file.paths for i in p.deposits if file.lines[i].text.startswith("G1 ")]
    return pick(rng, found, 1, lambda i: edited(file, {i: ["G0" + file.lines[i].text[2:]]}))


def turns_of_arc(file, rng):
    found = [i for p in file.paths for i in p.deposits if re.match(r"G[23] ", file.lines[i].text)]
    return pick(rng, found, 1, lambda i: edited(
        file, {i: [file.lines[i].text.split(";")[0].rstrip() + " P2"]}))


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


def fan_of_part_late(file, rng):
    """A fan other than that of the part changes a path late."""

    def make(i):
        path = next_path(file, i)
        return moved_behind(file, i, path.last) if path else None

    return pick(rng, lines_of(file, r"M106 P[1-9]", file.paths[0].first), 20, make)


def wall_of_other_loop(file, rng):
    """Two outer walls that touch change places."""

    def make(k):
        one = file.paths[k]
        for other in range(k + 1, min(k + 25, len(file.paths))):
            two = file.paths[other]
            if two.section != one.section or two.start[2] != one.start[2]:
                return None
            if one.plain and two.plain and is_outer(two) and distance(one, two, 0.45) <= 0.45:
                return swap(file, k, other)
        return None

    return pick(rng, [k for k, p in enumerate(file.paths) if is_outer(p)], 100, make)


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("setting of the start script dropped", "same_print", start_setting_dropped, "free"),
    ("setting of the end script dropped", "same_print", end_setting_dropped, "free"),
    ("acceleration set in the end script", "same_print", into_end_script("M204 S123"), "free"),
    ("fan set in the end script", "same_print", into_end_script("M106 S33"), "free"),
    ("feed rate set in the end script", "same_print", into_end_script("G1 F123"), "free"),
    ("acceleration set before a line that is not known", "same_print", before_macro("M204 S123"), "free"),
    ("flow set before a line that is not known", "same_print", before_macro("M221 S93"), "free"),
    ("advance off by a tenth", "same_print", value_slightly_off(r"M900\b", "K", 1.1), "free"),
    ("jerk off by a tenth", "same_print", value_slightly_off(r"M205\b", "X", 1.1), "free"),
    ("paths exchanged across a change of the fan", "order", across_fan, "balanced"),
    ("lines of a thumbnail exchanged", "same_print", thumbnail_lines_exchanged, "free"),
    ("line of settings exchanged", "same_print", settings_lines_exchanged, "free"),
    ("comment in a thumbnail", "same_print", in_thumbnail("; x"), "free"),
    ("line of this program in a thumbnail", "same_print", in_thumbnail("; optimised by Traverse 1.0, policy free: x"),
     "free"),
    ("height of the layer behind its first path", "same_print", layer_note_late, "free"),
    ("height of the layer dropped", "same_print", layer_height_dropped, "free"),
    ("mark of a wipe's begin dropped", "wipes", mark_dropped(r"; ?WIPE_START"), "free"),
    ("mark of a wipe's end dropped", "wipes", mark_dropped(r"; ?WIPE_END"), "free"),
    ("mark of a wipe without one", "wipes", mark_inserted(";WIPE_START"), "free"),
    ("comment on a move dropped", "same_print", move_comment_dropped, "free"),
    ("comment on a move renamed", "same_print", move_comment_renamed, "free"),
    ("comments exchanged", "same_print", comments_exchanged, "free"),
    ("mark of UTF-8 inserted", "same_print", byte_order_mark, "free"),
    ("command behind a carriage return", "same_print", second_mark, "free"),
    ("command behind a comment on a move", "same_print", hidden_command, "free"),
    ("line end changed", "same_print", line_end_changed, "free"),
    ("zero byte", "same_print", zero_byte, "free"),
    ("G1 made G0", "same_print", other_command, "free"),
    ("turns of an arc", "same_print", turns_of_arc, "free"),
    ("retraction moved across a label", "retractions", label_before_retraction, "free"),
    ("fan of another part a path late", "same_print", fan_of_part_late, "free"),
    ("walls of two outlines exchanged", "order", wall_of_other_loop, "balanced"),
)
