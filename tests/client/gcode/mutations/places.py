"""Where in a file a defect can be put: walls, links between paths, lifts, wipes, settings."""

import math
import re


WALLS = ("perimeter", "wall")
OUTER = ("external perimeter", "outer wall", "wall-outer", "overhang")


def is_wall(path):
    return any(name in path.type.lower() for name in WALLS)


def is_outer(path):
    return any(name in path.type.lower() for name in OUTER)


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


def steady(file, path):
    first = file.lines[path.first]
    return path.plain and all(file.lines[i].feed == first.feed and file.lines[i].state == first.state
                              for i in path.deposits)


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


def long_way(file, found):
    _, _, ways, _ = found
    return sum(file.lines[i].length() for i in ways) > 3


def wiped(file):
    for k in range(len(file.paths) - 1):
        if file.paths[k].section != file.paths[k + 1].section:
            continue
        wipes = [i for i in file.link(k) if file.lines[i].kind == "wipe" and file.lines[i].e < 0]
        if wipes:
            yield k, wipes


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


def down_of(file, found):
    """The move down in front of the priming behind the way."""
    _, _, ways, pushes = found
    return next((i for i in range(ways[-1] + 1, pushes[0])
                 if file.lines[i].kind == "z" and file.lines[i].end[2] < file.lines[i].start[2] - 0.05), None)


def lifted_links(file):
    return [found for found in links(file)
            if max(file.lines[i].end[2] for i in found[2]) > file.paths[found[0] + 1].start[2] + 0.05]


def lines_of(file, pattern, first=0, end=None):
    found = re.compile(pattern) if isinstance(pattern, str) else pattern
    return [i for i in range(first, len(file.lines) if end is None else end)
            if found.match(file.lines[i].text)]


def level(file, found):
    """The whole way lies at the height of both paths."""
    k, pulls, ways, pushes = found
    z = file.paths[k].start[2]
    return file.paths[k + 1].start[2] == z and all(
        file.lines[i].start[2] == file.lines[i].end[2] == z for i in range(pulls[0], pushes[-1] + 1)
        if file.lines[i].kind != "comment" and file.lines[i].kind != "command")
