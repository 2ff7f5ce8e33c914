"""Plates printed object by object, with what stands in the way: a print as moves, and its text."""

import math

LAYER = 0.4
LIFT_ABOVE = 0.6


def polygon(points):
    return points + [points[0]]


def box(x, y, w, d):
    return polygon([(x, y), (x + w, y), (x + w, y + d), (x, y + d)])


def tower(x, y, rng):
    w, d = rng.uniform(3, 9), rng.uniform(3, 9)
    return [box(x - w / 2, y - d / 2, w, d)]


def lines_about(x, y, least, most, count, rng):
    """Short lines of infill around a point, by their angle: travel from one to the next leads round."""
    lines = []
    for k in range(count):
        angle = 2 * math.pi * (k + rng.uniform(-0.2, 0.2)) / count
        r = rng.uniform(least, most)
        px, py = x + r * math.cos(angle), y + r * math.sin(angle)
        turn = rng.uniform(0, 2 * math.pi)
        lines.append([(px, py), (px + 1.5 * math.cos(turn), py + 1.5 * math.sin(turn))])
    return lines


def ring(x, y, radius, rng):
    sides = rng.randint(8, 14)
    angles = [2 * math.pi * k / sides for k in range(sides)]
    return polygon([(x + radius * math.cos(a), y + radius * math.sin(a)) for a in angles])


def horseshoe(x, y, rng):
    """A concave wall that opens to one side, with the point in its mouth."""
    w, t = rng.uniform(12, 18), 3
    shape = [(-w, -w), (w, -w), (w, -w + t), (-w + t, -w + t), (-w + t, w - t), (w, w - t), (w, w), (-w, w)]
    turns = rng.randint(0, 3)
    for _ in range(turns):
        shape = [(-b, a) for a, b in shape]
    return polygon([(x + a, y + b) for a, b in shape])


def objects(rng):
    """Lists of closed and open paths, one for each object, with its number of layers."""
    made = []
    x, y = 60.0, 60.0
    for _ in range(rng.randint(1, 2)):
        kind = rng.choice(("two_sides", "ring", "horseshoe", "merged", "towers"))
        tall = rng.randint(6, 12)
        if kind == "towers":
            spots = [(x + dx, y + dy) for dx in (-12, 0, 12) for dy in (-10, 10)]
            for px, py in rng.sample(spots, rng.randint(2, 4)):
                made.append(("tower", tower(px, py, rng), rng.randint(2, tall)))
        else:
            made.append(("tower", tower(x, y, rng), tall))
        around = lines_about(x, y, 9, 17, rng.randint(6, 12), rng)
        if kind == "two_sides":
            left = [p for p in around if p[0][0] < x]
            right = [p for p in around if p[0][0] >= x]
            paths = left + right
        elif kind == "ring":
            paths = [ring(x, y, rng.uniform(18, 22), rng)] + around
        elif kind == "horseshoe":
            paths = [horseshoe(x, y, rng)] + around
        elif kind == "merged":
            # Up against the tower's side.
            side = max(p[0] for p in made[-1][1][0])
            paths = [box(side + 0.45, y - 8, 8, 16)] + around
        else:
            paths = around
        made.append(("object", paths, rng.randint(2, 6)))
        x += 90
    return made


class Plate:
    """Moves: (kind, from, to, layer mark or None); kinds are print, travel, retract, prime."""

    def __init__(self, rng, style):
        self.rng, self.style = rng, style
        self.lines = []
        self.standing = []  # (box of an object, its top)
        self.at = (0.0, 0.0)
        self.z = 0.0
        self.crossed = 0

    def write(self, text):
        self.lines.append(text)

    def to_height(self, z):
        self.write(f"G1 Z{z:.3f} F9000")
        self.z = z

    def go(self, to):
        self.write(f"G1 X{to[0]:.3f} Y{to[1]:.3f} F9000")
        self.at = to

    def top_between(self, a, b):
        top = 0.0
        for (x0, y0, x1, y1), z in self.standing:
            n = max(2, int(math.dist(a, b) / 0.2))
            for i in range(n + 1):
                px, py = a[0] + (b[0] - a[0]) * i / n, a[1] + (b[1] - a[1]) * i / n
                if x0 - 3 <= px <= x1 + 3 and y0 - 3 <= py <= y1 + 3:
                    top = max(top, z)
                    break
        return top

    def travel(self, to, through=None):
        """Above what stands between, where the style is to; `through`: the travel that is not lifted."""
        self.write("G1 E-.8 F2100")
        z, top = self.z, self.top_between(self.at, to)
        if top > z and self.style != "careless":
            self.crossed += 1
            if through != self.crossed:
                self.to_height(top + LIFT_ABOVE)
        self.go(to)
        if self.z != z:
            self.to_height(z)
        self.write("G1 E.8 F2100")

    def layer(self, z, paths, first, through):
        self.write(";LAYER_CHANGE")
        self.write(f";Z:{z:.2f}")
        self.write(f";HEIGHT:{LAYER}")
        if not first:
            self.to_height(z)
        for path in paths:
            if first:
                # From one object to the next it goes above all.
                self.write("G1 E-.8 F2100")
                self.to_height(max([t for _, t in self.standing] + [z]) + 2)
                self.go(path[0])
                self.to_height(z)
                self.write("G1 E.8 F2100")
                first = False
            else:
                self.travel(path[0], through)
            closed = path[0] == path[-1]
            self.write(";TYPE:External perimeter" if closed else ";TYPE:Internal infill")
            self.write(";WIDTH:0.45")
            self.write("G1 F1800")
            for a, b in zip(path, path[1:]):
                self.write(f"G1 X{b[0]:.3f} Y{b[1]:.3f} E{math.dist(a, b) * 0.0374 + 0.00001:.5f}")
            self.at = path[-1]


def text_of(seed_rng, style, through=None):
    """The text of a plate and how many of its travel moves lead over something."""
    plate = Plate(seed_rng, style)
    for line in ("; generated by PrusaSlicer 2.9.2 on 2026-01-01 at 00:00:00 UTC", "M201 X1500 Y1500 Z200 E5000",
                 "M203 X200 Y200 Z12 E120", "M204 P1250 R1250 T1250", "G28", "G90", "G21", "M83", "G92 E0.0"):
        plate.write(line)
    for number, (_, paths, layers) in enumerate(objects(seed_rng)):
        plate.write(f"; printing object o{number} id:{number} copy 0")
        if style == "shuffled":
            order = seed_rng.sample(paths, len(paths))
        else:
            order = paths
        for layer in range(layers):
            plate.layer(LAYER * (layer + 1), order, layer == 0, through)
        xs = [p[0] for path in paths for p in path]
        ys = [p[1] for path in paths for p in path]
        if len(paths) == 1:
            plate.standing.append(((min(xs), min(ys), max(xs), max(ys)), LAYER * layers))
        plate.write(f"; stop printing object o{number} id:{number} copy 0")
    plate.to_height(plate.z + 20)
    plate.write("G1 E-2 F2100")
    plate.write("M107")
    plate.write("M84")
    if seed_rng.random() < 0.3:
        plate.write("; extruder_clearance_radius = 20")
    return "\n".join(plate.lines) + "\n", plate.crossed
