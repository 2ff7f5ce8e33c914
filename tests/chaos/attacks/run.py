"""Runs attacks, each on a process of its own, and checks what nobody may be able to do; see attack.py."""
import argparse
import concurrent.futures
import multiprocessing
import subprocess
import sys
import time

from attacks.attacked_server import DRAIN_SECONDS, Watch

# What gRPC 1.51 holds of streams that were reset is seen by the server only a moment later: a proxy belongs in
# front of a port that strangers reach (server/SECURITY.md).
TRANSPORT_SHARE = 0.15

# No text of a caller becomes the label of a metric.
MOST_METRICS = 100_000


def run(attack, name, program, seconds, max_memory, most_p99, strict):
    """The faults found."""
    server = program(max_memory, files=512 if name in ("idle_connections", "half_prefaces") else None)
    watch = Watch(server)
    try:
        attack(server, time.monotonic() + seconds)
    except OSError as error:
        print(f"    the attack itself: {error}")
    time.sleep(0.5)
    watch.stop()
    if server.process.poll() is not None:
        return [f"the process ended with {server.process.returncode}"]
    ended = False
    try:
        faults = server.still_held()
        told = server.get("/metrics")
        refused = {" ".join(line.split('"')[1::2]): int(float(line.split()[-1])) for line in told.splitlines()
                   if line.startswith(server.refusals) and not line.endswith(" 0")}
        code, took = server.end()
        ended = True
    except (OSError, subprocess.TimeoutExpired) as error:
        server.process.kill()
        return [f"it does not end: {error}"]
    finally:
        if not ended:
            server.process.kill()
    worst = max(watch.health, default=0)
    jobs = sorted(watch.jobs) or [float("inf")]
    p99 = jobs[min(len(jobs) - 1, int(len(jobs) * 0.99))]
    print(f"  {name:22} peak {watch.peak / 1e6:6.0f} MB, health {1000 * worst:5.0f} ms, victim {len(watch.jobs)} jobs, "
          f"{watch.failed} failed, p99 {1000 * p99:5.0f} ms, ended in {took:.1f} s, refused {refused}")
    faults += server.log_faults()
    if len(told) > MOST_METRICS:
        faults.append(f"/metrics has {len(told)} bytes")
    if code != 0:
        faults.append(f"exit code {code}")
    if took > DRAIN_SECONDS + 2:
        faults.append(f"SIGTERM took {took:.1f} s")
    if p99 > (min(most_p99, 1) if strict else most_p99):
        faults.append(f"the victim's p99 was {1000 * p99:.0f} ms")
    if watch.failed and strict:
        faults.append(f"{watch.failed} jobs of the victim failed")
    if worst > (0.25 if strict else 1):
        faults.append(f"/healthz took {worst:.2f} s")
    if watch.peak > max_memory * (1 if strict else 1 + TRANSPORT_SHARE):
        faults.append(f"memory came to {watch.peak / 1e6:.0f} MB")
    return faults


_attacks = {}


def _remember(attacks):
    _attacks.update(attacks)


def _run_named(name, *limits):
    return run(_attacks[name], name, *limits)


def attack_all(attacks, names, side_by_side, *limits):
    """The faults found, by the attack's name. Attackers are forked, because attacks are functions that cannot be sent."""
    found = {}
    with concurrent.futures.ProcessPoolExecutor(side_by_side, multiprocessing.get_context("fork"), _remember, (attacks,)) as attackers:
        for name, faults in zip(names, attackers.map(_run_named, names, *([limit] * len(names) for limit in limits))):
            if faults:
                print(f"  {name}: FAULT: {'; '.join(faults)}")
                found[name] = faults
    return found


def main(attacks, program):
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--seconds", type=float, default=3)
    arguments.add_argument("--only", default=",".join(attacks))
    arguments.add_argument("--max_memory", type=int, default=400_000_000)
    arguments.add_argument("--most_p99", type=float, default=float("inf"))
    arguments.add_argument("--strict", action="store_true")
    arguments.add_argument("--twice", action="store_true")
    arguments.add_argument("--side_by_side", type=int, default=1)
    given = arguments.parse_args()
    limits = program, given.seconds, given.max_memory, given.most_p99, given.strict
    found = attack_all(attacks, given.only.split(","), given.side_by_side, *limits)
    if found and given.twice:
        found = attack_all(attacks, list(found), 1, *limits)
    sys.exit(1 if found else 0)
