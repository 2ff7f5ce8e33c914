"""What must hold between a file and its optimised copy, each check by itself: check(before, after, options) -> faults.

A fault is one line of text that names the place in the optimised file. Every check compares with what the original did:
what it did wrong itself is no fault of the copy.
"""

import bisect
import collections
import math

CELL_MM = 0.5  # of the maps of heights and of what covers what
FINE_CELL_MM = 0.2  # lines of ironing lie closer than those of skin
ISLAND_CELLS_MM = (0.5, 0.7)  # islands in cells that touch count as one: from 0.5 mm apart on, never beyond 2 mm
HALF_WALL_MM = 0.2
END_ON_WALL_MM = 0.02  # beside what loops end short of their start
CROSSING_MM = 1e-9
MOVE_END_MM = 1.0  # a move leaves or comes to a wall of its own there
FINE_MM = 0.02
SCARF_MM = 0.5  # seams rise by less
REST_SLACK_S = 0.5  # travel into a layer changes a little where islands need no rest at all
SHARE_SLACK = 2.0  # points of a per cent
ACCEL = 3  # in print_trace.STATE
USUAL_ACCEL = 1000.0
ASIDE_MM = 12.0  # no slicer's own travel leads so far beyond the print, but from object to object
FARTHEST_MM = 10000.0  # from the origin: no head goes there, but a file may say so


def shares_inside(move):
    """The shares of a straight move between which it is no farther away than FARTHEST_MM along x and y, if any."""
    begin, end = 0.0, 1.0
    for a, b in ((move.x0, move.x1), (move.y0, move.y1)):
        if a == b:
            if abs(a) > FARTHEST_MM:
                return None
            continue
        low, high = sorted(((-FARTHEST_MM - a) / (b - a), (FARTHEST_MM - a) / (b - a)))
        begin, end = max(begin, low), min(end, high)
    return (begin, end) if begin <= end else None


def cells_of(move, size):
    """The cells of `size` mm that a straight move passes, in order, without repeats next to each other."""
    inside = shares_inside(move)
    if inside is None:
        return
    count = max(1, math.ceil(move.length * (inside[1] - inside[0]) / (size / 2)))
    last = None
    for i in range(count + 1):
        share = inside[0] + (inside[1] - inside[0]) * i / count
        cell = (math.floor((move.x0 + (move.x1 - move.x0) * share) / size),
                math.floor((move.y0 + (move.y1 - move.y0) * share) / size))
        if cell != last:
            yield cell
            last = cell


# ---------------------------------------------------------------------------------------------------------- deposits


def undirected(move):
    a = (round(move.x0, 3), round(move.y0, 3), round(move.z0, 3))
    b = (round(move.x1, 3), round(move.y1, 3), round(move.z1, 3))
    return (a, b) if a <= b else (b, a)


def deposits(before, after, options):
    """The same segments with the same filament under the same state; but a loop's gap may lie elsewhere on it."""
    kept = collections.defaultdict(list)
    for move in before.deposits():
        kept[undirected(move), move.state].append(move)
    extra = []
    for move in after.deposits():
        same = kept.get((undirected(move), move.state))
        match = next((i for i, other in enumerate(same or ()) if abs(other.e - move.e) < 1e-4), None)
        if match is None:
            extra.append(move)
        else:
            same.pop(match)
    lost = [move for moves in kept.values() for move in moves]
    yield from unmatched(lost, extra, options)


