"""What a printer does with a G-code file: its deposits and moves, in order, with the state they are printed under.

Written for judge.py alone, and apart from the product: it shares no code with the reader, the writer or the verifier, and
it decides as little as it can. Arcs are cut into chords of at most half a millimetre, the same from both ends.

Units: mm, seconds, mm/s. Times are nominal: length by feed rate, without acceleration.
"""

import collections
import dataclasses
import math
import re

WORD = re.compile(r"([A-Z])\s*(-?\+?(?:\d+\.?\d*|\.\d+))")
CODE = re.compile(r"[GMT]\d+(?:\.\d+)?", re.I)  # words may follow without a blank
FIRST = re.compile(r"\S+")
NUMBERED = re.compile(r"\s*N\d+\s+|\s*\*\s*\d+\s*$", re.I)  # a line's number and check, of which hosts have no use
NAMED = re.compile(r"(\w+)=('[^']*'|\"[^\"]*\"|\S+)")
FEATURE = re.compile(r";\s*(?:TYPE|FEATURE):\s*(.+)")
# Comments that say which object is printed: (pattern, whether it begins one).
LABELS = (
    (re.compile(r";\s*printing object (.+)"), True),
    (re.compile(r";\s*stop printing object"), False),
    (re.compile(r";\s*start printing object, unique label id: (.+)"), True),
    (re.compile(r";MESH:(.+)"), True),
    (re.compile(r";PRINTING:(.+)"), True),
)
HOST_LABEL = re.compile(r"@(?:OBJECT|EXCLUDEREGION)\b\s*(.*)", re.I)
NO_OBJECT = ("", "none", "end", "stop", "off", "disable")
# What a display, or a host, is told: (kind, pattern, whether the value is a share in per cent).
TOLD = (
    ("M73", re.compile(r"M73\b.*?\bP(\d+)"), True),
    ("M532", re.compile(r"M532\b.*?\bX(\d+(?:\.\d+)?)"), True),
    ("a share in a message", re.compile(r"(?:M11[78]|SET_DISPLAY_TEXT)\b.*?(\d+(?:\.\d+)?)\s*%"), True),
    ("a time in a message", re.compile(r"(?:M11[78]|SET_DISPLAY_TEXT)\b.*(?:left|remain\w*|elapsed)\D*(\d.*)", re.I), False),
    ("a layer in a message", re.compile(r"(?:M11[78]|SET_DISPLAY_TEXT)\b.*?(\d+\s*(?:/|of)\s*\d+)", re.I), False),
    ("a time in a comment", re.compile(r";\s*(?:TIME_ELAPSED|PRINTING_TIME|REMAINING_TIME):\s*(.+)"), False),
    ("a layer in a comment", re.compile(r";\s*layer num/total\w*:\s*(.+)", re.I), False),
)


@dataclasses.dataclass(slots=True)
class Move:
    """One straight move. A deposit has e > 0 and length > 0; `state` names what it is printed under."""

    line: int
    x0: float
    y0: float
    z0: float
    x1: float
    y1: float
    z1: float
    e: float  # filament pushed; below 0 pulled back
    begin: float  # seconds since the start of the file
    seconds: float
    retracted: float  # filament that is pulled back before the move
    state: tuple

    @property
    def length(self):
        return math.hypot(self.x1 - self.x0, self.y1 - self.y0)

    @property
    def deposits(self):
        return self.e > 0 and (self.x0 != self.x1 or self.y0 != self.y1)


@dataclasses.dataclass
class Trace:
    moves: list
    progress: list  # (line, kind, value, seconds): what a display is told; shares as numbers
    commands: list  # (line, text): neither moves nor comments
    labels: list  # (line, name or None): begins and ends of objects
    seconds: float
    lines: list

    def deposits(self):
        return [move for move in self.moves if move.deposits]


