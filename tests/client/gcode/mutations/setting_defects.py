"""Defects of settings, tools, labels and notes that come at another place. Kinds as in defects.py."""

import re

from edits import changed_number, edited, moved_behind, next_path, pick
from places import lines_of, with_effect


def command_in_path(file, rng):
    def make(path):
        if len(path.deposits) < 3:
            return None
        i = path.deposits[1]
        now = file.lines[i].state.get("M204", "M204 S500")
        return edited(file, {i: [now, file.lines[i].text]}) if path.plain else None

    return pick(rng, [p for p in file.paths if "M204" in file.lines[p.first].state], 50, make)


def set_and_back(file, rng):
    def make(path):
        now = file.lines[path.first].state.get("M204")
        if now is None:
            return None
        other = re.sub(r"([SPT])[0-9.]+", r"\g<1>333", now)
        return edited(file, {path.first: [other, now, file.lines[path.first].text]})

    return pick(rng, file.paths, 50, make)


def progress_back(file, rng):
    marks = [i for i, line in enumerate(file.lines) if line.text.startswith("M73")]

    def make(k):
        one, other = marks[k], marks[k + 1]
        if file.lines[one].text == file.lines[other].text:
            return None
        return edited(file, {one: [file.lines[other].text], other: [file.lines[one].text]})

    return pick(rng, range(len(marks) - 1), 50, make)


def temperature_changed(file, rng):
    return changed_number(file, rng, r"M(?:104|109|140|190) .*?S(\d+)")


def acceleration_lost(file, rng):
    return pick(rng, with_effect(file, r"M204\b"), 1, lambda i: edited(file, {i: []}))


def fan_late(file, rng):
    """The fan changes one deposit later."""

    def make(i):
        fans = r"M10[67]\b"
        behind = next((k for k in range(i + 1, len(file.lines)) if file.lines[k].kind == "deposit"), None)
        if behind is None or any(re.match(fans, file.lines[k].text) for k in range(i + 1, behind)):
            return None
        return edited(file, {i: [], behind: [file.lines[behind].text, file.lines[i].text]})

    return pick(rng, with_effect(file, r"M10[67]\b(?! P)"), 20, make)


def exchanged(file, rng, pattern):
    """Two lines that match, and differ, one behind the other, are exchanged."""
    found = [i for i, line in enumerate(file.lines) if re.match(pattern, line.text)]
    pairs = [(a, b) for a, b in zip(found, found[1:]) if file.lines[a].text != file.lines[b].text and any(
        file.lines[k].kind == "deposit" for k in range(a, b))]
    return pick(rng, pairs, 1, lambda pair: edited(file, {pair[0]: [file.lines[pair[1]].text],
                                                          pair[1]: [file.lines[pair[0]].text]}))


def labels_exchanged(file, rng):
    return exchanged(file, rng, r"; printing object|M486 S\d|EXCLUDE_OBJECT_START|M624 |;MESH:(?!NON)|;PRINTING:")


def tools_exchanged(file, rng):
    return exchanged(file, rng, r"T\d+$")


def feature_renamed(file, rng):
    return exchanged(file, rng, r"; ?(?:TYPE|FEATURE):")


def comment_dropped(file, rng):
    """A comment that is not about the next path, its wipe or its size, nor ours; some printer may read it."""
    of_paths = re.compile(r";\s*(?:optimised by Traverse|TYPE|FEATURE|(?:LINE_)?WIDTH|(?:LAYER_)?HEIGHT|WIPE_\w+|reset$|tool "
                          r"|\'|[a-z ]+$)")
    notes = [i for i, line in enumerate(file.lines)
             if line.kind == "comment" and line.text[1:].strip() and not of_paths.match(line.text)]
    return pick(rng, notes, 1, lambda i: edited(file, {i: []}))


def dwell_dropped(file, rng):
    dwells = [i for i, line in enumerate(file.lines) if re.match(r"G4 [PS]\d*[1-9]", line.text)]
    return pick(rng, dwells, 1, lambda i: edited(file, {i: []}))


def behind_next_path(pattern):
    """A line that matches, and sets something else than before, comes behind the path it was before."""

    def defect(file, rng):
        def make(i):
            path = next_path(file, i)
            if path is None or any(re.match(pattern, line.text) for line in file.lines[i + 1:path.last + 1]):
                return None
            return moved_behind(file, i, path.last)

        return pick(rng, with_effect(file, pattern), 20, make)

    return defect


def dropped(pattern):
    def defect(file, rng):
        found = [i for i, line in enumerate(file.lines) if re.match(pattern, line.text)]
        return pick(rng, found, 1, lambda i: edited(file, {i: []}))

    return defect


def inserted(text):
    """A line comes in between two paths."""

    def defect(file, rng):
        return pick(rng, file.paths[1:], 1, lambda path: edited(
            file, {path.first: [text] + [file.lines[path.first].text]}))

    return defect


