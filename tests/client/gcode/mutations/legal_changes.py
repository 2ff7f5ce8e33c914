"""Changes to a good file that a print does not feel: none of them may be called a defect.

Each takes (file, rng) and returns the changed text, or None, as in defects.py.
"""

import math
import re

from edits import edited, pick, restated, reverse, with_xy
from places import links, steady
from sliced import number


def way_in_two(file, rng):
    """A way is gone in two parts."""

    def make(found):
        _, _, ways, _ = found
        i = ways[-1]
        line = file.lines[i]
        if line.length() < 2 or line.start[2] != line.end[2] or not line.text.startswith(("G0", "G1")):
            return None
        middle = [(line.start[a] + line.end[a]) / 2 for a in (0, 1)]
        return edited(file, {i: [with_xy(line.text, middle), line.text]})

    return pick(rng, links(file), 50, make)


def feed_on_own_line(file, rng):
    i = rng.choice(file.paths).first
    return edited(file, {i: [f"G1 F{number(file.lines[i].feed)}", file.lines[i].text]})


def settings_restated(file, rng):
    if re.search(r"^M204 [PT]", file.text(), re.MULTILINE):
        return None
    path = rng.choice(file.paths)
    again = [line for line in restated(file, path.first) if line[0] != ";"]
    return edited(file, {path.first: again + [file.lines[path.first].text]})


def numbers_otherwise(file, _):
    """0.500 for .5, and blanks around the words of moves."""
    changes = {}
    for i, line in enumerate(file.lines):
        if line.kind in ("deposit", "travel") and ";" not in line.text:
            changes[i] = [re.sub(r" ([XY])(-?)\.", r" \g<1>\g<2>0.", line.text) + "  "]
    return edited(file, changes)


def blank_lines(file, rng):
    return edited(file, {path.first: ["", file.lines[path.first].text] for path in rng.sample(
        file.paths, min(5, len(file.paths)))})


def register_reset(file, rng):
    """In relative mode the register means nothing."""
    if "M83" not in file.text() or len(file.paths) < 2:
        return None
    path = rng.choice(file.paths[1:])
    return edited(file, {path.first: ["G92 E0", file.lines[path.first].text]})


def travel_by_g0(file, _):
    changes = {i: ["G0" + line.text[2:]] for i, line in enumerate(file.lines[:file.paths[-1].first])
               if i > file.paths[0].first and line.kind == "travel" and line.text.startswith("G1 ") and
               "E" not in line.text}
    return edited(file, changes)


def behind(file, path):
    """The kind of the first move behind the path."""
    moves = ("deposit", "travel", "wipe", "retract", "prime", "z")
    return next((line.kind for line in file.lines[path.last + 1:] if line.kind in moves), None)


def turned(file, path):
    """Where filament is pulled back at the end of the path, it is at the new end: a move to the old one
    with an open nozzle would be one more."""
    changes = reverse(file, path)
    if behind(file, path) == "retract":
        del changes[path.first][-1 - len(restated(file, path.first))]
    return edited(file, changes)


def infill_turned(file, rng):
    """Where the way to its other end needs no acceleration of its own."""
    if "M204" in file.text():
        return None
    fills = [p for p in file.paths if p.type.lower() in ("internal infill", "sparse infill", "fill", "infill") and
             steady(file, p) and not p.closed() and math.dist(p.start, p.end) < 0.9 and
             behind(file, p) in ("travel", "retract")]
    return pick(rng, fills, 20, lambda p: turned(file, p))


def other_line_ends(file, _):
    return file.text().replace("\n", "\r\n")


def mark_at_head(file, _):
    lines = file.text().split("\n")
    return "\n".join(lines[:1] + ["; optimised by Traverse 1.0, policy free: x"] + lines[1:])


# (name, change)
CHANGES = (
    ("way in two parts", way_in_two),
    ("feed rate on a line of its own", feed_on_own_line),
    ("settings of a path said again", settings_restated),
    ("numbers written otherwise", numbers_otherwise),
    ("blank lines", blank_lines),
    ("register of the extruder set to 0", register_reset),
    ("travel by G0", travel_by_g0),
    ("line of infill turned", infill_turned),
    ("all line ends changed", other_line_ends),
    ("line of this program behind the first", mark_at_head),
)
