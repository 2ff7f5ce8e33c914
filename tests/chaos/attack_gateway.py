"""Attacks gateways as attack.py attacks servers: at the ports of gRPC, HTTP and the operators, and by files.

    attack_gateway.py [--seconds=N of each attack, 3] [--only=NAME,...] [--max_memory=BYTES, 400 MB] [--most_p99=S]
                      [--strict] [--twice] [--side_by_side=N attacks, 1]

The victim sends a small file, by gRPC and HTTP in turn. The environment names the gateway's binary: TRAVERSE_GATEWAY.
"""
from attacks import files, jobs, layers, transport
from attacks.attacked_server import Gateway
from attacks.run import main
from http2_client import GCODE_SERVICE

ATTACKS = {
    "rapid_reset": transport.rapid_reset,
    "resets_elsewhere": transport.resets_of([transport.HEALTH, transport.REFLECTION, "/no.such.Service/Method"]),
    "late_calls": transport.resets_of([GCODE_SERVICE + "Inspect", GCODE_SERVICE + "Rewrite"], ["1n", "1u", "1m"]),
    "half_closed": transport.half_closed,
    "half_prefaces": transport.half_prefaces,
    "endless_headers": transport.endless_headers,
    "control_frames": transport.control_frames,
    "many_headers": transport.many_headers,
    "unfinished_strangers": transport.unfinished([transport.HEALTH, transport.REFLECTION], 12, 60),
    "unfinished_messages": transport.unfinished([GCODE_SERVICE + "Rewrite", GCODE_SERVICE + "Verify"], 22, 60),
    "bombs": transport.bombs,
    "idle_connections": transport.idle_connections,
    "one_byte_a_time": transport.one_byte_a_time,
    "operators_port": transport.operators_port,
    "many_channels": transport.many_channels,
    "watches": transport.left_open(transport.WATCH),
    "reflections": transport.left_open(transport.REFLECTION),
    "silent_calls": transport.left_open(GCODE_SERVICE + "Rewrite"),
    "unread_reflections": transport.unread_reflections,
    "hoarded_places": files.hoarded_places(),
    "idle_http": files.held_heads(b"", addresses=2),
    "half_heads": files.held_heads(b"POST /v1/gcode HTTP/1.1\r\nHost: 127.0.0.1\r\nX: ", addresses=2),
    "late_jobs": transport.resets_of([GCODE_SERVICE + name for name in ("CreateJob", "GetJob", "WatchJob", "ReadJob", "CancelJob")], ["1n", "1m"]),
    "unfinished_jobs": transport.unfinished([GCODE_SERVICE + "CreateJob", GCODE_SERVICE + "GetJob"], 22, 60),
    "hoarded_jobs": jobs.hoarded_jobs,
    "cancelled_jobs": jobs.cancelled_jobs,
    "endless_searches": jobs.endless_searches,
    "watchers": jobs.watchers,
    "keys_of_many_files": jobs.keys_of_many_files,
    "guessed_ids": jobs.guessed_ids,
    "unread_events": jobs.unread_events,
    "unread_lines": layers.unread_lines,
    "json_rubbish": layers.posts([layers.deep_lists, layers.deep_objects, layers.long_text, layers.long_number, layers.strange_numbers,
                                  layers.many_keys, layers.bomb]),
    "json_parts": layers.posts([layers.empty_layers, layers.empty_islands, layers.dots, layers.pairs, layers.entries], callers=2),
    "json_faults": layers.posts([layers.faulty_layers, layers.empty_visits]),
    "unread_pages": layers.unread_pages,
    "strategies_left": layers.strategies_begun_and_left,
    "many_parts": files.posts([files.many_parts], content_type="multipart/form-data; boundary=b"),
    "tiny_chunks": files.tiny_chunks,
    "boundaries": files.posts([files.boundaries_but_for_a_letter],
                              content_type="multipart/form-data; boundary=" + files.BOUNDARY.decode()),
    "json_walls": layers.posts([layers.walls], callers=2),
    "json_begun_and_left": layers.begun_and_left,
    "unfinished_uploads": files.unfinished_uploads(1000, addresses=3),
    "unfinished_chunks": files.unfinished_uploads(1000, chunked=True),
    "long_uploads": files.unfinished_uploads(20_000_000, most=20),
    "unread_answers": files.unread_answers,
    "readers_that_go": files.readers_that_go,
    "rubbish": files.rubbish,
    "stated_meatpack": files.posts([files.stated_meatpack]),
    "large_dictionary": files.posts([files.large_dictionary]),
    "gzip_bombs": files.posts([files.gzip_bomb, files.gzip_text]),
    "dense": files.posts([files.dense], callers=2),
    "short_lines": files.posts([files.short_lines, files.long_line]),
    "inspect_tools": files.posts([files.tools], path="/v1/inspect"),
    "verify_tools": files.verify(files.tools),
    "verify_crossings": files.verify(files.crossings),
    "verify_dense": files.verify(files.dense),
}

if __name__ == "__main__":
    main(ATTACKS, Gateway)