def unmatched(lost, extra, options):
    """What has no equal: pieces of loops that were closed elsewhere, in sum as long and with as much filament.

    A loop may change its width on the way: so its gap may go from lines of one state to lines of another.
    """
    by_state = collections.defaultdict(lambda: ([], []))
    for side, moves in enumerate((lost, extra)):
        for move in moves:
            by_state[move.state, round(max(move.z0, move.z1), 3)][side].append(move)
    heights = collections.defaultdict(lambda: [0.0, 0.0, 0])
    for (state, z), (gone, new) in by_state.items():
        mm = [sum(move.length for move in side) for side in (gone, new)]
        e = [sum(move.e for move in side) for side in (gone, new)]
        moves = max(len(gone), len(new))
        gap = options.loop_gap_mm
        for i, more in enumerate((mm[1] - mm[0], e[1] - e[0], moves)):
            heights[z][i] += more
        rate = max(e) / max(max(mm), 1e-9)
        gone_elsewhere = abs(e[1] - e[0] - rate * (mm[1] - mm[0]))
        if abs(mm[0] - mm[1]) > 2 * gap * moves or gone_elsewhere > 2e-2 * max(e) + 2e-4 * moves:
            where = (new or gone)[0]
            yield (f"deposits: at Z{z:g} under {describe(state)} {mm[0]:.2f} mm with {e[0]:.4f} of filament became "
                   f"{mm[1]:.2f} mm with {e[1]:.4f}; line {where.line} {'of the copy' if new else 'of the original'}")
            continue
        for move in new:
            if move.length > gap and not any(lies_on(move, other, gap + FINE_MM) for other in gone):
                yield f"deposits: line {move.line} prints where the original has nothing under {describe(state)}"
    for z, (mm, e, moves) in heights.items():
        if abs(mm) > FINE_MM + 2e-3 * moves or abs(e) > 2e-4 + 2e-5 * moves:
            which = "more" if mm + e > 0 else "less"
            yield f"deposits: at Z{z:g} {abs(mm):.2f} mm with {abs(e):.4f} of filament are {which}"


def describe(state):
    return ", ".join(str(word) for word in state if word != "") or "no state"


def lies_on(move, other, reach):
    """Both ends of `move` lie on `other`, or on its straight continuation by `reach`."""
    length = other.length or 1e-9
    dx, dy = (other.x1 - other.x0) / length, (other.y1 - other.y0) / length
    for x, y in ((move.x0, move.y0), (move.x1, move.y1)):
        along = (x - other.x0) * dx + (y - other.y0) * dy
        aside = abs((x - other.x0) * dy - (y - other.y0) * dx)
        if aside > 2 * reach or not -2 * reach <= along <= length + 2 * reach:
            return False
    return True


def filament(before, after, options):
    """Nothing is printed while filament is pulled back, and as much is pushed in the whole as before."""

    def starved(side):
        """What is lacking where lines deposit with filament pulled back: no more than each of them pushes."""
        pushed, lacking, lacks = collections.Counter(), {}, False
        for move in side.deposits():
            # A lack counts to its end, however many lines make up for it.
            lacks = move.retracted > (1e-4 if lacks else 0.02)
            if lacks:
                pushed[move.line] += move.e
                lacking[move.line] = move.retracted
        return sum(min(mm, lacking[line]) for line, mm in pushed.items())

    if starved(after) > starved(before) + 0.02:
        worst = next(move for move in after.deposits() if move.retracted > 0.02)
        yield f"filament: line {worst.line} prints with {min(worst.retracted, 99):.3f} mm pulled back"
    pushed = [sum(move.e for move in side.moves) for side in (before, after)]
    if abs(pushed[0] - pushed[1]) > 0.05 + 2e-5 * len(after.moves) ** 0.5:
        yield f"filament: {pushed[0]:.3f} mm in the whole became {pushed[1]:.3f}"


# ----------------------------------------------------------------------------------------------------------- obstacles


def collisions(side, printing=False):
    """{cell: [(depth, line)]}: where moves without deposits, or with `printing` any, lead below what is printed."""
    top, hits = {}, collections.defaultdict(list)
    for move in side.moves:
        if move.length and (printing or not move.deposits):
            z = min(move.z0, move.z1)
            for cell in cells_of(move, CELL_MM):
                depth = top.get(cell, z) - z
                if depth > 0.05:
                    hits[cell].append((depth, move.line))
        if move.deposits:
            z = max(move.z0, move.z1)
            for cell in cells_of(move, CELL_MM):
                if top.get(cell, -1.0) < z:
                    top[cell] = z
    return hits


def obstacles(before, after, options):
    """No travel leads through what stands, but where the original's head is as low."""
    old, new = collisions(before, printing=True), collisions(after)
    deeper = []
    for (x, y), passes in new.items():
        near = [depth for i in (-1, 0, 1) for j in (-1, 0, 1) for depth, _ in old.get((x + i, y + j), ())]
        deeper += [(depth, line) for depth, line in passes if depth > max(near, default=0) + 0.05]
    if deeper:
        depth, line = max(deeper)
        count = len({line for _, line in deeper})
        yield f"obstacles: {count} travel moves lead up to {depth:.2f} mm below what stands there; line {line}"


