"""Attacks on files as jobs: results that nobody fetches, work that is begun and thrown away, readers that do not read."""
import http.client
import json
import random
import threading
import time

from attacks.attacked_server import infill
from attacks.files import open_http
from attacks.transport import patiently, until
from http2_client import DATA, END_STREAM, GCODE_SERVICE, Connection, field, frame, message


def ask(server, method, path, body=None, source="127.0.0.1", **headers):
    """Status and body of the answer."""
    connection = http.client.HTTPConnection("127.0.0.1", server.http_port, timeout=3, source_address=(source, 0))
    try:
        connection.request(method, path, body, headers)
        answer = connection.getresponse()
        return answer.status, answer.read()
    except http.client.HTTPException as error:
        raise OSError(error) from error
    finally:
        connection.close()


def side_by_side(step, callers):
    """`step(server, number)` again and again by several callers at a time."""
    def attack(server, end):
        def one(number):
            until(end, patiently(lambda: step(server, number)))

        threads = [threading.Thread(target=one, args=(number,)) for number in range(1, callers + 1)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    return attack


def hoard(server, number):
    """Jobs that nobody fetches."""
    status, _ = ask(server, "POST", "/v1/jobs?strategy=none", infill(2), f"127.0.1.{number}")
    time.sleep(0 if status == 202 else 0.02)


def begin_and_cancel(server, number):
    """Jobs of large files that are thrown away as soon as they are there."""
    source = f"127.0.1.{number}"
    status, answer = ask(server, "POST", "/v1/jobs?option=effort=100", infill(2) + b"G1X1Y1E1\n" * 100_000, source)
    if status == 202:
        ask(server, "DELETE", "/v1/jobs/" + json.loads(answer)["id"], None, source)


def same_keys(server, number):
    """One key for many files, begun side by side."""
    dice = random.Random(time.monotonic_ns())
    ask(server, "POST", "/v1/jobs?strategy=none", infill(1 + dice.randrange(3)), "127.0.1.1", **{"Idempotency-Key": str(number % 2)})


def guess(server, number):
    """Ids that were never given."""
    dice = random.Random(time.monotonic_ns() + number)
    name = dice.choice(["gateway", "a" * 64, "", "%00", "..", "-", "x" * 9000])
    digits = "".join(dice.choices("0123456789abcdef", k=dice.choice([0, 1, 55, 56, 57, 4000])))
    ask(server, dice.choice(["GET", "DELETE", "HEAD"]), f"/v1/jobs/{name}-{digits}{dice.choice(['', '/file', '/report', '/x'])}")


# A search that ends with the request, or after minutes, and its file.
ENDLESS = "?strategy=tabu&option=evaluations=0&option=diversifications=1000000&layer_time_limit=1000s"


def endless_infill():
    places = [(i * 37 % 200, i * 71 % 20 * 9) for i in range(200)]
    lines = "".join(f"G1 X{x} Y{y} F9000\nG1 F1200\nG1 X{x + .8} Y{y} E.5\n" for x, y in places)
    return infill(1).replace(b"M107", lines.encode() + b"M107")


def endless_searches(server, end):
    """A file from each of a few addresses whose search does not end, and whose sender waits for that."""
    body = endless_infill()
    held = []
    for number in range(1, 9):
        connection = open_http(server, f"127.0.1.{number}")
        connection.sendall(b"POST /v1/gcode%s HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: %d\r\n\r\n"
                           % (ENDLESS.encode(), len(body)) + body)
        held.append(connection)
    time.sleep(max(0, end - time.monotonic()))
    for connection in held:
        connection.close()


def watchers(server, end):
    """Three addresses that watch jobs of theirs, each by as many connections as may, of HTTP before gRPC."""
    held, jobs = [], []
    body = endless_infill()
    for number in range(180):
        source = f"127.0.1.{number % 3 + 1}"
        status, answer = ask(server, "POST", "/v1/jobs" + ENDLESS, body, source)
        if status == 202:
            jobs.append((source, json.loads(answer)["id"].encode()))

    def step():
        if len(held) >= 4 * len(jobs):
            time.sleep(0.1)
            return
        source, name = jobs[len(held) // 4]
        if len(held) < 550:
            connection = open_http(server, source)
            connection.sendall(b"GET /v1/jobs/%s HTTP/1.1\r\nHost: 127.0.0.1\r\nAccept: text/event-stream\r\n\r\n" % name)
        else:
            connection = Connection(server.port, source=source)
            stream = connection.call(GCODE_SERVICE + "WatchJob")
            connection.send(frame(DATA, END_STREAM, stream, message(field(1, name))))
        held.append(connection)

    until(end, patiently(step))
    for connection in held:
        connection.close()
    for source, name in jobs:
        patiently(lambda source=source, name=name: ask(server, "DELETE", "/v1/jobs/" + name.decode(), None, source))()


def unread_events(server, end):
    """Readers of jobs that never read."""
    held, jobs = [], []

    def step():
        if len(jobs) < 50:
            status, answer = ask(server, "POST", "/v1/jobs?option=effort=100", infill(200))
            if status == 202:
                jobs.append(json.loads(answer)["id"])
        connection = open_http(server)
        connection.sendall(b"GET /v1/jobs/%s HTTP/1.1\r\nHost: 127.0.0.1\r\nAccept: text/event-stream\r\n\r\n"
                           % random.choice(jobs).encode())
        held.append(connection)
        if len(held) > 300:
            held.pop(0).close()

    until(end, patiently(step))
    for connection in held:
        connection.close()
    for job in jobs:
        patiently(lambda job=job: ask(server, "DELETE", "/v1/jobs/" + job))()


hoarded_jobs = side_by_side(hoard, 6)
cancelled_jobs = side_by_side(begin_and_cancel, 4)
keys_of_many_files = side_by_side(same_keys, 6)
guessed_ids = side_by_side(guess, 4)
