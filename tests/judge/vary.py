#!/usr/bin/env python3
"""Writes sliced files as others would have them, for judge.py: in other notations, and with lines of custom G-code.

  vary.py FILE... --out=FOLDER [--only=NAME,...]

Every variant prints what its file does, but for a little filament where primes push less or more. So what `optimize` saves should be much the same, and where a layer is given up
that was not before, a notation or a line is taken for something else than it is.
"""

import argparse
import pathlib
import re
from decimal import Decimal

MOVE = re.compile(r"G0*[0123] ")
NUMBER = r"(-?\d*\.?\d+)"
MARK = re.compile(r";(LAYER_CHANGE|LAYER:\d)|; CHANGE_LAYER")
INCH = Decimal("25.4")


def code_and_comment(line):
    code, mark, comment = line.partition(";")
    return code.rstrip(), mark + comment


def of_code(change):
    """A notation that changes what stands before the comment of each line: change(code) -> code."""
    def vary(lines):
        for line in lines:
            code, comment = code_and_comment(line)
            yield change(code) + (" " + comment if code and comment else comment)
    return vary


def of_moves(change):
    return of_code(lambda code: change(code) if MOVE.match(code) else code)


def numbered(lines):
    number = 0
    for line in lines:
        code, comment = code_and_comment(line)
        if code.strip():
            number += 1
            code = f"N{number} {code}"
            check = 0
            for byte in code.encode("latin-1"):
                check ^= byte
            code = f"{code}*{check}"
        yield code + (" " + comment if code and comment else comment)


def feed_alone(lines):
    for line in lines:
        feed = re.search(rf" F{NUMBER}", line) if MOVE.match(line) else None
        if feed and re.search("[XYZE]", code_and_comment(line)[0]):
            yield f"G1{feed[0]}"
            line = line.replace(feed[0], "", 1)
        yield line


def feed_always(lines):
    feed = ""
    for line in lines:
        code, comment = code_and_comment(line)
        if MOVE.match(code):
            stated = re.search(rf" F{NUMBER}", code)
            feed = stated[0] if stated else feed
            code += "" if stated else feed
        yield code + comment


def recounted(mode, lines, counts):
    """E words counted the other way: counts(before, value) -> (word, after)."""
    at = Decimal(0)
    for line in lines:
        code, comment = code_and_comment(line)
        if code in ("M82", "M83"):
            code = mode
        stated = re.search(rf"E{NUMBER}", code)
        if stated and code.startswith("G92"):
            at = Decimal(stated[1])
        elif stated and MOVE.match(code):
            word, at = counts(at, Decimal(stated[1]))
            code = code.replace(stated[0], f"E{word:f}")
        yield code + comment


def states(lines, code):
    return any(code_and_comment(line)[0] == code for line in lines)


def e_relative(lines):
    return recounted("M83", lines, lambda at, value: (value - at, value)) if states(lines, "M82") else None


def e_absolute(lines):
    return recounted("M82", lines, lambda at, value: (at + value, at + value)) if states(lines, "M83") else None


def restarts(share):
    """Primes push so much of what they did: an extra restart distance, below 0 if it is less than 1."""
    def push(code):
        prime = re.match(rf"(G1 (?:F{NUMBER} )?E)(\d*\.?\d+)( F{NUMBER})?$", code)
        return f"{prime[1]}{Decimal(prime[3]) * Decimal(share):f}{prime[4] or ''}" if prime else code
    return lambda lines: of_code(push)(lines) if states(lines, "M83") else None


def inches(lines):
    def word(found):
        return found[1] + f"{(Decimal(found[2]) / INCH).quantize(Decimal('1e-9')).normalize():f}"
    yield "G20"
    for line in lines:
        code, comment = code_and_comment(line)
        if code == "G21":
            code = "G20"
        if MOVE.match(code) or code.startswith("G92 "):
            code = re.sub(rf"([XYZEFIJR]){NUMBER}", word, code)
        yield code + comment


