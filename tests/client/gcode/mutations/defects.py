"""Defects to put into a good file: one change each that a print must not suffer.

Each takes (file, rng) and returns the changed text, or None if the file has no place for it. The
table names the rule that is there for it.
"""

import math
import re

from sliced import number

WALLS = ("perimeter", "wall")
OUTER = ("external perimeter", "outer wall", "wall-outer", "overhang")


def is_wall(path):
    return any(name in path.type.lower() for name in WALLS)


def is_outer(path):
    return any(name in path.type.lower() for name in OUTER)


def edited(file, changes):
    """The text with lines replaced: changes[i] is a list of lines in place of line i."""
    out = []
    for i, line in enumerate(file.lines):
        out.extend(changes[i] if i in changes else [line.text])
    return "\n".join(out)


def pick(rng, candidates, tries, make):
    """The first of `tries` candidates, at random, that `make` makes something of."""
    candidates = list(candidates)
    rng.shuffle(candidates)
    for candidate in candidates[:tries]:
        made = make(candidate)
        if made is not None:
            return made
    return None


def go(file, point):
    feeds = [line.feed for line in file.lines[: 20000] if line.kind == "travel" and line.feed]
    feed = max(feeds, default=9000)
    return f"G1 X{number(point[0])} Y{number(point[1])} F{number(feed)}"


def restated(file, index):
    """Lines that set what holds for line `index`."""
    line = file.lines[index]
    return list(line.state.values()) + [f"G1 F{number(line.feed)}"]


def body(file, path):
    return [file.lines[i].text for i in range(path.first, path.last + 1)]


def links(file):
    """(link, its retraction, its travels, its priming) of those that retract within a layer."""
    for k in range(len(file.paths) - 1):
        if file.paths[k].section != file.paths[k + 1].section:
            continue
        index = list(file.link(k))
        kinds = [file.lines[i].kind for i in index]
        if "retract" not in kinds or "prime" not in kinds:
            continue
        pulls = [i for i in index if file.lines[i].kind in ("retract", "wipe") and file.lines[i].e < 0]
        pushes = [i for i in index if file.lines[i].kind == "prime"]
        ways = [i for i in index if file.lines[i].kind == "travel" and pulls[-1] < i]
        if ways and pushes[-1] > ways[-1]:
            yield k, pulls, ways, pushes


def cross(a, b, c, d):
    def side(p, q, r):
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    return side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0


def shortened(a, b):
    length = math.dist(a, b)
    cut = 0.3 / length if length > 1 else 0.3
    return ((a[0] + (b[0] - a[0]) * cut, a[1] + (b[1] - a[1]) * cut),
            (b[0] - (b[0] - a[0]) * cut, b[1] - (b[1] - a[1]) * cut))


def crosses_wall(file, k, ways):
    """The way behind path k leads across an outer wall near it, at its height; its ends aside."""
    z = file.paths[k + 1].start[2]
    if file.paths[k].start[2] != z:
        return False
    walls = [path for path in file.paths[max(0, k - 150): k + 150]
             if is_outer(path) and path.plain and path.start[2] == z]
    for i in ways:
        a, b = shortened(file.lines[i].start[:2], file.lines[i].end[:2])
        if any(cross(a, b, p, q) for path in walls for p, q in zip(path.points, path.points[1:])):
            return True
    return False


def to_piece(p, a, b):
    dx, dy = b[0] - a[0], b[1] - a[1]
    squared = dx * dx + dy * dy
    t = 0 if squared == 0 else max(0, min(1, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / squared))
    return math.dist(p, (a[0] + t * dx, a[1] + t * dy))


def distance(one, other, limit):
    best = 1e9
    for p, q in ((one, other), (other, one)):
        for point in p.points:
            for a, b in zip(q.points, q.points[1:]):
                best = min(best, to_piece(point, a, b))
                if best <= limit:
                    return best
    return best


# --- paths -----------------------------------------------------------------------------------------


