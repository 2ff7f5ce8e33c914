"""Defects of the start and the end script, and of moves that go on along a path. Kinds as in defects.py."""

import math
import re

from edits import edited, pick, restated, with_f, with_xy
from places import lines_of
from sliced import number
from text_defects import SETTERS, without


def from_script(file, rng):
    """A move of the start script between two paths."""
    first = file.paths[0].first
    moved = [line.text for line in file.lines[:first]
             if line.kind in ("prime", "retract", "deposit") and abs(line.e) > 0.01]
    if not moved:
        return None
    text = re.sub(r"\s*[XYZ]-?[0-9.]+", "", rng.choice(moved))

    def make(path):
        return edited(file, {path.first: [text] + restated(file, path.first) +
                             [file.lines[path.first].text]})

    return pick(rng, file.paths[1:], 5, make)


def tails(file):
    for path in file.paths:
        after = file.lines[path.last + 1] if path.last + 1 < len(file.lines) else None
        if after is None or after.kind != "travel" or after.feed > file.lines[path.last].feed:
            continue
        if 0.02 < after.length() < 1 and after.start[2] == after.end[2]:
            a, b = file.lines[path.last].start, file.lines[path.last].end
            dot = sum((b[i] - a[i]) * (after.end[i] - b[i]) for i in (0, 1))
            if dot > 0.999 * math.dist(a, b) * after.length():
                yield path.last + 1, a, b


def tail_dropped(file, rng):
    return pick(rng, tails(file), 5, lambda found: edited(file, {found[0]: []}))


def tail_longer(file, rng):
    def make(found):
        i, a, b = found
        line = file.lines[i]
        far = [b[k] + (line.end[k] - b[k]) * 3 for k in (0, 1)]
        return edited(file, {i: [with_xy(line.text, far)]})

    return pick(rng, tails(file), 5, make)


def tail_slow(file, rng):
    """At half its speed, or so: half may be another speed of the file. More drips out of the nozzle."""

    def make(found):
        line = file.lines[found[0]]
        return edited(file, {found[0]: [with_f(line.text, line.feed * 0.53), f"G1 F{number(line.feed)}"]})

    return pick(rng, tails(file), 5, make)


def is_move(line):
    return line.kind in ("travel", "z", "retract", "prime") and re.match(r"G[01]\b", line.text)


def script_move_dropped(first, end):
    def defect(file, rng):
        found = [i for i in range(first(file), end(file)) if is_move(file.lines[i])]
        return pick(rng, found, 1, lambda i: edited(file, {i: []}))

    return defect


def start_script_end(file):
    """Behind the last command of the start script that is no setting."""
    before = range(file.paths[0].first)
    return max((i for i in before if re.match(r"G(?:28|29|4|92)\b|M(?:109|190|83|82)\b|G21",
                                              file.lines[i].text)), default=0)


def end_script_begin(file):
    behind = range(file.paths[-1].last + 1, len(file.lines))
    return next((i for i in behind if re.match(r"M(?:104|140|84)\b|G4\b", file.lines[i].text)),
                len(file.lines))


def truncated(file, rng):
    lines = [i for i, line in enumerate(file.lines) if line.text.strip()]
    end = lines[-rng.randint(1, min(30, len(lines) // 2))]
    return "\n".join(line.text for line in file.lines[:end])


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


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("move of the start script", "scripts", from_script, "free"),
    ("move along a path's end dropped", "path_ends", tail_dropped, "free"),
    ("move along a path's end longer", "path_ends", tail_longer, "free"),
    ("move along a path's end at half its speed", "speeds", tail_slow, "free"),
    ("file cut off", "same_print", truncated, "free"),
    ("move of the start script dropped", "scripts", script_move_dropped(lambda _: 0, start_script_end), "free"),
    ("move of the end script dropped", "scripts",
     script_move_dropped(end_script_begin, lambda file: len(file.lines)), "free"),
    ("setting of the start script dropped", "same_print", start_setting_dropped, "free"),
    ("setting of the end script dropped", "same_print", end_setting_dropped, "free"),
    ("acceleration set in the end script", "same_print", into_end_script("M204 S123"), "free"),
    ("fan set in the end script", "same_print", into_end_script("M106 S33"), "free"),
    ("feed rate set in the end script", "same_print", into_end_script("G1 F123"), "free"),
)
