"""Defects of modes, settings, tools, labels and comments. Kinds as in defects.py."""

import re

from edits import changed_number, edited, moved_behind, next_path, pick, with_word
from places import lines_of, with_effect
from sliced import number
from text_defects import mark_inserted

TEMPERATURE = r"M(?:104|109|140|190|141|191) "
LABEL = r"; (?:printing|start printing) object|EXCLUDE_OBJECT_START|M624|M486 S\d"
LABEL_END = r"; stop printing object|EXCLUDE_OBJECT_END|M625|M486 S-1"
TIMELAPSE = r"TIMELAPSE_|M971|M622|M623|; ?SKIP|;?TIMELAPSE|M240"


def in_print(file, pattern):
    return lines_of(file, pattern, file.paths[0].first, file.paths[-1].last)


def dropped_in_print(pattern):
    return lambda file, rng: pick(rng, in_print(file, pattern), 1, lambda i: edited(file, {i: []}))


def late(pattern):
    """A line comes behind the path it stood before."""

    def defect(file, rng):
        def make(i):
            path = next_path(file, i)
            return moved_behind(file, i, path.last) if path else None

        return pick(rng, in_print(file, pattern), 10, make)

    return defect


def before_it(file, i, pattern):
    """The last line before line `i` that is like this."""
    return next((file.lines[k].text for k in range(i - 1, -1, -1) if re.match(pattern, file.lines[k].text)), None)


def early(pattern):
    """A line comes before the path it stood behind, which is printed otherwise by that."""

    def defect(file, rng):
        def make(i):
            before = [path for path in file.paths if path.last < i]
            if not before or before_it(file, before[-1].first, pattern) == file.lines[i].text:
                return None
            first = before[-1].first
            return edited(file, {i: [], first: [file.lines[i].text, file.lines[first].text]})

        return pick(rng, in_print(file, pattern), 10, make)

    return defect


def in_start(pattern, text=None):
    """A line of the start script is dropped, or another one stands there."""

    def defect(file, rng):
        found = lines_of(file, pattern, 0, file.paths[0].first)
        return pick(rng, found, 1, lambda i: edited(file, {i: [] if text is None else [text]}))

    return defect


def between(text):
    return lambda file, rng: mark_inserted(text)(file, rng)


def numbers_of(pattern):
    return lambda file, rng: changed_number(file, rng, pattern)


def letter_changed(pattern):
    """A letter of a comment."""

    def defect(file, rng):
        def make(i):
            text = file.lines[i].text
            places = [k for k, c in enumerate(text) if k > 2 and c.isalnum()]
            if not places:
                return None
            k = rng.choice(places)
            return edited(file, {i: [text[:k] + ("a" if text[k] != "a" else "b") + text[k + 1:]]})

        return pick(rng, lines_of(file, pattern), 5, make)

    return defect


def picture_letter(file, rng):
    begin = lines_of(file, r"; thumbnail\w* begin")
    if not begin:
        return None
    i = rng.randrange(begin[0] + 1, lines_of(file, r"; thumbnail\w* end", begin[0])[0])
    text = file.lines[i].text
    return edited(file, {i: [text[:-1] + ("A" if text[-1] != "A" else "B")]}) if len(text) > 3 else None


def other_tool(file, rng):
    found = in_print(file, r"T\d\s*(?:;.*)?$")
    return pick(rng, found, 1, lambda i: edited(
        file, {i: [f"T{(int(file.lines[i].text[1]) + 1) % 4}"]}))


def type_late(file, rng):
    """What the next path is of is said behind it."""
    kinds = r"; ?(?:TYPE|FEATURE):"

    def make(i):
        path = next_path(file, i)
        named = [k for k in range(i) if re.match(kinds, file.lines[k].text)]
        if path is None or not named or file.lines[named[-1]].text == file.lines[i].text:
            return None
        return None if any(re.match(kinds, file.lines[k].text) for k in range(i + 1, path.last + 1)) else (
            moved_behind(file, i, path.last))

    return pick(rng, in_print(file, kinds), 50, make)


