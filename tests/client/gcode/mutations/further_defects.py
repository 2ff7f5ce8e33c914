"""Further defects to put into a good file, of the kinds of defects.py: one change each."""

import re

from defects import (body, distance, edited, go, is_outer, lifted, links, long_way, pick, restated, reverse,
                     steady, swap, swapped, to_piece, way_of, wiped, with_effect, with_f, with_z)
from sliced import number


def with_word(text, letter, change):
    return re.sub(letter + r"(-?[0-9]*\.?[0-9]+)", lambda m: letter + number(change(float(m.group(1)))), text,
                  count=1)


def moved_behind(file, i, behind):
    return edited(file, {i: [], behind: [file.lines[behind].text, file.lines[i].text]})


def next_deposit(file, i):
    return next((k for k in range(i + 1, len(file.lines)) if file.lines[k].kind == "deposit"), None)


def next_path(file, i):
    return next((path for path in file.paths if path.first > i), None)


# --- what is deposited -----------------------------------------------------------------------------


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
    return [half, go(file, line.start), f"G1 F{number(line.feed)}", half]


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


def layers_exchanged(file, rng):
    def make(k):
        for other in range(k + 1, min(k + 60, len(file.paths))):
            if file.paths[other].start[2] != file.paths[k].start[2]:
                one, two = file.paths[k], file.paths[other]
                both = one.plain and two.plain and body(file, one) != body(file, two)
                return swap(file, k, other) if both else None
        return None

    return pick(rng, range(len(file.paths)), 50, make)


def path_doubled(file, rng):
    def make(path):
        again = [go(file, path.start)] + restated(file, path.first) + body(file, path)
        return edited(file, {path.last: [file.lines[path.last].text] + again}) if path.plain else None

    return pick(rng, file.paths, 20, make)


def travel_dribbles(file, rng):
    def make(found):
        i = found[2][-1]
        return edited(file, {i: [file.lines[i].text.split(";")[0].rstrip() + " E0.02"]})

    return pick(rng, links(file), 5, make)


# --- what is set -----------------------------------------------------------------------------------


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
    """A comment or M73 line comes some layers later."""
    notes = [i for i, line in enumerate(file.lines) if re.match(r"M73|;TIME_ELAPSED|;Z:", line.text)]

    def make(i):
        later = next((path for path in file.paths
                      if path.first > i and path.start[2] > file.lines[i].start[2] + 0.5), None)
        return moved_behind(file, i, later.last) if later else None

    return pick(rng, notes, 10, make)


def around(wanted):
    """The first move of a link that is `wanted` is done under another acceleration."""

    def defect(file, rng):
        def make(found):
            i = wanted(file, found)
            setter = i is not None and file.lines[i].state.get("M204")
            if not setter:
                return None
            other = re.sub(r"([SPTR])[0-9.]+", r"\g<1>333", setter)
            return edited(file, {i: [other, file.lines[i].text, setter]})

        return pick(rng, links(file), 50, make)

    return defect


def retraction_of(file, found):
    return next((i for i in found[1] if file.lines[i].kind == "retract"), None)


def wipe_of(file, found):
    return next((i for i in found[1] if file.lines[i].kind == "wipe"), None)


def lift_of(file, found):
    return next((i for i in range(found[1][-1], found[2][0]) if file.lines[i].kind == "z"), None)


# --- scripts ---------------------------------------------------------------------------------------


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


def last_retraction_deeper(file, rng):
    end = min(len(file.lines), file.paths[-1].last + 40)
    pulls = [i for i in range(file.paths[-1].last + 1, end) if file.lines[i].kind == "retract"]
    return pick(rng, pulls[:1], 1, lambda i: edited(
        file, {i: [with_word(file.lines[i].text, "E", lambda e: e - 0.9)]}))


