#!/usr/bin/env python3
"""Files that no slicer would write, or only one: each is optimised to an equal print, or stays.

  odd_files.py TRAVERSE [--seeds=1-30] [--keep=FOLDER] [--verbose]

Makes a small print for each seed, writes it in a style put together at random (line ends, checksums,
inches, relative moves, switches of modes, arcs by radius, layer marks that lie, ...), and has it
optimised. What comes out has to deposit the same, by the simulation below, which knows neither the
product's reader nor its verifier; or be the file as it was, or there is a message that says why not.
Ends with 1 if one of them is not so.
"""

import argparse
import collections
import math
import os
import random
import re
import subprocess
import sys
import tempfile

STYLES = ("cr", "crlf", "crcrlf", "tabs", "checksums", "numbers", "lower", "packed", "long", "radius",
          "inches", "relative", "relative_e", "e_switches", "no_marks", "twice_marked", "z_down",
          "no_newline", "parentheses", "offsets", "tools", "bom", "progress", "mixed_marks",
          "never_closed", "absolute_e", "resets", "planes", "firmware", "modes_of_arcs", "deleted", "macros",
          "plus", "dotted", "two_codes", "quoted", "offsets_by_g", "volumetric", "percent", "rising",
          "bare_resets", "padded", "spaced", "shuffled", "more_axes", "foreign", "fan_within", "blind_marks",
          "splines", "codes_in_comments", "twice_worded", "inserted_modes", "nul", "utf16", "exponents",
          "far_off", "around_zero", "belt", "circles", "rotated", "lying_labels", "lying_wipes", "two_slicers",
          "torn", "very_long", "form_feeds", "fans_within", "z_hops", "heights_twice", "scripts", "rapid", "mixed_ends",
          "empty_layers", "semicolons", "wrong_checksums", "restarted_numbers", "several_axes", "same_tool",
          "lone_words", "bare_moves", "feeds", "pauses", "glued_comments", "slow_fans")

