"""Where the head of a print leads into what stands: by distances to the segments printed before."""

import collections
import math

BUCKET = 4.0
NEAR = 0.2        # of a line's middle: half of its width, or less
WAS_THERE = 0.5   # of the original's head: what the product promises
HIGHER = 0.08
STEP = 0.1


class Segments:
    def __init__(self):
        self.buckets = collections.defaultdict(list)

    def add(self, a, b, low, high):
        n = max(1, int(math.dist(a, b) / BUCKET * 2))
        seen = set()
        for i in range(n + 1):
            x, y = a[0] + (b[0] - a[0]) * i / n, a[1] + (b[1] - a[1]) * i / n
            for dx in (-1, 0, 1):
                for dy in (-1, 0, 1):
                    seen.add((int(x // BUCKET) + dx, int(y // BUCKET) + dy))
        for key in seen:
            self.buckets[key].append((a, b, low, high))

    def near(self, p, reach):
        for a, b, low, high in self.buckets.get((int(p[0] // BUCKET), int(p[1] // BUCKET)), ()):
            dx, dy = b[0] - a[0], b[1] - a[1]
            length = dx * dx + dy * dy
            t = 0 if length == 0 else max(0, min(1, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length))
            if math.hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy) <= reach:
                yield low, high


def moves_of(text):
    """(line, from, to, deposits): points have x, y, z; for texts of absolute moves with relative E."""
    at = (0.0, 0.0, 0.0)
    for number, line in enumerate(text.splitlines(), 1):
        words = line.split(";")[0].split()
        if not words or words[0] not in ("G0", "G1"):
            continue
        values = {w[0]: float(w[1:]) for w in words[1:]}
        to = tuple(values.get(axis, old) for axis, old in zip("XYZ", at))
        if to != at:
            yield number, at, to, values.get("E", 0) > 0
        at = to


def passes(text):
    """The moves, cut where the height of what is printed goes down, with the travel to what follows."""
    done, waiting, height = [[]], [], 0.0
    for move in moves_of(text):
        if not move[3]:
            waiting.append(move)
            continue
        if move[2][2] < height - 1e-6:
            done.append([])
        height = move[2][2]
        done[-1] += waiting + [move]
        waiting = []
    done[-1] += waiting
    return done


def into_what_stands(original, other):
    """(line, how far below the top) of moves of `other`, where none of `original` leads."""
    standing = Segments()
    found = []
    theirs = passes(other)
    ours = passes(original)
    if len(ours) != len(theirs):
        return [(0, 0.0)]
    for was, now in zip(ours, theirs):
        visited = Segments()
        known = set()
        for _, a, b, _ in was:
            known.add((a, b))
            visited.add(a[:2], b[:2], min(a[2], b[2]), max(a[2], b[2]))
        for line, a, b, deposits in now:
            if deposits or (a, b) in known:
                continue
            worst = 0.0
            n = max(1, int(math.dist(a[:2], b[:2]) / STEP))
            for i in range(n + 1):
                p = tuple(u + (v - u) * i / n for u, v in zip(a, b))
                z = min(a[2], b[2]) if a[:2] == b[:2] else p[2]
                above = max((high for _, high in standing.near(p, NEAR)), default=0) - z
                if above > max(HIGHER, worst) and not any(high <= z + 0.01 for _, high in visited.near(p, WAS_THERE)):
                    worst = above
            if worst:
                found.append((line, worst))
        for _, a, b, deposits in now:
            if deposits:
                standing.add(a[:2], b[:2], b[2], b[2])
    return found