def truncated(file, rng):
    lines = [i for i, line in enumerate(file.lines) if line.text.strip()]
    end = lines[-rng.randint(1, min(30, len(lines) // 2))]
    return "\n".join(line.text for line in file.lines[:end])


# --- ways ------------------------------------------------------------------------------------------


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


def way_far(file, rng):
    """A way leads to a point far from all the others."""
    return pick(rng, links(file), 5, lambda found: edited(
        file, {found[2][-1]: [go(file, (-400, 700)), file.lines[found[2][-1]].text]}))


def lift_higher(file, rng):
    """By a height that no lift has."""

    def make(found):
        index, z = way_of(file, found)
        if not any(file.lines[i].kind == "z" for i in index):
            return None
        return edited(file, {i: [with_z(file.lines[i].text, file.lines[i].end[2] + 0.313)]
                             for i in index if file.lines[i].end[2] > z + 0.01})

    return pick(rng, lifted(file), 50, make)


def at_its_feed(file, i):
    return [f"G1 F{number(file.lines[i].feed)}", file.lines[i].text]


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


def down_of(file, found):
    """The move down in front of the priming behind the way."""
    _, _, ways, pushes = found
    return next((i for i in range(ways[-1] + 1, pushes[0])
                 if file.lines[i].kind == "z" and file.lines[i].end[2] < file.lines[i].start[2] - 0.05), None)


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


def lifted_links(file):
    return [found for found in links(file)
            if max(file.lines[i].end[2] for i in found[2]) > file.paths[found[0] + 1].start[2] + 0.05]


def lift_slow(file, rng):
    def make(found):
        i = lift_of(file, found)
        return None if i is None else edited(file, {i: [with_f(file.lines[i].text, 123),
                                                        f"G1 F{number(file.lines[i].feed)}"]})

    return pick(rng, links(file), 50, make)


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


def wipe_halved(file, rng):
    """The wipe leads half as far along the path, all of its filament on the way."""

    def make(found):
        k, wipes = found
        line = file.lines[wipes[-1]]
        if len(wipes) != 1 or line.length() < 0.5 or not line.text.startswith("G1"):
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


# --- order and direction ---------------------------------------------------------------------------


def monotonic_reversed(file, rng):
    """A path of a monotonic surface the other way round."""
    if "top_fill_pattern = monotonic" not in file.text() and (
            "top_surface_pattern = monotonic" not in file.text()):
        return None
    tops = [p for p in file.paths if p.type.lower() in ("top solid infill", "top surface", "ironing")]
    return pick(rng, [p for p in tops if steady(file, p)], 50,
                lambda p: None if p.closed() else edited(file, reverse(file, p)))


def ironing_exchanged(file, rng):
    return swapped(file, rng, lambda one, other: one.type.lower() == other.type.lower() == "ironing")


def tower_exchanged(file, rng):
    def wanted(one, other):
        names = one.type.lower(), other.type.lower()
        return any(name in ("wipe tower", "prime tower", "prime-tower") for name in names)

    return swapped(file, rng, wanted, None)


def seam_by_one(file, rng):
    def make(path):
        if not path.closed() or not steady(file, path) or len(path.deposits) < 4:
            return None
        lines = body(file, path)
        feed = restated(file, path.first)
        changes = {i: [] for i in range(path.first, path.last + 1)}
        gap = [f"G1 X{number(path.start[0])} Y{number(path.start[1])}"]
        changes[path.first] = ([go(file, path.points[1])] + feed + lines[1:] + gap + lines[:1] +
                               [go(file, path.end)] + feed)
        return edited(file, changes)

    return pick(rng, [p for p in file.paths if is_outer(p)], 100, make)


def fill_under_wall(file, rng):
    """A support and its neighbour that is none, at the distance at which they are laid."""

    def wanted(one, other):
        return ("support" in one.type.lower()) != ("support" in other.type.lower()) and (
            distance(one, other, 0.3) <= 0.48)

    return swapped(file, rng, wanted, None)


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("1 % more filament in a segment", "same_print", one_percent_more, "free"),
    ("a point off by 0.03 mm", "same_print", point_off, "free"),
    ("segment in two passes of half the flow", "same_print", two_passes, "free"),
    ("center of an arc off by 0.02 mm", "same_print", center_off, "free"),
    ("arc made a chord", "same_print", arc_to_chord, "free"),
    ("flow of two segments exchanged", "same_print", flow_exchanged, "free"),
    ("paths of two layers exchanged", "same_print", layers_exchanged, "free"),
    ("path printed twice", "same_print", path_doubled, "free"),
    ("filament on a travel", "same_print", travel_dribbles, "free"),
    ("fan a path late", "same_print", behind_next_path(r"M10[67]\b(?! P)"), "free"),
    ("advance a path late", "same_print", behind_next_path(r"M900\b|M572\b|SET_PRESSURE_ADVANCE"), "free"),
    ("jerk a path late", "same_print", behind_next_path(r"M205\b|SET_VELOCITY_LIMIT"), "free"),
    ("acceleration a path late", "same_print", behind_next_path(r"M204\b|M201\b"), "free"),
    ("M73 doubled", "same_print", doubled(r"M73\b"), "free"),
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
    ("file cut off", "same_print", truncated, "free"),
    ("move of the start script dropped", "scripts", script_move_dropped(lambda _: 0, start_script_end), "free"),
    ("move of the end script dropped", "scripts",
     script_move_dropped(end_script_begin, lambda file: len(file.lines)), "free"),
    ("last retraction deeper", "retractions", last_retraction_deeper, "free"),
    ("retraction in two, and less", "retractions", retraction_in_two, "free"),
    ("priming dropped", "same_print", prime_dropped, "free"),
    ("filament back above the layer", "retractions", primed_above, "free"),
    ("filament pulled back above the layer", "retractions", pulled_above, "free"),
    ("way below the layer", "lifts", way_low, "free"),
    ("way to far away", "speeds", way_far, "free"),
    ("lift higher", "lifts", lift_higher, "free"),
    ("lift invented", "lifts", lift_invented, "free"),
    ("lift dropped in a layer that has them", "lifts", lift_dropped_in_layer, "free"),
    ("rises where the way to the layer ends", "lifts", low_to_next_layer, "free"),
    ("down before the way to the next object", "lifts", down_before_way, "free"),
    ("lift at another speed", "speeds", lift_slow, "free"),
    ("retraction under another acceleration", "speeds", around(retraction_of), "free"),
    ("wipe under another acceleration", "speeds", around(wipe_of), "free"),
    ("lift under another acceleration", "speeds", around(lift_of), "free"),
    ("wipe half as long", "wipes", wipe_halved, "free"),
    ("wipe across its loop", "wipes", wipe_across, "free"),
    ("monotonic path reversed", "direction", monotonic_reversed, "balanced"),
    ("lines of ironing exchanged", "order", ironing_exchanged, "free"),
    ("path of a tower exchanged", "order", tower_exchanged, "free"),
    ("support and its neighbour exchanged", "order", fill_under_wall, "free"),
    ("seam moved by a vertex", "seam", seam_by_one, "safe"),
)