# ------------------------------------------------------------------------------------------------------------ coverage


def flows(side):
    """{z: what a full line of that height pushes, mm of filament a mm}."""
    usual = collections.defaultdict(list)
    for move in side.deposits():
        if move.length > 0.2:
            usual[round(move.z1, 3)].append(move.e / move.length)
    return {z: sorted(flows)[int((len(flows) - 1) * 0.98)] for z, flows in usual.items()}


def is_thin(move, full):
    return move.length > 0.2 and move.e / move.length < 0.15 * full[round(move.z1, 3)]


def ironing_of(side):
    """The thin deposits most of whose length lies upon full ones of the same height, where they cover an area: the
    filling of a narrow gap is thin, too."""
    full, printed, found = flows(side), set(), []
    for move in side.deposits():
        z = round(move.z1, 3)
        cells = [(cell, z) for cell in cells_of(move, FINE_CELL_MM)]
        if z in full and is_thin(move, full):
            if sum(cell in printed for cell in cells) > 0.5 * len(cells):
                found.append((move, cells))
        else:
            # A line is wider than a cell.
            printed.update(((x + i, y + j), z) for (x, y), z in cells for i in (-1, 0, 1) for j in (-1, 0, 1))
    return {identity(move) for region in regions(found) if covers_area(region) for move in region}


def regions(passes):
    """The moves of [(move, cells)] that lie side by side or end to end, as lists."""
    by_cell = collections.defaultdict(list)
    for i, (_, cells) in enumerate(passes):
        for cell in cells:
            by_cell[cell].append(i)
    left = set(range(len(passes)))
    while left:
        stack, region = [left.pop()], []
        while stack:
            move, cells = passes[stack.pop()]
            region.append(move)
            beside = {i for (x, y), z in cells for dx in (-1, 0, 1) for dy in (-1, 0, 1)
                      for i in by_cell.get(((x + dx, y + dy), z), ())} & left
            left -= beside
            stack += beside
        yield region


def covers_area(moves):
    """True if they go to and fro over a place, or around it."""
    xs, ys = [x for move in moves for x in (move.x0, move.x1)], [y for move in moves for y in (move.y0, move.y1)]
    return sum(move.length for move in moves) > 2 * math.hypot(max(xs) - min(xs), max(ys) - min(ys))


def identity(move):
    return undirected(move), round(move.e, 4)


def spoiled(side, ironing):
    """{(cell, z): line} of full deposits where ironing of the same height has passed before."""
    smooth, hits, full = set(), {}, flows(side)
    for move in side.deposits():
        z = round(move.z1, 3)
        cells = [(cell, z) for cell in cells_of(move, FINE_CELL_MM)]
        if identity(move) in ironing:
            smooth.update(cells)
        elif z not in full or not is_thin(move, full):  # ironing's lines at an edge lie upon little
            hits.update({cell: move.line for cell in cells if cell in smooth and cell not in hits})
    return hits


def ironing(before, after, options):
    """Nothing is printed upon what was ironed, beyond what the original does so."""
    known = ironing_of(before)
    if not known:
        return
    old, new = spoiled(before, known), spoiled(after, known)
    added = [line for place, line in new.items() if place not in old]
    if len(added) > max(4, 0.02 * len(old)):
        yield f"ironing: {len(added)} places are printed over after they were ironed; first line {min(added)}"


def distance(a, b):
    """Between two straight moves, each as ((x, y), (x, y))."""
    (p, q), (r, s) = a, b

    def side(o, u, v):
        return (u[0] - o[0]) * (v[1] - o[1]) - (u[1] - o[1]) * (v[0] - o[0])

    def to_point(o, u, v):
        square = (v[0] - u[0]) ** 2 + (v[1] - u[1]) ** 2
        t = ((o[0] - u[0]) * (v[0] - u[0]) + (o[1] - u[1]) * (v[1] - u[1])) / square if square else 0.0
        t = max(0.0, min(1.0, t))
        return math.hypot(o[0] - u[0] - t * (v[0] - u[0]), o[1] - u[1] - t * (v[1] - u[1]))

    if side(p, q, r) * side(p, q, s) < 0 and side(r, s, p) * side(r, s, q) < 0:
        return 0.0
    return min(to_point(p, r, s), to_point(q, r, s), to_point(r, p, q), to_point(s, p, q))


