"""Defects of lines that print nothing: comments, marks, line ends. Kinds as in defects.py."""

import re

from edits import edited, moved_behind, next_path, pick, with_word
from places import lines_of

SETTERS = re.compile(r"M(?:106|107|201|204|205|221|572|900)\b|SET_(?:VELOCITY_LIMIT|PRESSURE_ADVANCE)")


def without(file, rng, found):
    return pick(rng, found, 1, lambda i: edited(file, {i: []}))


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
        if not file.is_layer(line.text):
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
    notes = re.compile(r";(?!TYPE|WIDTH|HEIGHT|WIPE|LAYER|MESH|reset| ?FEATURE| LINE_W| WIPE| '|PRINTING|"
                       r"(?:shell|infill|raft)$)\S.*\S")
    found = lines_of(file, notes, file.paths[0].first, file.paths[-1].last)
    pairs = [(a, b) for a, b in zip(found, found[1:]) if file.lines[a].text != file.lines[b].text and
             b - a < 200]
    return pick(rng, pairs, 1, lambda pair: edited(file, {pair[0]: [file.lines[pair[1]].text],
                                                          pair[1]: [file.lines[pair[0]].text]}))


def comment_past_path(file, rng):
    """What a plugin of the printer may look for stands behind the path that it stood before."""
    notes = re.compile(r"; ?(?:INIT|CP |FLUSH|WIPE_TOWER|PURGE|BRIDGE|move to|BEFORE|AFTER)")
    found = lines_of(file, notes, file.paths[0].first, file.paths[-1].first)

    def make(i):
        path = next_path(file, i)
        fence = any(file.lines[k].kind == "command" and not SETTERS.match(file.lines[k].text)
                    for k in range(i, path.last))
        return None if fence else moved_behind(file, i, path.last)

    return pick(rng, found, 30, make)


def byte_order_mark(file, _):
    return "\xef\xbb\xbf" + file.text()


def second_mark(file, rng):
    """What looks like the line of this program hides a command behind a carriage return."""
    text = "; optimised by Traverse 1.0, policy safe: x\rM104 S300"
    return pick(rng, file.paths[1:], 1, lambda p: edited(file, {p.first: [text, file.lines[p.first].text]}))


def second_line(file, _):
    """Two lines of this program stand at the head."""
    text = "; optimised by Traverse 1.0, policy safe: x"
    return f"{text}\n{text}\n{file.text()}"


def word_of_an_arc(kind):
    """A straight move has a word that makes it another move to some machines."""

    def defect(file, rng):
        found = [i for i, line in enumerate(file.lines) if line.kind == kind and re.match(r"G[01] ", line.text)]
        return pick(rng, found, 1, lambda i: edited(file, {
            i: [re.sub(r"^G[01]", lambda g: f"{g.group()} {rng.choice(('R2', 'J1', 'P1'))}", file.lines[i].text)]}))

    return defect


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


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("acceleration set before a line that is not known", "same_print", before_macro("M204 S123"), "free"),
    ("flow set before a line that is not known", "same_print", before_macro("M221 S93"), "free"),
    ("advance off by a tenth", "same_print", value_slightly_off(r"M900\b", "K", 1.1), "free"),
    ("jerk off by a tenth", "same_print", value_slightly_off(r"M205\b", "X", 1.1), "free"),
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
    ("comment behind its path", "same_print", comment_past_path, "free"),
    ("mark of UTF-8 inserted", "same_print", byte_order_mark, "free"),
    ("command behind a carriage return", "same_print", second_mark, "free"),
    ("second line of this program", "same_print", second_line, "free"),
    ("word of an arc on a travel move", "same_print", word_of_an_arc("travel"), "free"),
    ("word of an arc on a straight segment", "same_print", word_of_an_arc("deposit"), "free"),
    ("command behind a comment on a move", "same_print", hidden_command, "free"),
    ("line end changed", "same_print", line_end_changed, "free"),
    ("zero byte", "same_print", zero_byte, "free"),
)
