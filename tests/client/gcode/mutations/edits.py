"""What defects are made of: lines changed, put in and left out."""

import re

from sliced import number


def edited(file, changes):
    """The text with lines replaced: changes[i] is a list of lines in place of line i."""
    out = []
    for i, line in enumerate(file.lines):
        out.extend(changes[i] if i in changes else [line.text])
    return "\n".join(out)


def pick(rng, candidates, tries, make):
    """The first of `tries` candidates, at random, that `make` makes something of."""
    candidates = list(candidates)
    rng.shuffle(candidates)
    for candidate in candidates[:tries]:
        made = make(candidate)
        if made is not None:
            return made
    return None


def go(point, line):
    """A way to a point beside `line`, as fast as the ways there."""
    return f"G1 X{number(point[0])} Y{number(point[1])} F{number(line.way_feed)}"


def restated(file, index):
    """Lines that set what holds for line `index`."""
    line = file.lines[index]
    return list(line.state.values()) + [f"G1 F{number(line.feed)}"]


def body(file, path):
    return [file.lines[i].text for i in range(path.first, path.last + 1)]


def reverse(file, path):
    """The path from its end to its start."""
    texts = []
    for i in reversed(path.deposits):
        line = file.lines[i]
        texts.append(f"G1 X{number(line.start[0])} Y{number(line.start[1])} E{number(line.e)}")
    changes = {i: [] for i in range(path.first, path.last + 1)}
    feed = restated(file, path.first)
    leave = go(path.end, file.lines[path.first])
    changes[path.first] = [leave] + feed + texts + [leave] + feed
    return changes


def without_e(text):
    return re.sub(r"\s*E-?[0-9.]+", "", text)


def with_e(text, change):
    return re.sub(r"E(-?[0-9.]+)", lambda m: "E" + number(change(float(m.group(1)))), text)


def with_z(text, z):
    return re.sub(r"Z-?[0-9.]+", "Z" + number(z), text)


def with_f(text, feed):
    code, mark, comment = text.partition(";")
    code = re.sub(r"\s*F[0-9.]+", "", code).rstrip()
    return f"{code} F{number(feed)}" + (f" {mark}{comment}" if mark else "")


def changed_number(file, rng, pattern):
    """One of the lines that match has another number: the first group."""

    def make(i):
        found = re.match(pattern, file.lines[i].text)
        value = number(float(found.group(1)) + 5)
        text = file.lines[i].text
        return edited(file, {i: [text[:found.start(1)] + value + text[found.end(1):]]})

    return pick(rng, [i for i, line in enumerate(file.lines) if re.match(pattern, line.text)], 1, make)


def with_xy(text, point):
    for axis, value in zip("XY", point):
        text = re.sub(axis + r"-?[0-9.]+", axis + number(value), text)
    return text


def with_word(text, letter, change):
    return re.sub(letter + r"(-?[0-9]*\.?[0-9]+)", lambda m: letter + number(change(float(m.group(1)))), text,
                  count=1)


def moved_behind(file, i, behind):
    return edited(file, {i: [], behind: [file.lines[behind].text, file.lines[i].text]})


def next_deposit(file, i):
    return next((k for k in range(i + 1, len(file.lines)) if file.lines[k].kind == "deposit"), None)


def next_path(file, i):
    return next((path for path in file.paths if path.first > i), None)


def at_its_feed(file, i):
    return [f"G1 F{number(file.lines[i].feed)}", file.lines[i].text]


def without_path(path, text=None):
    changes = {i: [] for i in range(path.first, path.last + 1)}
    if text is not None:
        changes[path.first] = text
    return changes
