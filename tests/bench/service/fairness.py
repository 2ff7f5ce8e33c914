#!/usr/bin/env python3
"""How long a job of one layer takes beside four jobs of 10,000 layers, all of one caller.

    tests/bench/service/fairness.py [--rounds=5] [--seconds=12] [--rate=20] [--times=3] [--short]

In turn, so that a change of the machine meets both: alone, and beside the large jobs. Prints the medians of the rounds.
Fails if the p99 beside is more than three times that alone and the time that a layer takes to be solved. Server, large
jobs and small ones share the machine: on one that does other work the figures say little.
"""
import argparse
import os
import sys
import time

from served import ROOT, Server, median

LARGE_JOBS = 4
LARGE_LAYERS = 10_000
ISLANDS = 6  # of a layer


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=12, help="of each half of a round")
    parser.add_argument("--rate", type=float, default=20, help="small jobs a second")
    parser.add_argument("--times", type=float, default=3, help="how many times as long beside as alone is allowed")
    parser.add_argument("--short", action="store_true", help="two rounds of 4 s")
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--server_flag", action="append", default=[])
    arguments = parser.parse_args()
    if arguments.short:
        arguments.rounds, arguments.seconds = 2, 2.5
    return arguments


def small(server, arguments):
    found = server.load(f"--rate={arguments.rate}", f"--duration={arguments.seconds}s", "--mix=1",
                        f"--islands={ISLANDS}", "--arrivals=poisson")
    if found["ok"] != found["sent"]:
        sys.exit(f"small jobs failed: {found['codes']}")
    return found["sizes"][0]["latency_ms"]


def main():
    arguments = parse()
    # All large jobs are let in, whatever they ask for: this is about those that are.
    flags = ["--max_queued_points=100000000", "--max_queued_points_per_caller=100000000", "--max_slowdown=1000000", "--max_jobs=1000", "--max_jobs_per_caller=1000",
             *arguments.server_flag]
    alone, beside = [], []
    with Server(arguments.build, flags) as server:
        for _ in range(arguments.rounds):
            alone.append(small(server, arguments))
            large = server.start_load(f"--in_flight={LARGE_JOBS}", f"--mix={LARGE_LAYERS}", f"--islands={ISLANDS}",
                                      "--duration=1h", "--deadline=1h")
            try:
                while server.metric("traverse_queue_layers") < LARGE_JOBS / 2 * LARGE_LAYERS:
                    time.sleep(0.1)
                beside.append(small(server, arguments))
            finally:
                large.kill()
            while server.metric("traverse_jobs_in_flight") > 0:
                time.sleep(0.1)
        name = 'traverse_layer_solve_seconds_{}{{strategy="ni2opt"}}'
        solve = 1000 * server.metric(name.format("sum")) / server.metric(name.format("count"))
    print(f"ms, medians of {arguments.rounds} rounds; a layer takes {solve:.2f} to be solved")
    for what, found in (("alone", alone), ("beside", beside)):
        print(f"{what:7}" + "  ".join(f"{p} {median([f[p] for f in found]):7.2f}" for p in ("p50", "p90", "p99", "max")))
    p99 = [median([found["p99"] for found in half]) for half in (alone, beside)]
    aim = arguments.times * p99[0] + solve
    print(f"p99 beside: {p99[1]:.2f}, aim: at most {aim:.2f}")
    return 0 if p99[1] <= aim else 1


if __name__ == "__main__":
    os.chdir(ROOT)
    sys.exit(main())
