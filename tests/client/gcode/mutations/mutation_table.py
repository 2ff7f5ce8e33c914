#!/usr/bin/env python3
"""Which defects `traverse verify` finds, and whether it takes what is legal for one.

  mutation_table.py TRAVERSE [--copies=10] [--as=FORM] [--legal] [--rewritten] [--verbose] FILE or FOLDER...

Puts each defect of the *_defects.py here into each file, `copies` times at places chosen by seed, and prints
how many are found, and by the rule that is there for them. With --legal the files are optimised under
the three policies, and verified. With --rewritten the defects are put into what `optimize` makes of the
file, where more has changed: there some of them restore an order of the original, and are none. Ends
with 1 if a defect is not found or a legal file is refused.
"""

import argparse
import json
import os
import random
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import defects  # noqa: E402
import dress  # noqa: E402
import legal_changes  # noqa: E402
import sliced  # noqa: E402


def files_of(operands):
    for operand in operands:
        if os.path.isdir(operand):
            for name in sorted(os.listdir(operand)):
                if ".gcode" in name and ".3mf" not in name and ".bgcode" not in name:
                    yield os.path.join(operand, name)
        else:
            yield operand


def write(folder, name, text):
    path = os.path.join(folder, name)
    with open(path, "w", encoding="latin-1", newline="\n") as file:
        file.write(text)
    return path


def broken(traverse, original, other, policy=None):
    """The rules that are broken, and the message of the first one."""
    command = [traverse, "verify", original, other, "--quiet", "--json=-"]
    if policy:
        command.append(f"--policy={policy}")
    run = subprocess.run(command, capture_output=True, text=True, errors="replace")
    if run.returncode not in (0, 1) or not run.stdout:
        raise RuntimeError(f"{' '.join(command)}: {run.returncode}: {run.stderr}")
    rules = [rule for rule in json.loads(run.stdout)["rules"] if rule["breaks"]]
    for first in (rule["first"] for rule in rules):
        if not first["original_line"] or not first["optimised_line"]:
            raise RuntimeError(f"a message does not name both lines: {first['message']}")
    if (run.returncode == 1) != bool(rules):
        raise RuntimeError("the exit code and --json do not agree")
    return [rule["rule"] for rule in rules], rules[0]["first"]["message"] if rules else ""


def optimised(args, folder, name, policy, text, flags=()):
    """The paths of the text and of what `optimize` makes of it; None if it can't."""
    plain = write(folder, "plain.gcode", text)
    out = os.path.join(folder, "legal.gcode")
    run = subprocess.run([args.traverse, "optimize", plain, "-o", out, "--strategy=ni2opt",
                          f"--policy={policy}", "--quiet", *flags],
                         capture_output=True, text=True, errors="replace")
    if run.returncode == 0:
        return plain, out
    print(f"  {name}, {policy}: not optimised: {run.stderr.strip()[-300:]}", flush=True)
    return None


def rewritten(args, folder, name, file, original):
    """What `optimize` makes of the file under `safe`, as `verify` takes it; None if it can't."""
    pair = optimised(args, folder, name, "safe", file.text())
    if pair is None:
        return None
    made = sliced.Sliced(sliced.read(pair[1]))
    rules, message = broken(args.traverse, original, write(folder, "b.gcode", dress.DRESSES[args.form](made.text())),
                            "safe")
    if rules:
        print(f"  {name}: refused as optimised: {rules} {message}", flush=True)
        return None
    return made


def try_defect(args, folder, name, file, original, defect, counts):
    title, rule, make, policy = defect
    if args.rewritten:
        policy = policy or "safe"
    for copy in range(args.copies):
        rng = random.Random(f"{args.seed} {name} {title} {copy}")
        text = make(file, rng)
        if text is None:
            return
        other = write(folder, "b.gcode", dress.DRESSES[args.form](text))
        rules, message = broken(args.traverse, original, other, policy)
        count = counts.setdefault(title, [0, 0, 0, set()])
        count[0] += 1
        count[1] += bool(rules)
        count[2] += rule in rules
        count[3].add(name)
        if args.verbose and rule not in rules:
            print(f"  {name}, copy {copy}: {title}: {rules} {message}", flush=True)
            if args.keep and not rules:
                write(args.keep, f"{title.replace(' ', '_')}.{name}.{copy}.gcode", dress.DRESSES[args.form](text))
                write(args.keep, f"{name}.original.gcode", dress.DRESSES[args.form](file.text()))


