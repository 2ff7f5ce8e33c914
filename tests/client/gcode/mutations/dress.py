"""The same print written otherwise: what is found in a file is to be found in its other forms as well."""

import re

from sliced import number

CODE = re.compile(r"([GM]\d+|T\d+)\b")
WORD = re.compile(r"([XYZEFIJR])\s*([-+]?[0-9]*\.?[0-9]+)")


def absolute(text):
    """Filament counted from a register, which is set back now and then, as slicers do."""
    register, digits, relative, lines = 0.0, 5, False, []
    for line in text.split("\n"):
        code = line.split(";")[0]
        first = CODE.match(code)
        first = first.group(1) if first else ""
        if first in ("G90", "G91"):
            relative = first == "G91"
        if first == "M83":
            line = line.replace("M83", "M82")
        elif line.startswith(";reset"):
            line, register = line.replace(";reset", "G92 E0"), 0.0
        elif first == "G92":
            words = dict(WORD.findall(code))
            register = float(words.get("E", register))
        elif first in ("G0", "G1", "G2", "G3") and not relative:
            found = re.search(r"E\s*([-+]?[0-9]*\.?[0-9]+)", code)
            if found:
                register = round(register + float(found.group(1)), digits)
                line = line[:found.start()] + "E" + number(register) + line[found.end():]
        elif first in ("G0", "G1", "G2", "G3"):
            found = re.search(r"E\s*([-+]?[0-9]*\.?[0-9]+)", code)
            register += float(found.group(1)) if found else 0
        lines.append(line)
    return "\n".join(lines)


def carriage_returns(text):
    return text.replace("\n", "\r\n")


def packed(text):
    """Small letters without blanks between the words of moves."""

    def of_line(line):
        code, semicolon, comment = line.partition(";")
        return re.sub(r"[ \t]+", "", code.lower()) + semicolon + comment if re.match(r"G[0-3] ", line) else line

    return "\n".join(of_line(line) for line in text.split("\n"))


def inches(text):
    def scaled(match):
        return match.group(1) + number(float(match.group(2)) / 25.4, 7)

    lines = ["G20" + ("\r" if "\r" in text else "")]
    for line in text.split("\n"):
        if re.match(r"G2[01]\b", line):
            continue
        code, semicolon, comment = line.partition(";")
        if re.match(r"G(?:[0-3]|92)\b", line):
            code = code[:2] + WORD.sub(scaled, code[2:]) if code[:3] != "G92" else code[:3] + WORD.sub(scaled, code[3:])
        lines.append(code + semicolon + comment)
    return "\n".join(lines)


DRESSES = {"plain": lambda text: text, "absolute": absolute, "crlf": carriage_returns, "packed": packed,
           "inches": inches}
