#!/usr/bin/env python3
"""What the last line of `optimize` and its document say of the new file is what `inspect` says of it.

  figures_test.py TRAVERSE FILE...
"""

import json
import os
import re
import subprocess
import sys
import tempfile


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
    assert done.returncode == 0, f"{command}: {done.stderr}"
    return done.stdout + done.stderr


def one(pattern, text):
    found = re.search(pattern, text)
    assert found, f"no {pattern} in: {text}"
    return found.groups()


def stated(summary):
    """(travel in m, retractions, crossings, minutes) of the new file."""
    travel, retractions, crossings, clock = one(
        r"travel [\d.]+ -> ([\d.]+) m.*?retractions \d+ -> (\d+), visible walls crossed \d+ -> (\d+), "
        r"estimated print time [\d:]+ -> ([\d:]+)", summary)
    parts = [int(part) for part in clock.split(":")]
    return travel, retractions, crossings, sum(part * 60 ** k for k, part in enumerate(reversed(parts))) // 60


def documented(document):
    """The same of the document: of its totals and of the file, which are one."""
    with open(document, encoding="utf-8") as file:
        read = json.load(file)
    total, written = read["total"], read["gcode"]["written"]
    figures = [(one["travel_mm"], one["retractions"], one["crossings"]) for one in (total, written)]
    assert figures[0] == figures[1], f"{document}: {figures}"
    return (f"{total['travel_mm'] / 1000:.2f}", str(total["retractions"]), str(total["crossings"]),
            int(round(written["print_seconds"]) // 60))


def seen(inspection):
    travel, = one(r"\ntravel +([\d.]+) m", inspection)
    retractions, = one(r"\nretractions +(\d+)", inspection)
    crossings, = one(r"\nvisible walls crossed +(\d+) times", inspection)
    time, = one(r"\nestimated print time +([^(]*)", inspection)
    seconds = {"h": 3600, "min": 60, "s": 1}
    total = sum(int(n) * seconds[unit] for n, unit in re.findall(r"(\d+) (h|min|s)", time))
    return travel, retractions, crossings, total // 60


def main():
    traverse, files = sys.argv[1], sys.argv[2:]
    rewritten = 0
    with tempfile.TemporaryDirectory() as folder:
        for file in files:
            for policy in ("safe", "free"):
                out = os.path.join(folder, "out.gcode")
                document = os.path.join(folder, "out.json")
                summary = run(traverse, "optimize", file, "-o", out, f"--policy={policy}", "--strategy=ni2opt",
                              f"--json={document}")
                if "layers rewritten" not in summary:
                    continue
                rewritten += 1
                inspection = run(traverse, "inspect", out)
                assert len(re.findall(r"\btravel +[\d.]+", summary)) == 1, f"travel is stated twice: {summary}"
                assert stated(summary) == seen(inspection), f"{file}, {policy}: {summary}\n{inspection}"
                assert stated(summary) == documented(document), f"{file}, {policy}: {summary}\n{documented(document)}"
    assert rewritten >= len(files), f"only {rewritten} files were rewritten"
    print(f"{rewritten} files agree")


if __name__ == "__main__":
    main()
