"""Attacks servers as a stranger would, each attack a server of its own, and checks what nobody may be able to do.

    attack.py [--seconds=N of each attack, 3] [--only=NAME,...] [--max_memory=BYTES, 400 MB] [--most_p99=S]
              [--strict] [--twice] [--side_by_side=N attacks, 1]

Throughout: the process lives, /healthz answers within a second, a victim's one-layer jobs end well, memory stays below
--max_memory, the log has only whole lines of the server, /metrics does not grow with what callers write, and at the end
SIGTERM ends it within --drain_timeout + 2 s; on a quiet machine --most_p99=0.25 can be asked for: the victim's time for a
job; or with --strict that none of its jobs fails, all take a second at most, /healthz 0.25 s, and memory stays below all of
--max_memory. A machine that stands still for a moment lets much in before anybody can look: with --twice an attack that did harm is
made again, and counts if it does so again; of attacks made side by side it is made again alone.
The environment names the server's binary: TRAVERSE_SERVER. Needs nothing but Python; frames are written by hand (http2_client.py).
"""
from attacks import callers, requests, transport
from attacks.attacked_server import Server
from attacks.run import main
from http2_client import SERVICE

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
    "faulty_layers": callers.batches([requests.faulty_layers]),
    "unread_faults": callers.open_jobs(requests.faulty_layers, window=0, most=20, callers=4),
    "known_routes": callers.batches([requests.empty_visits, requests.known_route], seconds=1),
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


if __name__ == "__main__":
    main(ATTACKS, Server)
