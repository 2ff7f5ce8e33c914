"""Attacks on layers that come as JSON: texts that become much more than they are, and readers who do not read."""
import gzip
import json
import random
import threading
import time

from attacks.files import leave_unread, open_http
from attacks.jobs import ask
from attacks.transport import patiently, until

HEAD = (b"POST /v1/optimize HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\nContent-Length: %d\r\n\r\n")


def posts(makers, callers=3):
    """Each text once at least, by several callers at a time, each of whom waits for a moment and goes."""
    def attack(server, end):
        bodies = [maker() for maker in makers]

        def one(number):
            dice = random.Random(number)
            while True:
                for body in dice.sample(bodies, len(bodies)):
                    patiently(lambda body=body: ask(server, "POST", "/v1/optimize?deadline=2s", body, f"127.0.1.{number}",
                                                    **{"Content-Type": "application/json"}))()
                if time.monotonic() > end:
                    return

        threads = [threading.Thread(target=one, args=(i + 1,)) for i in range(callers)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    return attack


def deep_lists():
    return b'{"layers": ' + b"[" * 16_000_000


def deep_objects():
    return b'{"layers": [' * 1_000_000


def long_text():
    return b'{"options": {"job_id": "' + b"a" * 16_000_000 + b'"}}'


def long_number():
    return b'{"layers": [{"z_mm": 0.' + b"1" * 8_000_000 + b"}]}"


def strange_numbers():
    return b'{"layers": [{"z_mm": 1e-999999999999}, {"exposed_paths": [' + b"1e9," * 1_000_000 + b"NaN]}]}"


def many_keys():
    """The options of a strategy, each with another name."""
    return json.dumps({"options": {"strategy": {"name": "auto", "options": {str(i): "1" for i in range(100_000)}}}}).encode()


def bomb():
    return gzip.compress(b'{"layers": [' + b" " * (100 << 20), 1)


def empty_layers():
    """Three bytes for each."""
    return b'{"layers": [' + b"{}," * 700_000 + b"{}]}"


def empty_islands():
    return b'{"layers": [{"islands": [' + b"{}," * 1_000_000 + b"{}]}]}"


def dots():
    """Contours of one point."""
    return b'{"layers": [{"islands": [{"contours": [' + b'{"points":[1,2]},' * 100_000 + b"{}]}]}]}"


def pairs():
    return b'{"layers": [{"plan": {"nodes": [{"any_order": {"before": [' + b"{}," * 500_000 + b"{}]}}]}}]}"


def entries():
    """Numbers of two bytes each."""
    return b'{"layers": [{"islands": [{"contours": [{"points": [1,2], "entries": [' + b"0," * 8_000_000 + b"0]}]}]}]}"


def walls():
    """A wall that goes up and down all over the plate, where crossings cost time."""
    points = ",".join(f"{i * 5e-4:.4f},{i % 2 * 200}" for i in range(200_000))
    return json.dumps({
        "options": {"cost": {"time": {"speed_mm_s": 120, "accel_mm_s2": 3000, "crossing_seconds": 1}}},
        "layers": [{"walls": ["WALL"], "islands": [{"contours": [{"points": [i, i]} for i in range(5)]}]}],
    }).replace('"WALL"', '{"points": [' + points + "]}").encode()


def faulty_layers():
    """Partial answers say of each layer what is wrong with it."""
    return (b'{"options": {"partial_answers": true}, "layers": [' + b'{"islands":[{"contours":[{}]}]},' * 20_000 + b"{}]}")


def empty_visits():
    """A route that is known, of three bytes a visit."""
    return b'{"layers": [{"islands": [{"contours": [{"points": [1,2]}]}], "initial_route": [' + b"{}," * 200_000 + b"{}]}]}"


def unread_lines(server, end):
    """Jobs of many layers whose answers nobody reads."""
    body = json.dumps({"options": {"strategy": {"name": "none"}}, "layers": [{}] * 4000}).encode()
    leave_unread(server, end, HEAD % len(body) + body, addresses=4)


def unread_pages(server, end):
    """Thousands of requests at a time for what is longer than they are."""
    leave_unread(server, end, b"GET /openapi.json HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n" * 5000, addresses=4)


def strategies_begun_and_left(server, end):
    """Questions for which a worker asks the service, whose callers go at once."""
    def step():
        for connection in [open_http(server) for _ in range(20)]:
            connection.sendall(b"GET /v1/strategies HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
            connection.close()

    until(end, patiently(step))


def begun_and_left(server, end):
    """Jobs of large layers whose callers go at once."""
    dice = random.Random(17)
    contours = [{"points": [dice.uniform(0, 200) for _ in range(8)]} for _ in range(5000)]
    body = json.dumps({"options": {"strategy": {"name": "tabu"}}, "layers": [{"islands": [{"contours": contours}]}]}).encode()

    def step():
        connection = open_http(server)
        connection.sendall(HEAD % len(body) + body)
        time.sleep(dice.choice([0, 0.01, 0.1]))
        connection.close()

    until(end, patiently(step))