def drop_segment(file, rng):
    return pick(rng, file.paths, 5, lambda p: edited(file, {rng.choice(p.deposits): []}))


def cut_path(file, rng):
    """The second half first, the first half behind it."""

    def make(path):
        if not path.plain or len(path.deposits) < 4 or path.closed():
            return None
        k = len(path.deposits) // 2
        lines = body(file, path)
        new = ([go(file, path.points[k])] + restated(file, path.first + k) + lines[k:] +
               [go(file, path.start)] + restated(file, path.first) + lines[:k] +
               [go(file, path.end)] + restated(file, path.last))
        changes = {i: [] for i in range(path.first, path.last + 1)}
        changes[path.first] = new
        return edited(file, changes)

    return pick(rng, file.paths, 200, make)


def swap(file, k, other):
    """Paths k and other change places; links lead to where they did, and on from there."""
    changes = {}
    for here, there in ((k, other), (other, k)):
        path, comes = file.paths[here], file.paths[there]
        for i in range(path.first, path.last + 1):
            changes[i] = []
        changes[path.first] = ([go(file, comes.start)] + restated(file, comes.first) +
                               body(file, comes) + [go(file, path.end)] +
                               restated(file, path.last))
    return edited(file, changes)


def swapped(file, rng, wanted, near=0.45):
    def make(k):
        path = file.paths[k]
        for other in range(k + 1, min(k + 25, len(file.paths))):
            later = file.paths[other]
            if later.section != path.section or later.start[2] != path.start[2]:
                return None
            if path.plain and later.plain and wanted(path, later) and (
                    near is None or distance(path, later, near) <= near):
                return swap(file, k, other)
        return None

    return pick(rng, range(len(file.paths)), 400, make)


def infill_before_wall(file, rng):
    def wanted(one, other):
        names = ("infill", "fill", "skin", "surface", "perimeter", "wall")
        return is_wall(one) != is_wall(other) and all(
            any(name in path.type.lower() for name in names) for path in (one, other))

    return swapped(file, rng, wanted)


def walls_swapped(file, rng):
    return swapped(file, rng, lambda one, other: is_wall(one) and is_wall(other) and
                   is_outer(one) != is_outer(other))


def bridge_first(file, rng):
    def wanted(one, other):
        return "bridge" in other.type.lower() and "bridge" not in one.type.lower()

    return swapped(file, rng, wanted)


def support_swapped(file, rng):
    def wanted(one, other):
        names = one.type.lower(), other.type.lower()
        return ("support" in names[0]) != ("support" in names[1]) or (
            "support" in names[0] and names[0] != names[1])

    return swapped(file, rng, wanted)


def skirt_last(file, rng):
    def wanted(one, other):
        return "skirt" in one.type.lower() and "skirt" not in other.type.lower()

    return swapped(file, rng, wanted, None)


def ironing_first(file, rng):
    def wanted(one, other):
        return "ironing" in other.type.lower() and "top" in one.type.lower()

    return swapped(file, rng, wanted)


def monotonic_swapped(file, rng):
    if "top_fill_pattern = monotonic" not in file.text() and (
            "top_surface_pattern = monotonic" not in file.text()):
        return None
    return swapped(file, rng, lambda one, other: one.type == other.type and one.type.lower() in (
        "top solid infill", "top surface"))


def reverse(file, path):
    """The path from its end to its start."""
    texts = []
    for i in reversed(path.deposits):
        line = file.lines[i]
        texts.append(f"G1 X{number(line.start[0])} Y{number(line.start[1])} E{number(line.e)}")
    changes = {i: [] for i in range(path.first, path.last + 1)}
    feed = restated(file, path.first)
    changes[path.first] = [go(file, path.end)] + feed + texts + [go(file, path.end)] + feed
    return changes


def steady(file, path):
    first = file.lines[path.first]
    return path.plain and all(file.lines[i].feed == first.feed and file.lines[i].state == first.state
                              for i in path.deposits)