def width_changed(file, rng):
    def make(i):
        path = next_path(file, i)
        if path is None or any("WIDTH" in file.lines[k].text for k in range(i + 1, path.first)):
            return None
        found = re.search(r"[0-9.]+$", file.lines[i].text)
        return edited(file, {i: [file.lines[i].text[:found.start()] + number(float(found.group()) + 0.03)]}) if (
            found) else None

    return pick(rng, in_print(file, r"; ?(?:LINE_)?WIDTH: ?[0-9]"), 50, make)


def fan_changed(file, rng):
    """Where something is printed under it."""
    found = [i for i in with_effect(file, r"M10[67]\b(?! P)") if "S" in file.lines[i].text]
    return pick(rng, found, 1, lambda i: edited(
        file, {i: [with_word(file.lines[i].text, "S", lambda v: v + 5 if v < 200 else v - 5)]}))


def comment_at(place):
    """A comment that nobody wrote."""

    def defect(file, rng):
        i = {"head": 0, "end": len(file.lines) - 1, "print": rng.choice(file.paths).first}[place]
        return edited(file, {i: [file.lines[i].text, "; printed by somebody"]})

    return defect


def advance_dropped(file, rng):
    found = with_effect(file, r"M900\b|M572\b|SET_PRESSURE_ADVANCE")
    return pick(rng, found, 1, lambda i: edited(file, {i: []}))


def width_late(file, rng):
    """The width of a path is said behind it."""
    return pick(rng, in_print(file, r"; ?(?:LINE_)?WIDTH:"), 50, lambda i: width_behind(file, i))


