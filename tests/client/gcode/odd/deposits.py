"""What a file deposits, by a simulation that knows neither the product's reader nor its verifier."""

import collections
import math
import re

WORD = re.compile(r"([A-Za-z])\s*([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))")


# What the simulation follows; other lines have to stay where they are among the runs.
FOLLOWED = re.compile(r"(?:G(?:0|1|2|3|10|11|17|18|19|20|21|90|91|92)|M(?:82|83|106|107|204|221|73|104|105|117|118)|T\d+)"
                      r"(?![0-9.])", re.IGNORECASE)


def deposits(data, deleted=False):
    """Runs of equal height, each a multiset of what is deposited there; between them, lines that are
    not followed, and where the head is. Lines behind a slash are done, or not: `deleted`."""
    text = data.decode("utf-8", "replace").lstrip("\ufeff")
    at, e, unit = [0.0, 0.0, 0.0], 0.0, 1.0
    relative = relative_e = False
    offset = [0.0] * 3  # machine position less what the words say
    pulled, tool, pulled_by_firmware = 0.0, 0, False
    runs = []
    for line in re.split(r"[\r\n]+", text):
        line = re.sub(r"\([^)]*\)", "", line.split(";")[0] if "(" not in line.split(";")[0] else
                      re.sub(r"\([^)]*\)", "", line).split(";")[0]).split("*")[0]
        line = line.strip(" \t\v\f")
        if line.startswith("/"):
            runs.append((line, []))
            if deleted:
                continue
            line = line[1:].strip()
        bare = re.sub(r"^[Nn]\d+\s*", "", line)
        bare = re.sub(r"^([GMTgmt])0+(?=\d)", r"\1", bare)
        if bare and not FOLLOWED.match(bare):
            # Marks of objects stay in their order, wherever the head is.
            label = bare.startswith(("M624", "M625", "M486", "EXCLUDE_OBJECT"))
            runs.append((bare, None if label else tuple(round(v, 3) for v in at), []))
            continue
        words = [(letter.upper(), float(value)) for letter, value in WORD.findall(line)]
        if words and words[0][0] == "N":
            words = words[1:]
        if not words:
            continue
        (letter, value), words = words[0], dict(words[1:])
        code = f"{letter}{value:g}"
        if code in ("G90", "G91"):
            relative = code == "G91"
        elif code in ("M82", "M83"):
            relative_e = code == "M83"
        elif code in ("G20", "G21"):
            unit = 25.4 if code == "G20" else 1.0
        elif letter == "T":
            tool = value
        elif code in ("G10", "G11") and not words:
            pulled_by_firmware = code == "G10"
        elif code == "G92":
            for i, axis in enumerate("XYZ"):
                if axis in words:
                    offset[i] = at[i] - words[axis] * unit
            if "E" in words:
                e = words["E"] * unit
        elif code in ("G0", "G1", "G2", "G3"):
            to = list(at)
            for i, axis in enumerate("XYZ"):
                if axis in words:
                    to[i] = (at[i] if relative else offset[i]) + words[axis] * unit
            filament = 0.0
            if "E" in words:
                filament = words["E"] * unit if relative or relative_e else words["E"] * unit - e
                e = e + filament
            sideways = math.dist(at[:2], to[:2]) > 1e-9 or code in ("G2", "G3")
            if sideways and filament > 1e-9:
                note(runs, at, to, filament, code, words, unit, tool,
                     pulled > 1e-4 or pulled_by_firmware)
            elif filament:
                pulled = max(0.0, pulled - filament)
            at = to
    return runs


def note(runs, at, to, filament, code, words, unit, tool, retracted):
    shape = ()
    if code in ("G2", "G3"):
        if "R" in words:
            shape = ("R", round(words["R"] * unit, 2))
        else:
            shape = (round(at[0] + words.get("I", 0) * unit, 2), round(at[1] + words.get("J", 0) * unit, 2))
    a, b = (tuple(round(v * 200) for v in p[:2]) for p in (at, to))
    turn = code if a <= b or not shape else {"G2": "G3", "G3": "G2"}[code]
    z = round(to[2], 3)
    if not runs or runs[-1][0] != z:
        runs.append((z, []))
    runs[-1][-1].append((min(a, b), max(a, b), turn if shape else "", shape, tool, retracted, filament))


def same(one, other):
    """Whether two files deposit the same, but for rounding."""
    if [run[:-1] for run in one] != [run[:-1] for run in other]:
        for run, other_run in zip(one, other):
            if run[:-1] != other_run[:-1]:
                return f"heights or lines differ: {run[:-1]}, {other_run[:-1]}"
        return "one has more heights or lines"
    for (z, a), (_, b) in [(run[::len(run) - 1], other_run[::len(run) - 1]) for run, other_run in zip(one, other)]:
        if len(a) != len(b):
            return f"{len(a)} segments at {z}, and {len(b)}"
        left = collections.defaultdict(list)
        for segment in b:
            left[key(segment)].append(segment)
        for segment in a:
            near = [(abs(other[-1] - segment[-1]), k, i) for k in neighbours(segment)
                    for i, other in enumerate(left.get(k, ()))]
            if not near or min(near)[0] > 2e-4:
                return f"at {z}: {segment} is not deposited"
            _, found, i = min(near)
            del left[found][i]
    return None


def key(segment):
    return segment[:2] + segment[2:3] + (segment[4], segment[5])


def neighbours(segment):
    (ax, ay), (bx, by) = segment[:2]
    steps = (0, -1, 1)
    for da in steps:
        for db in steps:
            for dc in steps:
                for dd in steps:
                    yield ((ax + da, ay + db), (bx + dc, by + dd), segment[2], segment[4], segment[5])