def replaced(pattern, by):
    def defect(file, rng):
        found = [i for i, line in enumerate(file.lines) if re.match(pattern, line.text)]
        return pick(rng, found, 1, lambda i: edited(file, {i: [re.sub(pattern, by, file.lines[i].text)]}))

    return defect


def doubled(pattern):
    def defect(file, rng):
        found = [i for i, line in enumerate(file.lines) if re.match(pattern, line.text)]
        return pick(rng, found, 1, lambda i: edited(file, {i: [file.lines[i].text] * 2}))

    return defect


def tool_early(file, rng):
    """A tool is taken before the last path of the one before."""

    def make(i):
        before = [path for path in file.paths if path.last < i]
        return edited(file, {before[-1].first: [file.lines[i].text, file.lines[before[-1].first].text],
                             i: []}) if before else None

    return pick(rng, with_effect(file, r"T\d+\s*(?:;.*)?$"), 5, make)


def label_late(file, rng):
    """The label of an object comes a path later."""
    labels = r"; printing object|M486 S\d|EXCLUDE_OBJECT_START|M624 |;MESH:(?!NON)|;PRINTING:"

    def make(i):
        path = next_path(file, i)
        return moved_behind(file, i, path.last) if path else None

    return pick(rng, [i for i, line in enumerate(file.lines) if re.match(labels, line.text)], 5, make)


def note_moved(file, rng):
    """A comment comes some layers later."""
    notes = [i for i, line in enumerate(file.lines) if re.match(r";Z:|;HEIGHT:", line.text)]

    def make(i):
        later = next((path for path in file.paths
                      if path.first > i and path.start[2] > file.lines[i].start[2] + 0.5), None)
        return moved_behind(file, i, later.last) if later else None

    return pick(rng, notes, 10, make)


def fan_of_part_late(file, rng):
    """A fan other than that of the part changes a path late."""

    def make(i):
        path = next_path(file, i)
        return moved_behind(file, i, path.last) if path else None

    return pick(rng, lines_of(file, r"M106 P[1-9]", file.paths[0].first), 20, make)


def fans_exchanged(file, rng):
    return exchanged(file, rng, r"M106 S")


def temperatures_exchanged(file, rng):
    return exchanged(file, rng, r"M104 S|M109 S")


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("command within a path", "commands", command_in_path, "free"),
    ("acceleration set and set back", "commands", set_and_back, "free"),
    ("M73 exchanged", "progress", progress_back, "free"),
    ("temperature changed", "same_print", temperature_changed, "free"),
    ("acceleration lost", "same_print", acceleration_lost, "free"),
    ("fan late by a segment", "same_print", fan_late, "free"),
    ("labels of objects exchanged", "same_print", labels_exchanged, "free"),
    ("tools exchanged", "same_print", tools_exchanged, "free"),
    ("feature renamed", "same_print", feature_renamed, "free"),
    ("comment dropped", "same_print", comment_dropped, "free"),
    ("dwell dropped", "same_print", dwell_dropped, "free"),
    ("fan a path late", "same_print", behind_next_path(r"M10[67]\b(?! P)"), "free"),
    ("advance a path late", "same_print", behind_next_path(r"M900\b|M572\b|SET_PRESSURE_ADVANCE"), "free"),
    ("jerk a path late", "same_print", behind_next_path(r"M205\b|SET_VELOCITY_LIMIT"), "free"),
    ("acceleration a path late", "same_print", behind_next_path(r"M204\b|M201\b"), "free"),
    ("M73 doubled", "progress", doubled(r"M73\b"), "free"),
    ("tool taken a path early", "same_print", tool_early, "free"),
    ("label of an object a path late", "same_print", label_late, "free"),
    ("note in another layer", "same_print", note_moved, "free"),
    ("no waiting for the nozzle", "same_print", replaced(r"M109\b", "M104"), "free"),
    ("no waiting for the bed", "same_print", replaced(r"M190\b", "M140"), "free"),
    ("homing dropped", "same_print", dropped(r"G28\b"), "free"),
    ("mode of the extruder dropped", "same_print", dropped(r"M83\b"), "free"),
    ("pause dropped", "same_print", dropped(r"(?i)M600\b|M601\b|M25\b|M0\b|@pause|PAUSE|;PAUSE_PRINT"), "free"),
    ("fan set between two paths", "same_print", inserted("M106 S77"), "free"),
    ("flow set between two paths", "same_print", inserted("M221 S93"), "free"),
    ("speed set between two paths", "same_print", inserted("M220 S80"), "free"),
    ("dwell between two paths", "same_print", inserted("G4 P500"), "free"),
    ("fan of another part a path late", "same_print", fan_of_part_late, "free"),
    ("fan of two places exchanged", "same_print", fans_exchanged, "free"),
    ("temperatures of two places exchanged", "same_print", temperatures_exchanged, "free"),
)