NOTATIONS = {
    "no_blanks": of_moves(lambda code: code.replace(" ", "")),
    "tabs": of_moves(lambda code: "\t" + code.replace(" ", "\t ")),
    "small_letters": of_code(lambda code: code.lower() if re.match(r"[GM]\d", code) and "117" not in code else code),
    "zeros": of_moves(lambda code: re.sub(r"([XYZ])(\d+)", lambda found: found[1] + found[2].zfill(4), code)),
    "two_digits": of_moves(lambda code: re.sub(r"^G([0-3]) ", r"G0\1 ", code)),
    "returns": lambda lines: (line + "\r" for line in lines),
    "numbered": numbered,
    "feed_alone": feed_alone,
    "feed_always": feed_always,
    "e_relative": e_relative,
    "e_absolute": e_absolute,
    "inches": inches,
    "restarts_short": restarts("0.8"),
    "restarts_long": restarts("1.1"),
}

# What firmware, hosts and people put between layers. E is relative where a line has it.
SCRIPTS = {
    "photo": ["M400", "M240", "G4 P300"],
    "park": ["G1 X1 Y1 F9000"],
    "park_and_wait": ["G1 X1 Y1 F9000", "G4 P300"],
    "park_retracted": ["G1 E-1 F1800", "G1 X1 Y1 F9000", "M400", "G4 P300", "G1 E1 F1800"],
    "brush": ["G1 X1 Y50 F9000", "G1 X1 Y90", "G1 X1 Y50"],
    "wait": ["G4 P100"],
    "finish": ["M400"],
    "macro": ["TIMELAPSE_TAKE_FRAME"],
    "unknown": ["ON_LAYER_CHANGE"],
    "display": ["M117 layer", "M300 S100 P10"],
    "host": ["M118 layer"],
    "count": ["SET_PRINT_STATS_INFO CURRENT_LAYER=1"],
    "reset": ["G92 E0"],
}
# What firmware and slicers put beside every retraction.
BESIDE = {"waits": "G4 P20", "finishes": "M400", "states_modes": "G90", "polls": "M105"}


def between_layers(lines, script, at_rises):
    """Behind each mark, or behind the rise that follows. A script that leads the head away leads it back: some slicers
    have led it to its path already."""
    due, last = False, {}
    for line in lines:
        yield line
        if MOVE.match(line):
            last.update(re.findall(rf"([XYF]){NUMBER}", code_and_comment(line)[0]))
        due = due or bool(MARK.match(line))
        if due and (not at_rises or re.match(r"G[01] .*Z", line)):
            due = False
            yield from script
            if any("X" in moved for moved in script) and {"X", "Y", "F"} <= last.keys():
                yield f"G1 X{last['X']} Y{last['Y']}"
                yield f"G1 F{last['F']}"


def beside_pulls(lines, line):
    for other in lines:
        yield other
        if re.match(rf"G1 (F{NUMBER} )?E{NUMBER}( F{NUMBER})?$", code_and_comment(other)[0]):
            yield line


def variants(lines):
    """(name, lines) of each variant that `lines` can have."""
    for name, notation in NOTATIONS.items():
        varied = notation(lines)
        if varied is not None:
            yield name, list(varied)
    for name, script in SCRIPTS.items():
        if not states(lines, "M83") and any(" E" in line for line in script):
            continue
        yield f"{name}_at_marks", list(between_layers(lines, script, at_rises=False))
        yield f"{name}_at_rises", list(between_layers(lines, script, at_rises=True))
    for name, line in BESIDE.items():
        yield name, list(beside_pulls(lines, line))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    only = set(filter(None, arguments.only.split(",")))
    for path in arguments.files:
        lines = path.read_bytes().decode("latin-1").split("\n")
        for name, varied in variants([line.rstrip("\r") for line in lines]):
            if not only or name in only:
                target = arguments.out / f"{path.stem}.{name}.gcode"
                target.write_bytes("\n".join(varied).encode("latin-1"))


if __name__ == "__main__":
    main()