# Lines that come between two paths, by style. Most are not known to anything but some firmware.
BETWEEN = {
    "firmware": ("G10", "G10 P0 S180", "G11 S1"),
    "modes_of_arcs": ("G90.1", "G91.1"),
    "deleted": ("/G1 X11 Y12 F9000", "/M106 S9", "/ G1 X30 Y30 E2", "/G92 E0"),
    "macros": ("_MOVE X=10 Y=20", "SET_FAN_SPEED FAN=a SPEED={s}", "{if layer>3}M106 S9{endif}", "G1 X{x} Y[y] E1",
               "MACRO_WITH G1=2", "PRINT_START BED=60", "RESTORE_GCODE_STATE NAME=x MOVE=1"),
    "two_codes": ("G90 G1 X5 Y5", "G21 G90", "M106 S0 M107", "M73 P5 G1 X1", "G1 X5 G1 Y5", "T0 M6"),
    "quoted": ('M117 "a; b" G1 X5', "M117 it's (half)", 'M118 P0 "x;y"', "M117 ;", "M23 /G1.gcode"),
    "offsets_by_g": ("G54", "G53 G1 X3 Y3", "G55", "G52 X1", "M206 X1", "M290 Z.01"),
    "volumetric": ("M200 D1.75", "M200 D0", "M221 S95", "M220 S50", "M220 B", "M220 R", "M221 T0 S90"),
    "percent": ("%", "", ";", "   ", ";;", "\x0b", "%O100"),
    "bare_resets": ("G92", "G92.1", "G92 Z0.2", "G92 E", "G92 E-0"),
    "foreign": ("; \u5c42 \u00e9", ";TYPE:\u00c4u\u00dfere Wand", "M117 \u00fc"),
    "blind_marks": (";WIPE_END", "M624 AQ==", "M625", "; stop printing object x", "M486 S-1", ";TYPE:",
                    "EXCLUDE_OBJECT_END", ";LAYER:-1", "; layer 3", "; OBJECT_ID: 7", ";MESH:NONMESH", "; WIPE_START"),
    "splines": ("G5 I0 J3 P0 Q-3 X20 Y20 E.3", "G12 P1", "G27", "G29", "G61", "G64 P.1", "G28 X"),
    "codes_in_comments": ("; T1", ";G91", ";M83", "G4 P1 ; M82", "M105 ; G1 X5 E1", "; G92 E5"),
    "twice_worded": ("G1 X5 X6 Y3", "G1 X Y", "G1 X5 Y5 F", "G1 E", "G X5", "G1 XY5", "G1 X--5", "G1 X1.2.3"),
    "exponents": ("G1 X1e1 Y2 F9000", "M106 S1e2", "G1 F1e4", "G92 E1e0"),
    "rotated": ("G68 X0 Y0 R30", "G69", "G51 P2", "G16", "G53"),
    "lying_labels": ("M624 AQAAAAAAAAA=", "; start printing object, unique label id: 12", "M486 S1", "M486 S0",
                     "EXCLUDE_OBJECT_START NAME=a", "; printing object a id:0 copy 0", "; OBJECT_ID: 3",
                     ";MESH:a.stl", ";PRINTING:a", "; object:{}", "M486 C", "EXCLUDE_OBJECT NAME=a"),
    "lying_wipes": (";WIPE_START", ";WIPE_END", "; WIPE_START", "; FLUSH_START", "; WIPE_TOWER_END", "; FLUSH_END"),
    "two_slicers": ("; FEATURE: Outer wall", ";TYPE:WALL-OUTER", "; feature infill", "; 'Loop Path', 0.4", ";shell",
                    "; tool H0.2 W0.4", "; LINE_WIDTH: 0.4", ";WIDTH:0.45", "; layer 3, Z = 0.6", ";LAYER:99",
                    "; BEGIN_LAYER_OBJECT z=0.2", "; CHANGE_LAYER", ";; --- layer 2 (", ";LAYER_CHANGE", ";layer:1"),
    "nul": ("M117 a\0b", ";\0", "\0", "G1 X5\0 Y5 F9000"),
    "form_feeds": ("\x0c", "; a\x0cb", "\x1a", "G4\x0bP1", "\x85", "; \u2028 x"),
    "z_hops": ("G1 Z9 F600", "G91\nG1 Z.4 F600\nG1 Z-.4\nG90", "G1 Z-1 F600", "G17\nG3 Z3 I1.2 J0 P1 F600"),
    "scripts": ("M622 J1\nG1 X0 Y90 F9000\nM400\nM623", "M600", "M601 ; pause", ";PAUSE_PRINT\nM25",
                "TIMELAPSE_TAKE_FRAME", "M0 wait", "@pause", "M226", "T1\nG1 E15 F300\nT0\nG1 E-15"),
    "several_axes": ("G92 X{x} Y{y} E{e}", "G92 Z{z} E{e}", "G92 X{x} Y{y} Z{z}"),
    "same_tool": ("T0", "T0 ; again", "M6 T0", "T0 P1", "T-1", "Tx", "T"),
    "lone_words": ("X5 Y5", "E.5", "F900", "X9 Y9 E1", "S5", "Z.3"),
    "bare_moves": ("G1", "G0", "G1 ;", "G2", "G3 I1", "G1 P1", "G0 S1", "G10 R1", "G1 H2 X1"),
    "feeds": ("G1 F0", "G0 F-100", "G1 F999999999", "G1 F.001", "M203 X1", "M220 S1", "G93", "G94", "G95"),
    "pauses": ("G4", "G4 S0", "G4 P0.5", "M0", "M1", "M25", "M600 X0 Y0 Z5", "M125", "M76", "M77", "M109 S0"),
    "glued_comments": ("G1;X5", "G1 ;X5 E1", "M106;S5", "G92;E0", "M83;", ";G1 X5 E1", "(G1 X5)", "G1 X5(Y7)E0 F9000"),
    "slow_fans": ("M106", "M106 P1 S3", "M106 S-1", "M106 S300", "M107 P0", "M106 T2", "M106 I1", "M107 S5"),
    "inserted_modes": ("M82 S1", "M83 P0", "G90 S0", "G21 P1"),
}


def num(value, digits=5):
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