def points_along(move, step):
    """[(mm from its begin, (x, y))] on a straight move, with both ends."""
    count = max(1, math.ceil(move.length / step))
    return [(move.length * i / count, (move.x0 + (move.x1 - move.x0) * i / count,
                                       move.y0 + (move.y1 - move.y0) * i / count)) for i in range(count + 1)]


def beside(move, lines):
    """(mm at its begin, mm at its end) by which the move stays within half a width of `lines`; (0, 0) where all of it
    does."""
    away = [mm for mm, point in points_along(move, HALF_WALL_MM)
            if all(distance((point, point), line) >= HALF_WALL_MM for line in lines)]
    return (away[0], move.length - away[-1]) if away else (0.0, 0.0)


def meets(move, walls, on_wall_mm):
    """True if the move without its ends lies upon one of `walls`: {cell: [(move, loop)]}. It may leave a loop along it, or
    come to one so: what ends nearer than `on_wall_mm` to a loop ends on it."""
    def without(at_begin, at_end):
        x, y = (move.x1 - move.x0) / move.length, (move.y1 - move.y0) / move.length
        begin, end = max(at_begin, MOVE_END_MM), max(at_end, MOVE_END_MM)
        return ((move.x0 + begin * x, move.y0 + begin * y), (move.x1 - end * x, move.y1 - end * y))

    loops = collections.defaultdict(dict)
    for cx, cy in cells_of(move, CELL_MM):
        for wall, loop in (found for i in (-1, 0, 1) for j in (-1, 0, 1) for found in walls.get((cx + i, cy + j), ())):
            loops[loop][id(wall)] = ((wall.x0, wall.y0), (wall.x1, wall.y1))
    middle, ends = without(0.0, 0.0), ((move.x0, move.y0), (move.x1, move.y1))
    for lines in (list(of_loop.values()) for of_loop in loops.values()):
        nearest = min(distance(middle, line) for line in lines)
        if nearest < CROSSING_MM:
            return True
        if nearest >= HALF_WALL_MM:
            continue
        on_it = [any(distance((end, end), line) < on_wall_mm for line in lines) for end in ends]
        rest = without(*(mm if on else 0.0 for mm, on in zip(beside(move, lines), on_it)))
        if any(distance(rest, line) < HALF_WALL_MM for line in lines):
            return True
    return False


class PrintedLayer:
    """What is printed at one height, so far."""

    def __init__(self, height):
        self.height = height
        self.part = set()  # cells
        self.walls = {}  # {cell: [(move, loop)]}, outer ones
        self.loop = None
        self.end = None  # of the last outer wall

    def add(self, move):
        cells = list(cells_of(move, CELL_MM))
        if is_of_part(move.state):
            self.part.update(cells)
        if not is_outer(move.state):
            return
        if self.end != (move.x0, move.y0):
            self.loop = object()
        self.end = (move.x1, move.y1)
        for cell in cells:
            self.walls.setdefault(cell, []).append((move, self.loop))


def walls_and_tops(side, on_wall_mm):
    """(crossings, longest mm, mm over tops) of moves with an open nozzle upon outer walls, and over areas that nothing
    covers later. On the way to a layer these are its own walls: it covers those below."""
    tops = {}
    for move in side.deposits():
        for cell in cells_of(move, CELL_MM):
            tops[cell] = max(tops.get(cell, -1.0), round(move.z1, 3))
    crossings, over_top = [], 0.0
    below, layer = PrintedLayer(None), PrintedLayer(None)
    arriving, moves = [], []

    def look(moves, walls, upon):
        nonlocal over_top
        crossings.extend(move.length for move in moves if meets(move, walls, on_wall_mm))
        for move in moves:
            passed = list(cells_of(move, CELL_MM))[3:-3]
            over_top += CELL_MM * sum(1 for cell in passed if cell in upon.part and tops.get(cell) == upon.height)

    for move in side.moves:
        if not move.deposits:
            if move.length > 3 and move.retracted < 0.02 and move.e == 0:
                moves.append(move)
        elif round(move.z1, 3) == layer.height:
            look(moves, layer.walls, layer)
            layer.add(move)
            moves = []
        else:
            look(arriving, layer.walls, below)
            below, layer = layer, PrintedLayer(round(move.z1, 3))
            layer.add(move)
            arriving, moves = moves, []
    look(arriving, layer.walls, below)
    look(moves, layer.walls, layer)
    return len(crossings), max(crossings, default=0.0), over_top