def width_behind(file, i):
    path = next_path(file, i)
    before = before_it(file, i, r"; ?(?:LINE_)?WIDTH:")
    if path is None or before in (None, file.lines[i].text) or (
            any("WIDTH" in file.lines[k].text for k in range(i + 1, path.last + 1))):
        return None
    return moved_behind(file, i, path.last)


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("temperature a path late", "same_print", late(TEMPERATURE), "free"),
    ("temperature a path early", "same_print", early(TEMPERATURE), "free"),
    ("temperature of a layer dropped", "same_print", dropped_in_print(TEMPERATURE), "free"),
    ("temperature set between two paths", "same_print", between("M104 S199"), "free"),
    ("fan a path early", "same_print", early(r"M10[67]\b(?! P)"), "free"),
    ("value of the fan changed", "same_print", fan_changed, "free"),
    ("acceleration changed", "same_print", numbers_of(r"M204 [PST](\d+)"), "free"),
    ("acceleration of Klipper changed", "same_print", numbers_of(r"SET_VELOCITY_LIMIT ACCEL=(\d+)"), "free"),
    ("limit of the machine changed", "same_print", numbers_of(r"M20[13] X(\d+)"), "free"),
    ("other limit between two paths", "same_print", between("M203 X50"), "free"),
    ("jerk dropped", "same_print", dropped_in_print(r"M205|M566"), "free"),
    ("flow set back dropped", "same_print", dropped_in_print(r"M22[01]"), "free"),
    ("offset set between two paths", "same_print", between("M206 X1"), "free"),
    ("offset of Klipper set between two paths", "same_print", between("SET_GCODE_OFFSET Z=0.05"), "free"),
    ("input shaper set between two paths", "same_print", between("M593 F40"), "free"),
    ("coordinates set between two paths", "same_print", between("G92 X0"), "free"),
    ("height set between two paths", "same_print", between("G92 Z1"), "free"),
    ("relative mode between two paths", "same_print", between("G91"), "free"),
    ("inches between two paths", "same_print", between("G20"), "free"),
    ("plane set between two paths", "same_print", between("G18"), "free"),
    ("workspace set between two paths", "same_print", between("G55"), "free"),
    ("homing between two paths", "same_print", between("G28 X"), "free"),
    ("motors off between two paths", "same_print", between("M84 E"), "free"),
    ("macro between two paths", "same_print", between("PARK"), "free"),
    ("millimetres dropped", "same_print", in_start(r"G21\b"), "free"),
    ("millimetres made inches", "same_print", in_start(r"G21\b", "G20"), "free"),
    ("absolute mode dropped", "same_print", in_start(r"G90\b"), "free"),
    ("absolute mode made relative", "same_print", in_start(r"G90\b", "G91"), "free"),
    ("script of the start changed", "same_print", in_start(r"START_PRINT|PRINT_START|M862|M115|G29|G80", "M400"),
     "free"),
    ("dwell a path late", "same_print", late(r"G4 [PS]|M400"), "free"),
    ("waiting for moves dropped", "same_print", dropped_in_print(r"M400"), "free"),
    ("text for the display dropped", "same_print", dropped_in_print(r"M117|M118"), "free"),
    ("progress dropped", "progress", dropped_in_print(r"M73"), "free"),
    ("progress changed", "progress", numbers_of(r"M73 P(\d+)"), "free"),
    ("pause a path late", "same_print", late(r"M600|M601|M25|M0\b|@pause|PAUSE"), "free"),
    ("tool dropped", "same_print", dropped_in_print(r"T\d\s*(?:;.*)?$"), "free"),
    ("tool a path late", "same_print", late(r"T\d\s*(?:;.*)?$"), "free"),
    ("other tool", "same_print", other_tool, "free"),
    ("tool taken between two paths", "same_print", between("T3"), "free"),
    ("label dropped", "same_print", dropped_in_print(LABEL), "free"),
    ("label a path early", "same_print", early(LABEL), "free"),
    ("end of a label dropped", "same_print", dropped_in_print(LABEL_END), "free"),
    ("end of a label a path late", "same_print", late(LABEL_END), "free"),
    ("list of objects changed", "same_print", letter_changed(r"EXCLUDE_OBJECT_DEFINE|; objects_info|; model label"),
     "free"),
    ("time-lapse dropped", "same_print", dropped_in_print(TIMELAPSE), "free"),
    ("time-lapse a path late", "same_print", late(TIMELAPSE), "free"),
    ("feature said a path late", "same_print", type_late, "free"),
    ("width changed", "same_print", width_changed, "free"),
    ("mark of a layer dropped", "same_print", dropped_in_print(
        r";LAYER|; CHANGE_LAYER|; layer \d|;layer:|; BEGIN_LAYER|; <layer>"), "free"),
    ("mark of a layer a path late", "same_print", late(
        r";LAYER|; CHANGE_LAYER|; layer \d|;layer:|; BEGIN_LAYER|; <layer>"), "free"),
    ("number of a layer changed", "same_print", numbers_of(r"; ?(?:LAYER|layer) ?:?(\d+)"), "free"),
    ("time of a layer changed", "same_print", numbers_of(r";(?:TIME_ELAPSED|PRINTING_TIME): ?(\d+)"), "free"),
    ("setting in a comment changed", "same_print", letter_changed(r"; \w+ = |;SETTING_3 "), "free"),
    ("letter of a picture changed", "same_print", picture_letter, "free"),
    ("comment of the head changed", "same_print", letter_changed(r"; ?(?:generated|Generated|G-Code|Sliced|estimated|"
                                                                 r"filament|total|FLAVOR|KISSlicer)"), "free"),
    ("comment at the head", "same_print", comment_at("head"), "free"),
    ("comment at the end", "same_print", comment_at("end"), "free"),
    ("comment in the print", "same_print", comment_at("print"), "free"),
    ("width said a path late", "same_print", width_late, "free"),
    ("advance dropped", "same_print", advance_dropped, "free"),
    ("dwell changed", "same_print", numbers_of(r"G4 [PS](\d+)"), "free"),
    ("heat of the chamber between two paths", "same_print", between("M141 S40"), "free"),
    ("limits switched off between two paths", "same_print", between("M211 S0"), "free"),
)
