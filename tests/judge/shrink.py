"""The smallest part of a file that still fails: first whole layers go, then paths, as long as the fault stays."""

import re

LAYER = re.compile(r"^(;LAYER_CHANGE|; CHANGE_LAYER|;LAYER:\d|; layer \d|;layer:|; BEGIN_LAYER_OBJECT|; <layer|;; --- layer)")
TRAVEL = re.compile(r"^G[01]\s+(?!.*E)(?=.*[XY])")


def split(lines, mark):
    """Pieces of `lines`, a new one at each line that `mark` matches; the first is what stands before them all."""
    pieces = [[]]
    for line in lines:
        if mark.match(line):
            pieces.append([])
        pieces[-1].append(line)
    return pieces


def without_most(pieces, fails):
    """Delta debugging (Zeller 1999): drops runs of `pieces` while fails(what is left), halving the runs."""
    size = max(1, len(pieces) // 2)
    while True:
        at = 0
        while at < len(pieces):
            fewer = pieces[:at] + pieces[at + size:]
            if fewer and fails(fewer):
                pieces = fewer
            else:
                at += size
        if size == 1:
            return pieces
        size //= 2


def shrink(text, fails):
    """The smallest text found for which fails(text) still holds. REQUIRES: fails(text)."""
    for mark in (LAYER, TRAVEL):
        head, *pieces = split(text.splitlines(keepends=True), mark)
        if len(pieces) < 2:
            continue

        def joined(kept, head=head):
            return "".join(head + [line for piece in kept for line in piece])

        text = joined(without_most(pieces, lambda kept: fails(joined(kept))))
    return text
