#!/usr/bin/python3
"""Measures what deploy/CAPACITY.md is computed from; prints its tables.

    TRAVERSE_SERVER=build/release/server/traverse-server tests/deploy/capacity.py [STRATEGY...]

By CPU time of the server process, so that other load on the machine does not matter much. `islands` round
islands of 24 vertices with one raster each stand for a layer. Medians of five jobs of 40 layers, fewer for strategies that
search; each search goes on until it ends by itself.
"""

import statistics
import sys
import time

import support
from support import fleet, jobs, python_client

SIZES = (10, 30, 100, 300)
LAYERS = 40
RUNS = 5  # or fewer, once they took
ENOUGH_SECONDS = 10


def request(layers, islands, strategy):
    options = {"strategy": {"name": strategy}}
    return python_client.job(jobs.plate(layers=layers, islands=islands, vertices=24, options=options))


def run(client, job):
    return sum(1 for _ in python_client.optimize(client, job, 600))


def cpu_seconds(server):
    return server.sum_of("process_cpu_seconds_total")


def resident_mib(server):
    return server.sum_of("process_resident_memory_bytes") / 2 ** 20


def peak_mib(server):
    with open(f"/proc/{server.popen.pid}/status", encoding="utf-8") as file:
        return next(int(line.split()[1]) / 1024 for line in file if line.startswith("VmHWM"))


def layers_of(strategy, size):
    """Layers of a job that is long enough to measure and short enough to wait for."""
    return LAYERS if strategy in ("none", "greedy", "ni2opt") else max(2, 160 // size)


def cpu_per_layer(client, server, job):
    """CPU seconds. Short jobs are repeated until the clock of the process, of 10 ms, can tell."""
    begin = cpu_seconds(server)
    done = 0
    while done == 0 or (cpu_seconds(server) - begin < 0.3 and done < 200 * len(job.layers)):
        done += run(client, job)
    return (cpu_seconds(server) - begin) / done


def speed(strategies, connect):
    print(f"\n| layers/s per core | {' | '.join(f'{size} islands' for size in SIZES)} |\n|---|{'---|' * len(SIZES)}")
    for strategy in strategies:
        cells = []
        for size in SIZES:
            job = request(layers_of(strategy, size), size, strategy)
            with support.Server("--threads=1") as server:
                client = connect([server.address])
                used = []
                while len(used) < RUNS and sum(used) * len(job.layers) < ENOUGH_SECONDS:
                    used.append(cpu_per_layer(client, server, job))
                rate = 1 / statistics.median(used)
                client.close()
            cells.append(f"{rate:,.0f}" if rate >= 10 else f"{rate:.2g}")
        print(f"| `{strategy}` | {' | '.join(cells)} |", flush=True)


def memory(connect):
    print("\n| job, `ni2opt` | points | request MiB | server idle MiB | peak MiB | bytes per point |\n|---|---|---|---|---|---|")
    for layers, islands in ((1, 30), (400, 30), (2000, 30), (400, 150)):
        job = request(layers, islands, "ni2opt")
        points = layers * islands * 26
        with support.Server("--threads=2") as server:
            client = connect([server.address])
            run(client, request(1, 10, "ni2opt"))
            idle = resident_mib(server)
            run(client, job)
            peak = peak_mib(server)
            client.close()
        print(f"| {layers} layers of {islands} islands | {points:,} | {job.ByteSize() / 2 ** 20:.1f} | {idle:.0f} | {peak:.0f} | "
              f"{(peak - idle) * 2 ** 20 / points:,.0f} |", flush=True)


def behind_balancer(connect):
    job = request(LAYERS, 100, "ni2opt")
    print("\n| servers of one thread | layers | CPU s of the servers | layers/s per core | wall layers/s |\n|---|---|---|---|---|")
    for count in (1, 3):
        with fleet.Fleet() as servers:
            used = servers.servers[:count]
            client = connect([servers.address if count == 3 else used[0].address])
            begin, wall = [cpu_seconds(server) for server in used], time.monotonic()
            with fleet.Load(lambda: run(client, job), threads=4) as load:
                time.sleep(8)
            wall = time.monotonic() - wall
            cpu = sum(cpu_seconds(server) - before for server, before in zip(used, begin))
            layers = load.done * LAYERS
            print(f"| {count}{' behind HAProxy' if count > 1 else ''} | {layers:,} | {cpu:.1f} | {layers / cpu:,.0f} | {layers / wall:,.0f} |",
                  flush=True)
            client.close()


def main():
    python_client.load()
    from traverse_client import TravelOptimizer
    strategies = sys.argv[1:] or ["none", "greedy", "ni2opt", "auto", "tabu"]
    speed(strategies, TravelOptimizer)
    memory(TravelOptimizer)
    behind_balancer(TravelOptimizer)


if __name__ == "__main__":
    main()
