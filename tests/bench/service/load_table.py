#!/usr/bin/env python3
"""How a server bears load: below, near and above what it can do.

    tests/bench/service/load_table.py [--seconds=60] [--sizes=1,10,400,1:70+10:25+400:5] [--short]

For each size of job (layers, or a mix of sizes): its capacity, from a closed loop; then Poisson arrivals at 50, 80 and
150 % of it, with ni2opt. Milliseconds; those of accepted jobs, and the first of the refused ones, count from when a job
was meant to be sent, and so have the delays of the generator in them; "from sent" has not. Prints a table in Markdown.
Fails if above capacity the p99 of accepted jobs is more than twice that at 80 %, or that of refusals from when they were
sent above 5 ms, or the memory more than a quarter above that at 80 %; always if the server ends with an error, as it does for a report
of a sanitizer: --short --build=build/asan. Server and generator share the machine.
"""
import argparse
import os
import sys

from served import ROOT, Server

LOADS = (0.5, 0.8, 1.5)
MOST_REFUSAL_MS = 5


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=60, help="of each load")
    parser.add_argument("--sizes", default="1,10,400,1:70+10:25+400:5")
    parser.add_argument("--short", action="store_true", help="half a second of each load, of 1 and 40 layers; the figures mean nothing")
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--server_flag", action="append", default=[])
    arguments = parser.parse_args()
    if arguments.short:
        arguments.seconds, arguments.sizes = 0.5, "1,40"
    return arguments


def capacity(arguments, mix):
    # All are let in: else large jobs of the mix are refused, and it is another one.
    with Server(arguments.build, ["--max_slowdown=1000000", *arguments.server_flag]) as server:
        found = server.load("--in_flight=12", f"--mix={mix}", f"--duration={min(10, arguments.seconds)}s")
    return found["ok_per_second"]


def milliseconds(latency, names):
    return " / ".join(f"{latency[name]:.1f}" for name in names) if latency else ""


def measure(server, mix, rate, arguments):
    found = server.load(f"--rate={rate:.3f}", f"--mix={mix}", f"--duration={arguments.seconds}s", "--arrivals=poisson")
    found["resident_mb"] = server.resident_mb()
    return found


def row(load, found):
    accepted = [f"{size['layers']}: " * (len(found["sizes"]) > 1) + milliseconds(size["latency_ms"], ("p50", "p99", "p99_9"))
                for size in found["sizes"]]
    refused = found["codes"].get("RESOURCE_EXHAUSTED", {"jobs": 0, "latency_ms": None, "from_sent_ms": None})
    return "| " + " | ".join([
        f"{load:.0%}, {found['rate']:.1f}", f"{found['ok_per_second']:.1f}", "; ".join(accepted),
        milliseconds(found["send_lag_ms"], ("p99",)), f"{refused['jobs']} of {found['sent']}",
        milliseconds(refused["latency_ms"], ("p99",)), milliseconds(refused["from_sent_ms"], ("p50", "p99")),
        f"{found['resident_mb']:.0f}"]) + " |"


def faults(near, above):
    for at_80, at_150 in zip(near["sizes"], above["sizes"]):
        if not at_150["ok"] or not at_80["ok"]:
            continue
        p99 = at_80["latency_ms"]["p99"], at_150["latency_ms"]["p99"]
        if p99[1] > 2 * p99[0]:
            yield f"{at_80['layers']} layers: p99 of accepted jobs {p99[1]:.1f}, at 80 % {p99[0]:.1f}"
    refused = above["codes"].get("RESOURCE_EXHAUSTED")
    if refused and refused["from_sent_ms"]["p99"] > MOST_REFUSAL_MS:
        yield f"p99 of refusals {refused['from_sent_ms']['p99']:.1f}"
    if above["resident_mb"] > 1.25 * near["resident_mb"]:
        yield f"memory {above['resident_mb']:.0f} MB, at 80 % {near['resident_mb']:.0f}"
    others = set(above["codes"]) - {"OK", "RESOURCE_EXHAUSTED"}
    if others:
        said = {code: above["codes"][code]["example"] for code in sorted(others)}
        yield f"other outcomes: {said}"


def main():
    arguments = parse()
    found_faults = []
    for size in arguments.sizes.split(","):
        mix = size.replace("+", ",")
        most = capacity(arguments, mix)
        print(f"\nlayers {mix}: capacity {most:.1f} jobs/s\n\n"
              "| load, jobs/s | ok/s | accepted p50 / p99 / p99.9 | sent late p99 | refused | p99 | from sent p50 / p99 | MB |\n"
              "|---|---|---|---|---|---|---|---|", flush=True)
        found = {}
        with Server(arguments.build, arguments.server_flag) as server:
            for load in LOADS:
                found[load] = measure(server, mix, load * most, arguments)
                print(row(load, found[load]), flush=True)
        found_faults += [f"layers {mix}: {fault}" for fault in faults(found[0.8], found[1.5])]
    print("\n" + "\n".join(found_faults or ["all aims are met"]))
    figures_count = not arguments.short
    return 1 if found_faults and (figures_count or any("outcomes" in fault for fault in found_faults)) else 0


if __name__ == "__main__":
    os.chdir(ROOT)
    sys.exit(main())