def is_of_part(state):
    """What is thrown away shows nothing."""
    feature = str(state[7]).lower()
    return not any(word in feature for word in ("support", "skirt", "brim", "tower"))


def is_outer(state):
    feature = str(state[7]).lower()
    return any(word in feature for word in ("external", "outer"))


def stringing(before, after, options):
    """No more open travel across visible walls or over visible surfaces than in the original."""
    # A loop's end is beside its first side; the gap is half of what two ends may have between them.
    on_wall_mm = options.loop_gap_mm / 2 + END_ON_WALL_MM
    old, new = walls_and_tops(before, on_wall_mm), walls_and_tops(after, on_wall_mm)
    if new[0] > old[0] * 1.02 + 1:
        yield f"stringing: {old[0]} open moves across outer walls became {new[0]}"
    if new[1] > old[1] * 1.1 + 1:
        yield f"stringing: the longest open move across outer walls grew from {old[1]:.1f} to {new[1]:.1f} mm"
    if new[2] > old[2] * 1.1 + 20:
        yield f"stringing: open travel over tops grew from {old[2]:.0f} to {new[2]:.0f} mm"


# ---------------------------------------------------------------------------------------------------------------- rest


def layers_of(side):
    """Runs of deposits at one height, as lists of moves. A scarf seam, which rises to the height of its layer, is part of
    that, wherever in the layer it comes."""
    layers, rising, height = [], [], None
    for move in side.deposits():
        z = round(max(move.z0, move.z1), 3)
        if move.z0 < move.z1 and (height is None or not 0 <= height - z < SCARF_MM):
            rising.append(move)
            continue
        if move.z0 >= move.z1 and z != height:
            layers.append((z, []))
            height = z
        layers[-1][1].extend(rising + [move])
        rising = []
    return layers + ([(round(rising[-1].z1, 3), rising)] if rising else [])