def outer_reversed(file, rng):
    return pick(rng, [p for p in file.paths if is_outer(p) and steady(file, p)], 50,
                lambda p: edited(file, reverse(file, p)) if p.closed() else None)


def open_wall_reversed(file, rng):
    return pick(rng, [p for p in file.paths if is_wall(p) and steady(file, p)], 400,
                lambda p: None if p.closed() or math.dist(p.start, p.end) < 0.2
                else edited(file, reverse(file, p)))


def seam_moved(file, rng):
    def make(path):
        if not path.closed() or not steady(file, path):
            return None
        far = [k for k in range(2, len(path.deposits) - 1)
               if math.dist(path.points[k], path.start[:2]) > 1]
        if not far:
            return None
        k = rng.choice(far)
        lines = body(file, path)
        changes = {i: [] for i in range(path.first, path.last + 1)}
        feed = restated(file, path.first)
        gap = [f"G1 X{number(path.start[0])} Y{number(path.start[1])}"]
        changes[path.first] = ([go(file, path.points[k])] + feed + lines[k:] + gap + lines[:k] +
                               [go(file, path.end)] + feed)
        return edited(file, changes)

    return pick(rng, [p for p in file.paths if is_outer(p)], 100, make)


# --- ways ------------------------------------------------------------------------------------------


def without_e(text):
    return re.sub(r"\s*E-?[0-9.]+", "", text)


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


def primed_early(file, rng):
    def make(found):
        k, pulls, ways, pushes = found
        if not crosses_wall(file, k, ways):
            return None
        pushed = [file.lines[i].text for i in pushes]
        changes = {i: [] for i in pushes}
        changes[ways[0]] = pushed + [go(file, file.lines[ways[0]].end)] if (
            file.lines[ways[0]].start[2] == file.lines[ways[0]].end[2]) else (
            pushed + [file.lines[ways[0]].text])
        return edited(file, changes)

    return pick(rng, links(file), 150, make)


def with_e(text, change):
    return re.sub(r"E(-?[0-9.]+)", lambda m: "E" + number(change(float(m.group(1)))), text)


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


def lifted(file):
    """Links whose ways are lifted, if nearly all that retract are."""
    up, all_links = [], 0
    for k, pulls, ways, _ in links(file):
        all_links += 1
        z = file.paths[k + 1].start[2]
        if max(file.lines[i].end[2] for i in ways) > z + 0.05:
            up.append((k, pulls, ways, z))
    return up if all_links and len(up) >= 0.995 * all_links else []


def way_of(file, found):
    _, pulls, ways, z = found
    index = range(pulls[-1] + 1, ways[-1] + 1)
    return [i for i in index if file.lines[i].kind in ("z", "travel")], z


def with_z(text, z):
    return re.sub(r"Z-?[0-9.]+", "Z" + number(z), text)


def long_way(file, found):
    _, _, ways, _ = found
    return sum(file.lines[i].length() for i in ways) > 3


def lift_dropped(file, rng):
    def make(found):
        index, z = way_of(file, found)
        return edited(file, {i: [with_z(file.lines[i].text, z)] for i in index}) if (
            long_way(file, found)) else None

    return pick(rng, lifted(file), 50, make)


def lift_halved(file, rng):
    def make(found):
        index, z = way_of(file, found)
        return edited(file, {i: [with_z(file.lines[i].text, z + (file.lines[i].end[2] - z) / 2)]
                             for i in index}) if long_way(file, found) else None

    return pick(rng, lifted(file), 50, make)


def lift_late(file, rng):
    """Up where the way ends."""

    def make(found):
        index, z = way_of(file, found)
        if not long_way(file, found):
            return None
        changes = {i: [re.sub(r"\s*Z-?[0-9.]+", "", file.lines[i].text)]
                   if file.lines[i].kind == "travel" else [] for i in index}
        top = max(file.lines[i].end[2] for i in index)
        changes[index[-1]] = changes[index[-1]] + [f"G1 Z{number(top)}"]
        return edited(file, changes)

    return pick(rng, lifted(file), 50, make)