class Writer:
    """Writes moves in a style. Positions are in mm; what stands in the file follows from the style."""

    def __init__(self, styles, rng):
        self.styles, self.rng, self.lines = styles, rng, []
        self.at = [0.0, 0.0, 0.0]  # where the machine is by its own words, in mm
        self.e = 0.0
        self.inches = False
        self.relative = False
        self.relative_e = "relative_e" in styles or "absolute_e" not in styles
        self.offset = [0.0, 0.0]  # what G92 X Y added to the words
        self.out("M83" if self.relative_e else "M82")

    def out(self, line):
        self.lines.append(line)

    def scale(self):
        return 25.4 if self.inches else 1.0

    def word(self, axis, value):
        return f"{axis}{num(value / self.scale(), 6 if self.inches else 4)}"

    def moved(self, axis, target):
        """The word that leads to `target`, and where that is, rounding counted."""
        i = "XYZ".index(axis)
        offset = self.offset[i] if i < 2 else 0
        value = target - self.at[i] if self.relative else target + offset
        text = self.word(axis, value)
        there = float(text[1:]) * self.scale()
        self.at[i] = self.at[i] + there if self.relative else there - offset
        return text

    def move(self, x, y, e=None, feed=None, arc=None):
        prints = "G0" if "rapid" in self.styles and self.rng.random() < 0.5 else "G1"
        words = [arc[0] if arc else prints if e is not None else "G0"]
        words += [self.moved("X", x), self.moved("Y", y)]
        if arc:
            words += [self.word(*pair) for pair in arc[1]]
        if e is not None:
            words.append(self.extrude(e))
        if feed:
            words.append("F" + num(feed / self.scale()))
        self.out(" ".join(words))

    def extrude(self, e):
        if self.relative_e or self.relative:
            self.e += e
            return self.word("E", e)
        self.e += e
        return self.word("E", self.e)

    def up(self, z):
        self.out(f"G1 {self.moved('Z', z)} F600" if not self.inches else f"G1 {self.moved('Z', z)} F24")


def print_of(styles, rng):
    """A print of a few layers with lines, loops and arcs: the text before line ends and the like."""
    out = Writer(styles, rng)
    out.lines.insert(0, rng.choice(("; generated by PrusaSlicer 2.7.4+linux", ";FLAVOR:Marlin",
                                    "; plain", "; generated by Slic3r 1.3.0")))
    cura = out.lines[0].startswith(";FLAVOR")
    z = 0.2
    for layer in range(rng.randint(2, 4)):
        if "no_marks" not in styles:
            for _ in range(2 if "twice_marked" in styles else 1):
                out.out(f";LAYER:{layer}" if cura else ";LAYER_CHANGE")
            if "mixed_marks" in styles:
                out.out("; CHANGE_LAYER" if cura else f";LAYER:{layer}")
        if "z_down" in styles and layer == 2:
            z = 0.2
        out.up(z)
        z += 0.2
        if "empty_layers" in styles and rng.random() < 0.5:
            out.out(rng.choice((";LAYER_CHANGE", ";LAYER:7", "; CHANGE_LAYER", ";LAYER:-2")))
        switch_modes(out, styles, rng)
        if "resets" in styles and rng.random() < 0.5:
            out.out("G92 E0")
            out.e = 0.0
        print_layer(out, styles, rng, cura)
    out.out("M104 S0")
    return out.lines


def switch_modes(out, styles, rng):
    if "inches" in styles and rng.random() < 0.5:
        out.inches = not out.inches
        out.out("G20" if out.inches else "G21")
    if "relative" in styles and rng.random() < 0.5:
        out.relative = not out.relative
        out.out("G91" if out.relative else "G90")
    if "e_switches" in styles and rng.random() < 0.6:
        out.relative_e = not out.relative_e
        out.out("M83" if out.relative_e else "M82")
        out.out("G92 E0")
        out.e = 0.0
    if "offsets" in styles and rng.random() < 0.5:
        # The words say another place than before; the head stays.
        x, y = rng.randint(-20, 20), rng.randint(-20, 20)
        out.offset = [x - out.at[0], y - out.at[1]]
        out.out(f"G92 {out.word('X', x)} {out.word('Y', y)}")