def islands_of(moves, size):
    """Connected regions of cells of `size` mm: a list of (cells, first begin, last end)."""
    times = {}
    for move in moves:
        end = move.begin + move.seconds
        for cell in cells_of(move, size):
            first, last = times.get(cell, (move.begin, end))
            times[cell] = (min(first, move.begin), max(last, end))
    islands, left = [], set(times)
    while left:
        stack = [left.pop()]
        cells = set(stack)
        while stack:
            x, y = stack.pop()
            for cell in [(x + i, y + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]:
                if cell in left:
                    left.remove(cell)
                    cells.add(cell)
                    stack.append(cell)
        islands.append((cells, min(times[cell][0] for cell in cells), max(times[cell][1] for cell in cells)))
    return islands


def rests(side, size):
    """{(z, an island's least cell): (seconds, whether anything is printed)} between the end of what lies below an
    island and its begin."""
    found, below, begins = {}, {}, [move.begin for move in side.deposits()]
    for z, moves in layers_of(side):
        now = {}
        for cells, begin, end in islands_of(moves, size):
            under = [below[cell] for cell in cells if cell in below]
            if under:
                before, at = (bisect.bisect_left(begins, moment - 1e-6) for moment in (max(under), begin))
                found[z, min(cells)] = begin - max(under), at > before
            for cell in cells:
                now[cell] = end
        below = {**below, **now}
    return found


def rest(before, after, options):
    """No island rests shorter than it did or than the file's least layer time, under safe and balanced, however far apart
    islands may be to count as one. What the original prints twice running needs no rest."""
    if options.policy not in ("safe", "balanced"):
        return
    worst = None
    for size in ISLAND_CELLS_MM:
        old, new = rests(before, size), rests(after, size)
        for place, (seconds, _) in new.items():
            rested, others_between = old.get(place, (0.0, False))
            need = 0.95 * min(rested, options.least_layer_s) - REST_SLACK_S if others_between else 0.0
            if seconds < need and (worst is None or seconds - need < worst[0]):
                worst = (seconds - need, place, seconds, rested, size)
    if worst:
        yield (f"rest: at Z{worst[1][0]:g} an island rests {worst[2]:.1f} s, {worst[3]:.1f} s in the original; told apart by "
               f"cells of {worst[4]:g} mm")


# ------------------------------------------------------------------------------------------------------------ progress


def progress(before, after, options):
    """What a display is told comes in sequence, each share near where it is true."""
    kinds = {kind for _, kind, _, _ in before.progress}
    clocks = None
    for kind in sorted(kinds):
        old = [(value, now, line) for line, k, value, now in before.progress if k == kind]
        new = [(value, now, line) for line, k, value, now in after.progress if k == kind]
        if [value for value, _, _ in old] != [value for value, _, _ in new]:
            yield f"progress: the values of {kind} are not those of the original in its order"
            continue
        found = misplaced(kind, old, new, before.seconds, after.seconds)
        if found:
            clocks = clocks or [(clock(before), clock(after)) for clock in (nominal_clock, stopping_clock)]
            if all(misplaced_by(kind, old, new, was, now, after) for was, now in clocks):
                yield found


def misplaced_by(kind, old, new, was, now, after):
    """The same by two clocks; a line stands no nearer than where a path begins, or one of its moves ends."""
    told = [[(value, clock(line), line) for value, _, line in side] for side, clock in ((old, was), (new, now))]
    places = sorted({now(line) for move in after.deposits() for line in (move.line, move.line + 1)})
    return misplaced(kind, *told, was(None), now(None), places)


def nominal_clock(side):
    lines = [move.line for move in side.moves]
    moments = [move.begin for move in side.moves] + [side.seconds]
    return lambda line: moments[-1 if line is None else bisect.bisect_left(lines, line)]


def stopping_clock(side):
    """When a line comes, or the end, if each move begins and ends at a stop. Printers are between that and the nominal
    time."""
    lines, moments, now = [], [0.0], 0.0
    for move in side.moves:
        mm = math.hypot(move.length, move.z1 - move.z0)
        accel = float(move.state[ACCEL] or USUAL_ACCEL)
        speed = mm / move.seconds if move.seconds else 0.0
        if mm and speed * speed < accel * mm:
            now += move.seconds + speed / accel
        else:
            now += 2 * math.sqrt(mm / accel) if mm else move.seconds
        lines.append(move.line)
        moments.append(now)
    return lambda line: moments[-1 if line is None else bisect.bisect_left(lines, line)]


def misplaced(kind, old, new, old_seconds, new_seconds, places=()):
    """A fault, if there is one. What states no share is true where it was."""
    worst = (0.0, None)
    for (value, then, _), (_, now, line) in zip(old, new):
        was, share = 100 * then / old_seconds, 100 * now / new_seconds
        stated = value if isinstance(value, float) else was
        off = abs(stated - share) - abs(stated - was)
        if places:
            there = was / 100 * new_seconds
            at = bisect.bisect(places, there)
            off -= 100 * min(abs(place - there) for place in places[max(at - 1, 0):at + 1]) / new_seconds
        worst = max(worst, (off, (line, value, was, share)), key=lambda pair: pair[0])
    if worst[0] <= SHARE_SLACK:
        return None
    line, value, was, share = worst[1]
    return f"progress: {kind} says {value} at {share:.1f} % of the time, {was:.1f} % in the original; line {line}"


# -------------------------------------------------------------------------------------------------------------- labels


def labels(before, after, options):
    """Objects begin and end in pairs, where the original's do."""

    def faults(side):
        open_label, count = None, 0
        for _, name in side.labels:
            count += (name is None) == (open_label is None)
            open_label = name
        return count + (open_label is not None)

    if len(after.labels) > len(before.labels) or faults(after) > faults(before):
        yield f"labels: {len(before.labels)} with {faults(before)} unpaired became {len(after.labels)} with {faults(after)}"


# ------------------------------------------------------------------------------------------------------- head and tail


def head_and_tail(before, after, options):
    """What stands before the first and behind the last deposit is the original's, but for moves to and from them."""
    for name, pick in (("head", head_lines), ("tail", tail_lines)):
        old, new = pick(before), pick(after)
        if old != new:
            at = next((i for i, pair in enumerate(zip(old, new)) if pair[0] != pair[1]), min(len(old), len(new)))
            was = old[at] if at < len(old) else "nothing"
            now = new[at] if at < len(new) else "nothing"
            yield f"{name}: `{was}` became `{now}`"


def head_lines(side):
    deposit = next(iter(side.deposits()), None)
    return commands(side, 0, deposit.line if deposit else len(side.lines))


def tail_lines(side):
    last = side.deposits()[-1].line if side.deposits() else 0
    return commands(side, last, len(side.lines) + 1)


# Commands that belong to a path and come and go with it.
OF_PATHS = ("M204", "M205", "M201", "M203", "M566", "M207", "M215", "SET_VELOCITY_LIMIT", "M900", "M572", "M233",
            "SET_PRESSURE_ADVANCE", "M221", "M220", "M593", "SET_INPUT_SHAPER", "SET_FAN_SPEED", "M106", "M107", "M73",
            "M117", "M118", "M532", "SET_DISPLAY_TEXT", "M486", "M624", "M625", "EXCLUDE_OBJECT", "@")


def commands(side, first, end):
    return [text for line, text in side.commands if first < line < end and not text.startswith(OF_PATHS)]


# --------------------------------------------------------------------------------------------------- lifts and wipes


def low_travel(side):
    """(low, all, a line) of retracted travel of 2 mm and more within a layer; low is what is no higher than what was
    printed last. On the way to the next layer the head is as high as that."""
    low, count, line, height, travel = 0, 0, 0, 0.0, []
    for move in side.moves:
        if move.deposits:
            if abs(max(move.z0, move.z1) - height) < 0.01:
                lows = [other.line for other in travel if min(other.z0, other.z1) < height + 0.05]
                low, count, line = low + len(lows), count + len(travel), lows[-1] if lows else line
            height, travel = max(move.z0, move.z1), []
        elif move.length > 2 and move.retracted > 0.02 and move.e == 0:
            travel.append(move)
    return low, count, line


def lifts(before, after, options):
    """Travel that is retracted stays as high above the print as such travel of the file is."""
    (old, old_count, _), (new, new_count, line) = low_travel(before), low_travel(after)
    if new > 1.1 * old * max(1.0, new_count / max(old_count, 1)) + 2:
        yield f"lifts: {old} retracted moves at the height of the print became {new}; line {line}"


def wiped(side):
    moves = [move for move in side.moves if move.length or move.e]  # a line may set the speed alone
    return sum(1 for a, b in zip(moves, moves[1:]) if a.e < 0 < a.length and not (b.e < 0 < b.length))


def layer_ends(side):
    """(layers, those of them that are left with a wipe)."""
    count, with_wipe, height, wipes_since = 0, 0, None, False
    for move in side.moves:
        if move.deposits:
            at = max(move.z0, move.z1)
            if height is not None and abs(at - height) > 0.01:
                count, with_wipe = count + 1, with_wipe + wipes_since
            height, wipes_since = at, False
        elif move.e < 0 < move.length:
            wipes_since = True
    return count, with_wipe


def wipes(before, after, options):
    """Paths that were wiped stay so, unless that is given away. A file that leaves its layers without a wipe leaves
    them so whichever path is the last."""
    old, new = wiped(before), wiped(after)
    layers, with_wipe = layer_ends(before)
    if options.keeps_wipes and new < 0.98 * old - 1 - (layers if with_wipe == 0 else 0):
        yield f"wipes: {old} wipes that pull filament back along a path became {new}"


# ------------------------------------------------------------------------------------------------------------- scripts


def excursions(side):
    """Where the head is led far beyond all that is printed so far, and back, on the way to a higher layer."""
    least, most, height, led, found = [math.inf] * 2, [-math.inf] * 2, None, [], []
    for move in side.moves:
        end = (round(move.x1, 3), round(move.y1, 3))
        if not move.deposits:
            if move.length:
                led.append(end)
            continue
        if height is not None and move.z0 > height + FINE_MM:
            found += [place for place in led[:-1] if any(
                place[axis] < least[axis] - ASIDE_MM or place[axis] > most[axis] + ASIDE_MM for axis in (0, 1))]
        height, led = move.z1, []
        least, most = list(map(min, least, end)), list(map(max, most, end))
    return found


def asides(before, after, options):
    """Scripts that park the head or clean the nozzle between layers still do."""
    old, new = excursions(before), excursions(after)
    if old != new:
        yield f"asides: between layers the head was led far beyond the print and back to {len(old)} places, now to {len(new)}"


ALL = {check.__name__: check for check in (deposits, filament, obstacles, ironing, rest, progress, labels, head_and_tail,
                                           lifts, wipes, asides)}
# Where filament stays in the nozzle on purpose, this says how much of it may show.
ALL["stringing"] = stringing