def lift_copied(file, rng):
    """The number of another layer."""

    def make(found):
        index, z = way_of(file, found)
        top = max(file.lines[i].end[2] for i in index)
        return edited(file, {i: [with_z(file.lines[i].text, top + 0.137)] for i in index}) if (
            any("Z" in file.lines[i].text and file.lines[i].kind == "travel" for i in index)) else None

    return pick(rng, lifted(file), 50, make)


def with_f(text, feed):
    text = re.sub(r"\s*F[0-9.]+", "", text)
    return f"{text} F{number(feed)}"


def travel_slow(file, rng):
    travel = {line.feed for line in file.lines if line.kind == "travel"}

    def make(found):
        k, _, ways, _ = found
        feed = next((f for f in (file.lines[file.paths[k].last].feed, 1234) if f not in travel))
        follower = next(i for i in range(ways[-1] + 1, len(file.lines)) if file.lines[i].kind != "comment")
        return edited(file, {ways[-1]: [with_f(file.lines[ways[-1]].text, feed)],
                             follower: [f"G1 F{number(file.lines[ways[-1]].feed)}",
                                        file.lines[follower].text]})

    return pick(rng, links(file), 20, make)


def retraction_slow(file, rng):
    def make(found):
        _, pulls, _, _ = found
        i = pulls[0]
        return edited(file, {i: [with_f(file.lines[i].text, 777),
                                 f"G1 F{number(file.lines[i].feed)}"]})

    return pick(rng, links(file), 20, make)


def travel_acceleration(file, rng):
    def make(found):
        _, _, ways, _ = found
        i = ways[-1]
        setter = file.lines[i].state.get("M204")
        if setter is None:
            return None
        other = re.sub(r"([SPT])[0-9.]+", r"\g<1>333", setter)
        return edited(file, {i: [other, file.lines[i].text, setter]})

    return pick(rng, links(file), 20, make)


def wiped(file):
    for k in range(len(file.paths) - 1):
        if file.paths[k].section != file.paths[k + 1].section:
            continue
        wipes = [i for i in file.link(k) if file.lines[i].kind == "wipe" and file.lines[i].e < 0]
        if wipes:
            yield k, wipes


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


# --- commands --------------------------------------------------------------------------------------


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


# --- what is set, and what is said -----------------------------------------------------------------


def changed_number(file, rng, pattern):
    """One of the lines that match has another number: the first group."""

    def make(i):
        found = re.match(pattern, file.lines[i].text)
        value = number(float(found.group(1)) + 5)
        text = file.lines[i].text
        return edited(file, {i: [text[:found.start(1)] + value + text[found.end(1):]]})

    return pick(rng, [i for i, line in enumerate(file.lines) if re.match(pattern, line.text)], 1, make)


def temperature_changed(file, rng):
    return changed_number(file, rng, r"M(?:104|109|140|190) .*?S(\d+)")


def with_effect(file, pattern):
    """Lines that set something to another value than before, under which something is deposited."""
    before, pending = None, None
    for i, line in enumerate(file.lines):
        if re.match(pattern, line.text):
            text = line.text.split(";")[0].strip().replace("M107", "M106 S0")
            pending = i if before is not None and text != before else None
            before = text
        elif line.kind == "deposit" and pending is not None:
            yield pending
            pending = None


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
    """A comment that is not about the next path, its wipe or its size; some printer may read it."""
    of_paths = re.compile(r";\s*(?:TYPE|FEATURE|(?:LINE_)?WIDTH|(?:LAYER_)?HEIGHT|WIPE_\w+|reset$|tool |\'|[a-z ]+$)")
    notes = [i for i, line in enumerate(file.lines)
             if line.kind == "comment" and line.text[1:].strip() and not of_paths.match(line.text)]
    return pick(rng, notes, 1, lambda i: edited(file, {i: []}))