def print_layer(out, styles, rng, cura):
    n = rng.randint(4, 14)
    places = [(rng.randint(0, 20) * 5.0, rng.randint(0, 20) * 5.0) for _ in range(n)]
    if "around_zero" in styles:
        places = [(x - 50, y - 50) for x, y in places]
    if "far_off" in styles:
        places = [(x + 999900, y - 999900) for x, y in places]
    for k, (x, y) in enumerate(places):
        if "tools" in styles and rng.random() < 0.1:
            out.out(f"T{rng.randint(0, 1)}")
        if "progress" in styles and rng.random() < 0.4:
            out.out(f"M73 P{k} R{n - k}")
        if "never_closed" in styles and rng.random() < 0.2:
            out.out(";WIPE_START")
        if rng.random() < 0.5:
            kind = rng.choice(("WALL-INNER", "FILL", "SKIN") if cura else
                              ("Perimeter", "Internal infill", "Solid infill"))
            out.out(f";TYPE:{kind}")
        pulls = rng.random() < 0.6
        if pulls:
            out.out(f"G1 {out.extrude(-0.8)} F{num(2100 / out.scale())}")
        out.move(x, y, feed=9000)
        if pulls:
            out.out(f"G1 {out.extrude(0.8)} F{num(2100 / out.scale())}")
        if "belt" in styles and rng.random() < 0.4:
            out.up(round(out.at[2] + rng.choice((-0.1, 0.1, 0.05)), 3))
        if "heights_twice" in styles and rng.random() < 0.3:
            here = out.at[2]
            out.up(here + 0.2)
            out.up(here)
        print_path(out, styles, rng, x, y)
        for style in sorted(styles & BETWEEN.keys()):
            if rng.random() < 0.15:
                for line in rng.choice(BETWEEN[style]).split("\n"):
                    out.out(where_it_is(out, line))


def where_it_is(out, line):
    """With what the words say where the head is, and the register, so that nothing is another place."""
    if not line.startswith("G92 ") or "{" not in line:
        return line
    words = {"x": out.at[0] + out.offset[0], "y": out.at[1] + out.offset[1], "z": out.at[2], "e": out.e}
    return line.format(**{key: num(value / out.scale(), 6) for key, value in words.items()})


def print_path(out, styles, rng, x, y):
    shape = rng.choice(("line", "loop", "arc", "zigzag"))
    if "fan_within" in styles and rng.random() < 0.3:
        out.move(x + 1, y, e=0.03, feed=1200)
        out.out(rng.choice(("M106 S99", "M107", ";WIDTH:0.5", "M204 S700", "M117 in", "; note")))
    if "planes" in styles and rng.random() < 0.2:
        out.out("G18")
        out.out(rng.choice(("G2 X5 Z.3 I1 K0 E.1", "G3 X4 Y4 I1 J0", "G1 X7 Y8 E.1")))
        out.out("G17")
    if "rising" in styles and rng.random() < 0.3:
        out.out(f"G1 {out.moved('X', x + 2)} {out.moved('Y', y)} {out.moved('Z', out.at[2] + 0.05)} "
                f"{out.extrude(0.07)}")
    if "circles" in styles and rng.random() < 0.3:
        out.out(f"{rng.choice(('G2', 'G3'))} {out.word('I', 2)} {out.word('J', 0)} {out.extrude(0.4)}")
    if "fans_within" in styles and rng.random() < 0.5:
        out.out(f"M106 S{rng.randint(0, 255)}")
    if shape == "loop":
        for dx, dy in ((3, 0), (3, 3), (0, 3), (0, 0)):
            out.move(x + dx, y + dy, e=0.11, feed=1200)
    elif shape == "arc":
        before = list(out.at)
        center = ("R", 2.0) if "radius" in styles else None
        command = rng.choice(("G2", "G3"))
        # Half a turn would have two centers by its radius.
        words = [center] if center else [("I", x + 2 - before[0]), ("J", y - before[1])]
        out.move(x + 2, y + (2 if command == "G2" else -2), e=0.2, feed=1200, arc=(command, words))
    else:
        out.move(x + 3, y, e=0.1, feed=1200)
        if shape == "zigzag":
            out.move(x + 3, y + 1, e=0.04)
            out.move(x, y + 1, e=0.1)