def false_alarms(args, folder, name, path, file, original):
    """The file against itself, changed as a print does not feel, and as this program optimises it;
    (tried, refused)."""
    tried = refused = 0
    for policy in ("safe", "balanced", "free"):
        pairs = [(original, original)]
        if args.legal:
            pair = optimised(args, folder, name, policy, sliced.read(path), args.with_flags.split())
            if pair is not None:
                pairs.append(pair)
        for title, change in legal_changes.CHANGES if policy == "free" else ():
            text = change(file, random.Random(f"{args.seed} {name} {title}"))
            if text is not None:
                pairs.append((original, write(folder, f"{title.replace(' ', '_')}.gcode",
                                               dress.DRESSES[args.form](text))))
        for one, other in pairs:
            # What was allowed on top stands at the head of the optimised file.
            rules, message = broken(args.traverse, one, other, None if args.with_flags else policy)
            tried += 1
            refused += bool(rules)
            if rules:
                print(f"  {name}, {policy}: {os.path.basename(other)}: {rules} {message}", flush=True)
    return tried, refused


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("traverse")
    parser.add_argument("files", nargs="+")
    parser.add_argument("--copies", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--as", dest="form", default="plain", choices=dress.DRESSES, help="in which form")
    parser.add_argument("--legal", action="store_true")
    parser.add_argument("--rewritten", action="store_true")
    parser.add_argument("--with-flags", default="", help="more flags of `optimize` for --legal")
    parser.add_argument("--spread", type=int, default=0, help="put each defect into every nth file alone")
    parser.add_argument("--only", help="a regular expression: the defects to put in, by name")
    parser.add_argument("--verbose", action="store_true")
    parser.add_argument("--keep", help="a folder for what is not found")
    args = parser.parse_args()
    counts, tried, refused, names = {}, 0, 0, []
    with tempfile.TemporaryDirectory() as folder:
        for path in files_of(args.files):
            name = os.path.basename(path).split(".")[0]
            names.append(name)
            file = sliced.Sliced(sliced.read(path))
            original = write(folder, "a.gcode", dress.DRESSES[args.form](file.text()))
            copied = rewritten(args, folder, name, file, original) if args.rewritten else file
            if copied is None:
                refused += 1
                continue
            for i, defect in enumerate(defects.DEFECTS):
                left_out = args.spread and (i + len(names)) % args.spread
                left_out = left_out or (args.form == "inches" and re.search("inches|millimetres", defect[0]))
                if left_out or (args.only and not re.search(args.only, defect[0])):
                    continue
                try_defect(args, folder, name, copied, original, defect, counts)
            one, two = false_alarms(args, folder, name, path, file, original)
            tried, refused = tried + one, refused + two
    print(f"{len(names)} files: {' '.join(names)}\n")
    print("| defect | rule | files | copies | found | by its rule |\n|---|---|---:|---:|---:|---:|")
    for title, rule, _, _ in defects.DEFECTS:
        made, found, own, where = counts.get(title, [0, 0, 0, ()])
        share = f"{100 * found / made:.0f} %" if made else "-"
        own_share = f"{100 * own / made:.0f} %" if made else "-"
        print(f"| {title} | `{rule}` | {len(where)} | {made} | {share} | {own_share} |")
    missed = sum(count[0] - count[1] for count in counts.values())
    made = sum(count[0] for count in counts.values())
    print(f"\n{made} defects, {missed} not found; {tried} legal files, {refused} refused")
    sys.exit(1 if missed or refused or not made else 0)


if __name__ == "__main__":
    main()
