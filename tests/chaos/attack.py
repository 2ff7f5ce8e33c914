"""Attacks servers as a stranger would, each attack a server of its own, and checks what nobody may be able to do.

    attack.py [--seconds=N of each attack, 3] [--only=NAME,...] [--max_memory=BYTES, 400 MB] [--most_p99=S]
              [--twice] [--side_by_side=N attacks, 1]

Throughout: the process lives, /healthz answers within a second, a victim's one-layer jobs end well, memory stays below
--max_memory, the log has only whole lines of the server, /metrics does not grow with what callers write, and at the end
SIGTERM ends it within --drain_timeout + 2 s; on a quiet machine --most_p99=0.25 can be asked for: the victim's time for a
job. A machine that stands still for a moment lets much in before anybody can look: with --twice an attack that did harm is
made again, and counts if it does so again; of attacks made side by side it is made again alone.
The environment names the server's binary: TRAVERSE_SERVER. Needs nothing but Python; frames are written by hand (http2_client.py).
"""
import argparse
import concurrent.futures
import subprocess
import sys
import time

from attacks import callers, requests, transport
from attacks.attacked_server import DRAIN_SECONDS, Server, Watch, still_held
from http2_client import SERVICE

# What gRPC 1.51 holds of streams that were reset is seen by the server only a moment later: a proxy belongs in
# front of a port that strangers reach (server/SECURITY.md).
TRANSPORT_SHARE = 0.15

# No text of a caller becomes the label of a metric.
MOST_METRICS = 100_000

ATTACKS = {
    "rapid_reset": transport.rapid_reset,
    "resets_elsewhere": transport.resets_of([transport.HEALTH, transport.REFLECTION, "/no.such.Service/Method", SERVICE + "ListStrategies"]),
    "late_calls": transport.resets_of([SERVICE + "Optimize", SERVICE + "OptimizeBatch"], ["1n", "1u", "1m"]),
    "half_closed": transport.half_closed,
    "half_prefaces": transport.half_prefaces,
    "cancelled_uploads": callers.cancelled_uploads,
    "validate_only": callers.batches([requests.many_pairs, lambda: requests.validate_only() + requests.layer(200_000)]),
    "names": callers.names,
    "half_characters": callers.half_characters,
    "endless_headers": transport.endless_headers,
    "control_frames": transport.control_frames,
    "many_headers": transport.many_headers,
    "unfinished_strangers": transport.unfinished([transport.HEALTH, transport.REFLECTION, SERVICE + "ListStrategies"], 12, 60),
    "unfinished_batches": transport.unfinished([SERVICE + "OptimizeBatch", SERVICE + "Optimize"], 22, 60),
    "oversize": transport.unfinished([SERVICE + "OptimizeBatch"], 3, 300),
    "bombs": transport.bombs,
    "empty_islands": callers.batches([requests.empty_islands]),
    "small_contours": callers.batches([requests.small_contours]),
    "stated_sizes": transport.stated_sizes,
    "stalled_readers": callers.stalled_readers,
    "idle_connections": transport.idle_connections,
    "one_byte_a_time": transport.one_byte_a_time,
    "extremes": callers.extremes,
    "cancels": callers.cancels,
    "unknown_fields": callers.batches([requests.unknown_fields, requests.unknown_options]),
    "packed_children": callers.batches([requests.packed_children]),
    "named_walls": callers.batches([requests.named_walls, requests.exposed_paths, requests.retracted_paths]),
    "upright_walls": callers.batches([requests.upright_walls]),
    "clustered_walls": callers.batches([requests.clustered_walls]),
    "scribbled_walls": callers.batches([requests.scribbled_walls], seconds=2),
    "barriers": callers.batches([requests.barrier("auto"), requests.barrier("tabu"), requests.barrier("exact")], seconds=1),
    "fixed_order": callers.batches([requests.fixed_order], seconds=1),
    "two_clouds": callers.batches([requests.two_clouds("auto"), requests.two_clouds("tabu"), requests.two_clouds("exact")], seconds=1),
    # Layers of 19,000 paths: each is searched for a moment, and then waits for its turn.
    "paused_searches": callers.open_jobs(requests.large_layers("auto")),
    # Layers of some dozen contours of many points: all searches under way hold what their bounds need.
    "many_bounds": callers.open_jobs(lambda: requests.options("auto") + requests.layer(80, corners=12) * 6),
    # The same of so few points that a server might take them for nothing, by many callers.
    "small_bounds": callers.open_jobs(lambda: requests.options("auto") + requests.layer(20, corners=10) * 6, most=250, callers=40),
    # Few contours of many points that lie all over the plate: no box rules any pair of them out.
    "scattered_bounds": callers.open_jobs(lambda: requests.options("auto") + requests.layer(400, corners=240), most=8),
    "unread_answers": callers.open_jobs(lambda: requests.options("none") + requests.layer(20_000) * 4, window=0),
    "corners": callers.corners,
    "operators_port": transport.operators_port,
    "many_channels": transport.many_channels,
    "watches": transport.left_open(transport.WATCH),
    "reflections": transport.left_open(transport.REFLECTION),
    "silent_streams": transport.left_open(SERVICE + "Optimize"),
    "unread_reflections": transport.unread_reflections,
}


def run(name, seconds, max_memory, most_p99):
    """The faults found."""
    server = Server(max_memory, files=512 if name in ("idle_connections", "half_prefaces") else None)
    watch = Watch(server)
    try:
        ATTACKS[name](server, time.monotonic() + seconds)
    except OSError as error:
        print(f"    the attack itself: {error}")
    time.sleep(0.5)
    watch.stop()
    if server.process.poll() is not None:
        return [f"the process ended with {server.process.returncode}"]
    ended = False
    try:
        faults = still_held(server)
        told = server.get("/metrics")
        refused = {line.split('"')[1]: int(float(line.split()[-1])) for line in told.splitlines()
                   if line.startswith("traverse_rejected_total") and not line.endswith(" 0")}
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
    if p99 > most_p99:
        faults.append(f"the victim's p99 was {1000 * p99:.0f} ms")
    if worst > 1:
        faults.append(f"/healthz took {worst:.1f} s")
    if watch.peak > max_memory * (1 + TRANSPORT_SHARE):
        faults.append(f"memory came to {watch.peak / 1e6:.0f} MB")
    return faults


def attack_all(names, side_by_side, *limits):
    """The faults found, by the attack's name."""
    found = {}
    with concurrent.futures.ProcessPoolExecutor(side_by_side) as attackers:
        for name, faults in zip(names, attackers.map(run, names, *([limit] * len(names) for limit in limits))):
            if faults:
                print(f"  {name}: FAULT: {'; '.join(faults)}")
                found[name] = faults
    return found


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--seconds", type=float, default=3)
    arguments.add_argument("--only", default=",".join(ATTACKS))
    arguments.add_argument("--max_memory", type=int, default=400_000_000)
    arguments.add_argument("--most_p99", type=float, default=float("inf"))
    arguments.add_argument("--twice", action="store_true")
    arguments.add_argument("--side_by_side", type=int, default=1)
    given = arguments.parse_args()
    limits = given.seconds, given.max_memory, given.most_p99
    found = attack_all(given.only.split(","), given.side_by_side, *limits)
    if found and given.twice:
        found = attack_all(list(found), 1, *limits)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