STATE = ("tool", "feed", "fan", "accel", "advance", "flow", "limit", "feature", "width", "object", "heat", "jerk", "named")
# Settings of things with names, and the parameter or word that names them: each is compared by its whole line.
NAMED_SETTINGS = {"SET_FAN_SPEED": "FAN", "SET_INPUT_SHAPER": "", "SET_LED": "LED", "SET_TMC_CURRENT": "STEPPER", "M593": "",
                  "M150": "", "M220": ""}


class Machine:
    def __init__(self):
        self.position = [0.0, 0.0, 0.0]
        self.e = 0.0
        self.feed = 0.0
        self.unit = 1.0
        self.relative = self.relative_e = False
        self.retracted = collections.Counter()  # by tool
        self.firmware_retracted = False
        self.now = 0.0
        self.state = dict.fromkeys(STATE, "")
        self.frozen = None
        self.fans, self.jerk, self.named = {}, {}, {}
        self.moves, self.progress, self.commands, self.labels = [], [], [], []

    def set(self, key, value):
        if self.state[key] != value:
            self.state[key] = value
            self.frozen = None

    def freeze(self):
        if self.frozen is None:
            self.frozen = tuple(self.state[key] for key in STATE)
        return self.frozen

    def move(self, line, code, words):
        target = list(self.position)
        for axis, letter in enumerate("XYZ"):
            if letter in words:
                value = words[letter] * self.unit
                target[axis] = self.position[axis] + value if self.relative else value
        e = 0.0
        if "E" in words:
            value = words["E"] * self.unit
            e = value if self.relative_e or self.relative else value - self.e
            self.e = self.e + value if self.relative_e or self.relative else value
        if "F" in words:
            self.feed = words["F"] * self.unit / 60
            self.set("feed", round(self.feed, 4))
        points = self.arc(code, words, target) if code in (2, 3) else [target]
        start = self.position
        lengths = [math.dist(a, b) for a, b in zip([start] + points, points)]
        total = sum(lengths)
        for point, length in zip(points, lengths):
            share = length / total if total else 1.0
            seconds = (length or abs(e)) / self.feed if self.feed else 0.0
            self.moves.append(Move(line, *start, *point, e * share, self.now, seconds,
                                   self.retracted[self.state["tool"]] + (1e9 if self.firmware_retracted else 0), self.freeze()))
            self.now += seconds
            start = point
        self.position = target
        tool = self.state["tool"]
        self.retracted[tool] = max(0.0, self.retracted[tool] - e)

    def arc(self, code, words, target):
        x, y, z = self.position
        cx, cy = x + words.get("I", 0) * self.unit, y + words.get("J", 0) * self.unit
        if "R" in words and "I" not in words and "J" not in words:
            return [target]
        a = math.atan2(y - cy, x - cx)
        b = math.atan2(target[1] - cy, target[0] - cx)
        sweep = (a - b if code == 2 else b - a) % (2 * math.pi) or 2 * math.pi
        radius = math.hypot(x - cx, y - cy)
        count = max(1, math.ceil(sweep * radius / 0.5))
        points = []
        for i in range(1, count):
            angle = a + (-1 if code == 2 else 1) * sweep * i / count
            points.append([cx + radius * math.cos(angle), cy + radius * math.sin(angle), z + (target[2] - z) * i / count])
        return points + [target]

    def comment(self, number, text):
        if match := FEATURE.match(text):
            self.set("feature", match.group(1).strip())
        elif match := re.match(r";\s*(?:WIDTH|LINE_WIDTH):\s*(\S+)", text):
            self.set("width", match.group(1))
        for pattern, begins in LABELS:
            if match := pattern.match(text):
                self.label(number, match.group(1).strip() if begins else None)
        self.told(number, text)

    def told(self, number, text):
        for kind, pattern, is_share in TOLD:
            if match := pattern.match(text):
                value = float(match.group(1)) if is_share else match.group(1).strip()
                self.progress.append((number, kind, value, self.now))

    def label(self, number, name):
        self.labels.append((number, name))
        self.set("object", name or "")

    def command(self, number, text, code, words):
        self.commands.append((number, text))
        self.told(number, text)
        if code in ("M106", "M107"):
            index = int(words.get("P", 0))
            self.fans[index] = words.get("S", 255.0) if code == "M106" else 0.0
            self.set("fan", tuple(sorted(self.fans.items())))
        elif code in ("M104", "M109") and "S" in words:
            self.set("heat", words["S"])
        elif code in ("M205", "M566", "M215") or (code == "M207" and "X" in words):
            self.jerk.update({letter: value for letter, value in words.items() if letter != "M"})
            self.set("jerk", tuple(sorted(self.jerk.items())))
        elif code == "M204":
            self.set("accel", words.get("P", words.get("S", self.state["accel"])))
        elif code in ("M900", "M572", "M233") or text.startswith("SET_PRESSURE_ADVANCE"):
            self.set("advance", text)
        elif code == "M221":
            self.set("flow", words.get("S", ""))
        elif text.startswith("SET_VELOCITY_LIMIT"):
            self.set("limit", tuple(sorted(NAMED.findall(text))))
        elif code in NAMED_SETTINGS:
            self.named[code, dict(NAMED.findall(text)).get(NAMED_SETTINGS[code])] = text
            self.set("named", tuple(sorted(self.named.values())))
        elif code == "M486" and "S" in words:
            self.label(number, str(int(words["S"])) if words["S"] >= 0 else None)
        elif text.startswith("EXCLUDE_OBJECT_START"):
            self.label(number, dict(NAMED.findall(text)).get("NAME"))
        elif text.startswith("EXCLUDE_OBJECT_END"):
            self.label(number, None)
        elif code == "M624":
            self.label(number, text)
        elif code == "M625":
            self.label(number, None)
        elif match := HOST_LABEL.match(text):
            name = match.group(1).strip()
            self.label(number, None if name.lower().split(" ")[0] in NO_OBJECT else name)
        elif code == "G4":
            self.now += words.get("S", 0) + words.get("P", 0) / 1000
        elif re.match(r"T\d+$", code):
            self.set("tool", code)

    def run(self, number, text):
        code = (CODE.match(text) or FIRST.match(text))[0].upper()
        words = {letter: float(value) for letter, value in WORD.findall(text.upper())}
        kind = re.match(r"G0*(\d+)$", code)
        g = int(kind.group(1)) if kind else None
        if g in (0, 1, 2, 3):
            self.move(number, g, words)
        elif g in (10, 11) and not {"P", "S", "L"} & words.keys():
            self.firmware_retracted = g == 10
        elif g in (20, 21):
            self.unit = 25.4 if g == 20 else 1.0
        elif g in (90, 91):
            self.relative = g == 91
        elif code in ("M82", "M83"):
            self.relative_e = code == "M83"
        elif g == 92:
            if "E" in words:
                self.e = words["E"] * self.unit
            for axis, letter in enumerate("XYZ"):
                if letter in words:
                    self.position[axis] = words[letter] * self.unit
        elif g == 28:
            for axis, letter in enumerate("XYZ"):
                if letter in words or not {"X", "Y", "Z"} & words.keys():
                    self.position[axis] = 0.0
        else:
            self.command(number, text, code, words)


def trace(text):
    """Runs `text`, a whole file, and returns its Trace. Unknown commands are kept and change nothing."""
    machine = Machine()
    lines = text.splitlines()
    for number, line in enumerate(lines, 1):
        code, mark, comment = line.partition(";")
        code = NUMBERED.sub("", code)
        if code := code.strip().upper() if code.strip()[:1] in "gmt" else code.strip():
            machine.run(number, code)
        if mark:
            machine.comment(number, mark + comment)
    return Trace(machine.moves, machine.progress, machine.commands, machine.labels, machine.now, lines)