def dwell_dropped(file, rng):
    dwells = [i for i, line in enumerate(file.lines) if re.match(r"G4 [PS]\d*[1-9]", line.text)]
    return pick(rng, dwells, 1, lambda i: edited(file, {i: []}))


def deposit_faster(file, rng):
    """A path is begun at another feed rate."""

    def make(path):
        line = file.lines[path.first]
        text = re.sub(r"\s*F[0-9.]+", "", line.text.split(";")[0].rstrip())
        return edited(file, {path.first: [f"{text} F{number(line.feed * 1.25)}"]})

    return pick(rng, file.paths, 1, make)


def with_xy(text, point):
    for axis, value in zip("XY", point):
        text = re.sub(axis + r"-?[0-9.]+", axis + number(value), text)
    return text


# (name, rule, defect, the most daring policy under which it is one)
DEFECTS = (
    ("segment dropped", "same_print", drop_segment, "free"),
    ("path cut and printed apart", "whole_paths", cut_path, "free"),
    ("infill and its wall exchanged", "order", infill_before_wall, "free"),
    ("outer and inner wall exchanged", "order", walls_swapped, "balanced"),
    ("bridge before its anchor", "order", bridge_first, "free"),
    ("support and what it carries exchanged", "order", support_swapped, "free"),
    ("skirt last", "order", skirt_last, "free"),
    ("ironing before what it irons", "order", ironing_first, "free"),
    ("lines of a monotonic surface exchanged", "order", monotonic_swapped, "balanced"),
    ("outer loop reversed", "direction", outer_reversed, "balanced"),
    ("open wall reversed", "direction", open_wall_reversed, "balanced"),
    ("seam moved", "seam", seam_moved, "safe"),
    ("retraction dropped across a wall", "open_ways", retraction_dropped, "free"),
    ("filament back before a wall", "retractions", primed_early, "free"),
    ("lift dropped", "lifts", lift_dropped, "free"),
    ("lift halved", "lifts", lift_halved, "free"),
    ("lift behind the way", "lifts", lift_late, "free"),
    ("height copied from elsewhere", "lifts", lift_copied, "free"),
    ("retraction deeper by 0.8 mm", "retractions", retraction_deeper, "free"),
    ("retraction halved", "retractions", retraction_halved, "free"),
    ("blob of an amount of the file", "standstill", blob, "free"),
    ("travel at another speed", "speeds", travel_slow, "free"),
    ("retraction at another speed", "speeds", retraction_slow, "free"),
    ("travel under another acceleration", "speeds", travel_acceleration, "free"),
    ("wipe dropped", "wipes", wipe_dropped, "free"),
    ("wipe beside its path", "wipes", wipe_moved, "free"),
    ("command within a path", "commands", command_in_path, "free"),
    ("acceleration set and set back", "commands", set_and_back, "free"),
    ("M73 exchanged", "progress", progress_back, "free"),
    ("move of the start script", "scripts", from_script, "free"),
    ("move along a path's end dropped", "path_ends", tail_dropped, "free"),
    ("move along a path's end longer", "path_ends", tail_longer, "free"),
    ("temperature changed", "same_print", temperature_changed, "free"),
    ("acceleration lost", "same_print", acceleration_lost, "free"),
    ("fan late by a segment", "same_print", fan_late, "free"),
    ("layer higher", "same_print", layer_higher, "free"),
    ("arc turned", "same_print", arc_turned, "free"),
    ("extrusion doubled", "same_print", extrusion_doubled, "free"),
    ("labels of objects exchanged", "same_print", labels_exchanged, "free"),
    ("tools exchanged", "same_print", tools_exchanged, "free"),
    ("feature renamed", "same_print", feature_renamed, "free"),
    ("comment dropped", "same_print", comment_dropped, "free"),
    ("dwell dropped", "same_print", dwell_dropped, "free"),
    ("path at another speed", "same_print", deposit_faster, "free"),
)
