#!/usr/bin/env python3
"""Judges what `traverse optimize` makes of a folder of sliced files, by code of its own.

  judge.py FOLDER... [--build=build/release] [--policies=safe,balanced,free] [--strategy=ni2opt] [--allow=...]
           [--shrink=FOLDER] [--words=FILE] [--most_mb=8]

Each file is optimised under each policy, and the pair is checked without the product's reader, writer or verifier
(checks.py): deposits and their state, filament, obstacles, ironing, open travel over walls and tops, rest of islands,
progress, labels, head and tail. A table says for each pair what was saved, the layers that stay as sliced, and the first
fault; with --shrink the smallest part of each file that still fails is written there, with --words all that `optimize`
said of each pair. Exits with 1 if any pair fails.

Files may be plain or .xz. Containers are not read. Times are nominal (length by feed rate).
"""

import argparse
import dataclasses
import lzma
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import checks  # noqa: E402
import print_trace  # noqa: E402
import shrink  # noqa: E402

SUFFIXES = (".gcode", ".gcode.xz", ".gco", ".g")
LEAST_LAYER = re.compile(r"(?:slowdown_below|slow_down|cool_min|\bmin)_layer_time(?:_sec)?\s*[=:,]\s*(\d+(?:\.\d+)?)")
NOZZLE = re.compile(r"nozzle_diameter\s*=\s*(\d+(?:\.\d+)?)")


@dataclasses.dataclass
class Options:
    policy: str
    least_layer_s: float
    loop_gap_mm: float
    keeps_wipes: bool = True


@dataclasses.dataclass
class Outcome:
    code: int
    faults: list
    says: str  # the last words of optimize
    saved: float  # seconds of nominal time


def read(path):
    data = path.read_bytes()
    return (lzma.decompress(data) if path.suffix == ".xz" else data).decode("latin-1")


def options_of(text, policy, allow=""):
    least = LEAST_LAYER.search(text)
    nozzle = NOZZLE.search(text)
    return Options(policy, float(least.group(1)) if least else 10.0,
                   max(0.131, 0.3 * float(nozzle.group(1)) if nozzle else 0),
                   policy != "fast" and "wipes" not in allow and "hidden_retractions" not in allow)


def judge(text, policy, arguments):
    """Optimises `text` under `policy` and checks the pair."""
    with tempfile.TemporaryDirectory() as folder:
        given, made = pathlib.Path(folder, "given.gcode"), pathlib.Path(folder, "made.gcode")
        given.write_bytes(text.encode("latin-1"))
        command = [f"{arguments.build}/client/traverse", "optimize", str(given), "-o", str(made), f"--policy={policy}",
                   f"--strategy={arguments.strategy}"]
        if arguments.allow:
            command.append(f"--allow={arguments.allow}")
        run = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=arguments.timeout)
        says = (run.stdout + run.stderr).strip()
        if run.returncode < 0:
            return Outcome(run.returncode, [f"crash: optimize ended by signal {-run.returncode}"], says, 0.0)
        if run.returncode > 1 or (run.returncode == 0) != made.exists():
            return Outcome(run.returncode, [f"exit: {run.returncode}, output {'there' if made.exists() else 'missing'}"],
                           says, 0.0)
        if not made.exists():
            # Refused: with one line that says why.
            return Outcome(run.returncode, [] if says else ["reasons: refused without a word"], says, 0.0)
        after_text = made.read_bytes().decode("latin-1")
    before, after = print_trace.trace(text), print_trace.trace(after_text)
    options = options_of(text, policy, arguments.allow)
    faults = [fault for name, check in checks.ALL.items() for fault in check(before, after, options)]
    faults += reasons(says)
    return Outcome(run.returncode, faults, says, before.seconds - after.seconds)


RULES = "same_print|whole_paths|open_travel|path_ends|made_of_parts|kept_travel"


def reasons(says):
    """What stays is followed by why, in words of a person who slices."""
    lines = [line.strip() for line in says.splitlines()]
    for i, line in enumerate(lines):
        if line.startswith("nothing to gain") and i + 1 == len(lines):
            yield "reasons: nothing is to be gained, and no line says what holds the paths"
        if re.search(rf"\b(?:{RULES})\b", line):
            yield f"reasons: a rule's name instead of words: {line}"
        if re.match(r"gap\s+0\.0 %", line):
            yield f"reasons: {line}"


def barrier(says):
    """The line with which optimize explains what stayed, if any."""
    words = ("stay", "left", "nothing to gain", "unchanged", "refused", "hold")
    lines = [line.strip() for line in says.splitlines()]
    return next((line for line in lines if any(word in line for word in words)), "")


def kind(fault):
    return fault.split(":", 1)[0]


def keep_smallest(path, policy, outcome, arguments):
    wanted = kind(outcome.faults[0])

    def fails(text):
        try:
            return any(kind(fault) == wanted for fault in judge(text, policy, arguments).faults)
        except subprocess.TimeoutExpired:
            return False

    target = pathlib.Path(arguments.shrink, f"{path.name.split('.')[0]}-{policy}-{wanted}.gcode")
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(shrink.shrink(read(path), fails).encode("latin-1"))
    return target


def files_in(folders, most_mb):
    for folder in map(pathlib.Path, folders):
        paths = [folder] if folder.is_file() else sorted(folder.rglob("*"))
        for path in paths:
            if path.name.endswith(SUFFIXES) and path.stat().st_size <= most_mb * 1e6:
                yield path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--policies", default="safe,balanced,free")
    parser.add_argument("--strategy", default="ni2opt")
    parser.add_argument("--allow", default="")
    parser.add_argument("--shrink", help="folder for the smallest parts that still fail")
    parser.add_argument("--words", type=pathlib.Path, help="file for all that optimize says")
    parser.add_argument("--most_mb", type=float, default=8)
    parser.add_argument("--timeout", type=float, default=600, help="seconds for one run of optimize")
    arguments = parser.parse_args()

    failed = 0
    print(f"{'file':40} {'policy':9} {'saved s':>8}  result")
    for path in files_in(arguments.folders, arguments.most_mb):
        text = read(path)
        for policy in arguments.policies.split(","):
            try:
                outcome = judge(text, policy, arguments)
            except subprocess.TimeoutExpired:
                outcome = Outcome(0, [f"time: no answer within {arguments.timeout:g} s"], "", 0.0)
            result = "; ".join(outcome.faults) if outcome.faults else "ok"
            print(f"{path.name:40} {policy:9} {outcome.saved:8.1f}  {result}", flush=True)
            if arguments.words:
                with arguments.words.open("a") as words:
                    words.write(f"== {path.name} {policy}\n{outcome.says}\n")
            if barrier(outcome.says):
                print(f"{'':60} {barrier(outcome.says)}")
            if outcome.faults:
                failed += 1
                if arguments.shrink and outcome.code >= 0 and outcome.saved:
                    print(f"{'':60} smallest part: {keep_smallest(path, policy, outcome, arguments)}")
    print(f"{failed} pairs failed" if failed else "no pair failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