def styled(lines, styles, rng):
    """The bytes of the file."""
    made, number = [], 0
    every_line = rng.random() < 0.3  # comments are counted, too
    for line in lines:
        code = not line.startswith(";")
        number += code or every_line
        # Lines with text in them stay as they are.
        plain = code and line[:1] in "GMT" and not re.search(r"[{\[\"_=']|M117|M118|M23|M624", line)
        if plain and "shuffled" in styles:
            name, *words = line.split(" ")
            rng.shuffle(words)
            line = " ".join([name] + words)
        if plain and "padded" in styles:
            line = re.sub(r"^([GM])(\d)\b", r"\g<1>0\2", line)
        if plain and "plus" in styles:
            line = re.sub(r" ([XYZEF])(\d)", r" \1+\2", line)
        if plain and "dotted" in styles:
            line = re.sub(r" ([XYF]\d+)(?= |$)", r" \1.", line)
        if plain and "spaced" in styles:
            line = "  " + re.sub(r" ([XYZEF])", r"  \1 ", line)
        if plain and "more_axes" in styles and line.startswith("G1 ") and rng.random() < 0.1:
            line += rng.choice((" S1", " U5", " A2", " H1", " P5", " I1", " K2"))
        if plain and "lower" in styles:
            line = line.lower()
        if plain and "packed" in styles:
            line = line.replace(" ", "")
        if plain and "tabs" in styles:
            line = line.replace(" ", "\t")
        if plain and "parentheses" in styles and rng.random() < 0.3:
            line += rng.choice((" (a; comment)", " (X1 Y2)", " ; (open", " ()"))
        if "long" in styles and rng.random() < 0.05:
            line += " ;" + "x" * 5000
        if "semicolons" in styles and rng.random() < 0.05:
            made.append(";" * rng.choice((1, 2, 10000)))
        if "very_long" in styles and rng.random() < 0.02:
            line += " ;" + "x" * 300000
        if code and ("checksums" in styles or "numbers" in styles):
            if "restarted_numbers" in styles and rng.random() < 0.05:
                made.append("M110 N0")
            line = f"N{number} {line}"
            if "wrong_checksums" in styles and rng.random() < 0.1:
                line += "*7"
            elif "checksums" in styles:
                total = 0
                for byte in line.encode():
                    total ^= byte
                line += f"*{total}"
        made.append(line)
    end = "\r" if "cr" in styles else "\r\n" if "crlf" in styles else "\r\r\n" if "crcrlf" in styles else "\n"
    text = end.join(made) + ("" if "no_newline" in styles else end)
    if "mixed_ends" in styles:
        text = re.sub(r"\n", lambda _: rng.choice(("\n", "\r\n", "\r", "\n\n", "\r\r\n")), text)
    data = ("\ufeff" if "bom" in styles else "").encode() + text.encode()
    if "utf16" in styles:
        return text.encode("utf-16")
    return data[:rng.randint(len(data) // 2, len(data))] if "torn" in styles else data


# --- what a file deposits --------------------------------------------------------------------------

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


# --- trying ----------------------------------------------------------------------------------------


def try_seed(traverse, seed, folder, verbose):
    """What is wrong, or None; and what became of the file."""
    rng = random.Random(seed)
    styles = set(rng.sample(STYLES, rng.randint(1, 4)))
    data = styled(print_of(styles, rng), styles, rng)
    policy = rng.choice(("safe", "balanced", "free"))
    given, made = os.path.join(folder, "a.gcode"), os.path.join(folder, "b.gcode")
    with open(given, "wb") as file:
        file.write(data)
    if os.path.exists(made):
        os.remove(made)
    run = subprocess.run([traverse, "optimize", given, "-o", made, "--strategy=ni2opt", f"--policy={policy}",
                          "--quiet"], capture_output=True, text=True, timeout=60)
    title = f"seed {seed}, {policy}: {' '.join(sorted(styles))}"
    if run.returncode != 0:
        if verbose:
            print(f"{title}: {run.stderr.strip()[-200:]}")
        if os.path.exists(made):
            return f"{title}: {run.returncode}, and yet there is a file", "refused"
        return None if run.stderr.strip() and run.returncode < 128 else (
            f"{title}: {run.returncode} without a reason", "refused"), "refused"
    with open(made, "rb") as file:
        result = file.read()
    if result == data:
        return None, "as it was"
    wrong = same(deposits(data), deposits(result)) or same(deposits(data, True), deposits(result, True))
    return (f"{title}: {wrong}" if wrong else None), "optimised"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("traverse")
    parser.add_argument("--seeds", default="1-30")
    parser.add_argument("--keep", help="a folder for the files of seeds that fail")
    parser.add_argument("--verbose", action="store_true")
    args = parser.parse_args()
    first, last = (int(part) for part in args.seeds.split("-"))
    counts, wrong = collections.Counter(), 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(first, last + 1):
            fault, became = try_seed(args.traverse, seed, folder, args.verbose)
            counts[became] += 1
            if fault:
                wrong += 1
                print(fault, flush=True)
                for name in ("a", "b"):
                    path = os.path.join(folder, f"{name}.gcode")
                    if args.keep and os.path.exists(path):
                        os.replace(path, os.path.join(args.keep, f"{seed}.{name}.gcode"))
    print(", ".join(f"{count} {what}" for what, count in sorted(counts.items())) + f"; {wrong} wrong")
    sys.exit(1 if wrong or not counts["optimised"] else 0)


if __name__ == "__main__":
    main()
