"""A sliced file as a list of lines with what each of them does, to put defects into.

Extrusion is made relative, so that lines can be moved about. This reader is for tests alone: it knows
neither the product's reader nor its verifier.
"""

import lzma
import math
import re

WORD = re.compile(r"([A-Za-z])\s*([-+]?[0-9]*\.?[0-9]+)?")
TYPE = re.compile(r"^; ?(?:TYPE|FEATURE): ?(.*)$")
SETTERS = ("M204", "M205", "M106", "M107", "SET_VELOCITY_LIMIT")


def number(value, digits=5):
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


class Line:
    """One line: `text`, and for moves where from and to, filament, feed and the state in force."""

    __slots__ = ("text", "kind", "start", "end", "e", "feed", "type", "state", "wipe", "way_feed")

    def __init__(self, text):
        self.text = text
        self.kind = "other"  # deposit, travel, z, retract, prime, wipe, feed, comment, command
        self.start = self.end = (0.0, 0.0, 0.0)
        self.e = 0.0
        self.feed = 0.0
        self.type = ""
        self.state = {}
        self.wipe = False
        self.way_feed = 0.0  # of the last travel up to here

    def length(self):
        return math.dist(self.start[:2], self.end[:2])


class Path:
    """Lines first..last of a file, which print one path in one go."""

    def __init__(self, first, last, lines):
        self.first, self.last = first, last
        self.deposits = [i for i in range(first, last + 1) if lines[i].kind == "deposit"]
        self.start = lines[first].start
        self.end = lines[last].end
        self.type = lines[first].type
        self.section = 0
        self.points = [self.start[:2]] + [lines[i].end[:2] for i in self.deposits]
        self.plain = all(lines[i].kind == "deposit" and re.match(r"G1\b", lines[i].text)
                         for i in range(first, last + 1))

    def closed(self):
        return len(self.points) > 3 and math.dist(self.points[0], self.points[-1]) < 0.13


class Sliced:
    def __init__(self, text):
        self.lines = []
        texts = text.split("\n")
        if not any(line.startswith(("M82", "M83")) for line in texts):
            texts.insert(0, "M82")
        self._read(texts)
        self.paths = self._paths()

    def _read(self, texts):
        at, e, feed = [0.0, 0.0, 0.0], 0.0, 0.0
        relative, relative_e = False, False
        kind_of, state, wipe, way_feed = "", {}, False, 9000.0
        for text in texts:
            text = text.rstrip("\r")
            code = text.split(";")[0].strip()
            line = Line(text)
            line.start = tuple(at)
            first = code.split(" ")[0] if code else ""
            if not code:
                line.kind = "comment"
                named = TYPE.match(text)
                if named:
                    kind_of = named.group(1).strip()
                if "WIPE_START" in text:
                    wipe = True
                elif "WIPE_END" in text:
                    wipe = False
                for key in ("TYPE:", "WIDTH:", "HEIGHT:", "FEATURE:"):
                    if text.startswith((";" + key, "; " + key, "; LINE_" + key, "; LAYER_" + key)):
                        state = {**state, text.split(":")[0]: text}
            elif re.fullmatch(r"G[0-3]", first) and not relative:
                words = {k.upper(): float(v or 0) for k, v in WORD.findall(code)[1:]}
                at = [words.get(axis, old) for axis, old in zip("XYZ", at)]
                feed = words.get("F", feed)
                if "E" in words:
                    line.e = words["E"] if relative_e else words["E"] - e
                    e = e + words["E"] if relative_e else words["E"]
                    if not relative_e:
                        line.text = re.sub(r"E\s*[-+]?[0-9]*\.?[0-9]+", "E" + number(line.e), text)
                line.end = tuple(at)
                line.kind = self._kind(line, first, wipe)
            elif first in ("M82", "M83"):
                relative_e = first == "M83"
                line.text = "M83"
            elif first in ("G90", "G91"):
                relative = first == "G91"
            elif first == "G92":
                words = dict(WORD.findall(code)[1:])
                if "E" in words:
                    e = float(words["E"] or 0)
                    line.text = ";reset" if len(words) == 1 else text
            else:
                line.kind = "command"
                if first in SETTERS:
                    key = "M106" if first == "M107" else first
                    fan = re.search(r" P(\d+)", code)
                    state = {**state, key + fan.group(1) if key == "M106" and fan else key: text}
            line.end = tuple(at)
            if line.kind == "travel" and feed:
                way_feed = feed
            line.feed, line.type, line.state, line.wipe, line.way_feed = feed, kind_of, state, wipe, way_feed
            self.lines.append(line)

    @staticmethod
    def _kind(line, first, wipe):
        sideways = line.start[:2] != line.end[:2]
        if sideways and line.e > 0:
            return "deposit"
        if sideways:
            return "wipe" if wipe or line.e < 0 else "travel"
        if line.e != 0:
            return "prime" if line.e > 0 else "retract"
        if first in ("G2", "G3"):
            return "z"
        return "z" if line.start[2] != line.end[2] else "feed"

    def _paths(self):
        paths, first, last, section = [], None, None, 0
        begun = not any(self.is_layer(line.text) for line in self.lines)
        for i, line in enumerate(self.lines):
            if line.kind == "deposit":
                if first is None:
                    first = i
                last = i
                continue
            begun |= self.is_layer(line.text)
            fence = (line.kind == "other" and line.text != ";reset") or self._is_fence(line)
            if fence or line.kind in ("travel", "wipe", "retract", "prime", "z"):
                if first is not None and begun:
                    paths.append(Path(first, last, self.lines))
                    paths[-1].section = section
                first = None
            section += fence
        return paths

    @staticmethod
    def is_layer(text):
        return text.startswith((";LAYER", "; CHANGE_LAYER", "; layer ", ";layer:", "; BEGIN_LAYER"))

    def _is_fence(self, line):
        if line.kind == "comment":
            return self.is_layer(line.text) or "printing object" in line.text or ";MESH" in line.text
        return line.kind == "command" and not line.text.startswith(SETTERS + ("M73",))

    def text(self):
        return "\n".join(line.text for line in self.lines)

    def link(self, k):
        """The lines between paths k and k + 1."""
        return range(self.paths[k].last + 1, self.paths[k + 1].first)


def read(path):
    opener = lzma.open if path.endswith(".xz") else open
    with opener(path, "rt", encoding="latin-1", newline="\n") as file:
        return file.read()
