#!/usr/bin/env python3
"""How true is what `traverse optimize` says of the time that is left?

  forecasts.py FILE_OR_FOLDER... [--build=build/release] [--policy=safe] [--most_mb=8] [--threads=N]

Runs each file as on a terminal, and compares each "12 s left" with the time that was left then. A row says how many
there were, how many were off by more than a factor of two, and the worst. What was said in the last two seconds does
not count. Exits with 1 if more than a tenth of any file's forecasts were that far off. Nothing else should run
meanwhile.
"""

import argparse
import os
import pathlib
import pty
import re
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import judge  # noqa: E402

LEFT = re.compile(r"((?:\d+(?:\.\d+)? (?:ms|s|min|h|d) ?)+)left")
PART = re.compile(r"(\d+(?:\.\d+)?) (ms|s|min|h|d)")
SECONDS = {"ms": 1e-3, "s": 1, "min": 60, "h": 3600, "d": 86400}
LEAST_LEFT_S = 2
FACTOR = 2
MOST_SHARE = 0.1


def seconds(words):
    return sum(float(count) * SECONDS[unit] for count, unit in PART.findall(words))


def said(command):
    """[(seconds said, seconds that were left)] of one run, and how long it took."""
    ours, theirs = pty.openpty()
    begun, heard = time.monotonic(), []
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=theirs) as run:
        os.close(theirs)
        while True:
            try:
                data = os.read(ours, 65536)
            except OSError:  # the other end is closed
                break
            heard += [(time.monotonic(), seconds(words)) for words in LEFT.findall(data.decode(errors="replace"))]
    end = time.monotonic()
    os.close(ours)
    return [(told, end - at) for at, told in heard if end - at >= LEAST_LEFT_S], end - begun


def off(told, left):
    """By which factor, and to which side."""
    return max(told, 0.1) / left


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--policy", default="safe")
    parser.add_argument("--most_mb", type=float, default=8)
    parser.add_argument("--threads", type=int, default=0, help="0: all cores")
    arguments = parser.parse_args()

    failed = 0
    print(f"{'file':40} {'takes s':>8} {'told':>5} {'off':>5}  worst")
    for path in judge.files_in(arguments.folders, arguments.most_mb):
        with tempfile.TemporaryDirectory() as folder:
            made = str(pathlib.Path(folder, "made"))
            command = [f"{arguments.build}/client/traverse", "optimize", str(path), "-o", made,
                       f"--policy={arguments.policy}"]
            if arguments.threads:
                command.append(f"--threads={arguments.threads}")
            pairs, took = said(command)
        wrong = [pair for pair in pairs if not 1 / FACTOR <= off(*pair) <= FACTOR]
        worst = max(pairs, key=lambda pair: max(off(*pair), 1 / off(*pair)), default=None)
        words = f"{worst[0]:.1f} s told, {worst[1]:.1f} s left" if worst else ""
        print(f"{path.name:40} {took:8.1f} {len(pairs):5} {len(wrong):5}  {words}", flush=True)
        failed += len(wrong) > MOST_SHARE * len(pairs)
    print(f"{failed} files' forecasts are off" if failed else "no file's forecasts are off")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
