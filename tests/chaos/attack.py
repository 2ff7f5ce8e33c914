"""Attacks a server of its own as a stranger would, one attack after the other, and checks what nobody may be able to do.

    attack.py [--seconds=N of each attack, 3] [--only=NAME,...] [--max_memory=BYTES, 400 MB] [--most_p99=S]
              [--twice]

Throughout: the process lives, /healthz answers within a second, a victim's one-layer jobs end well, memory stays below
--max_memory, and at the end SIGTERM ends it within --drain_timeout + 2 s; on a quiet machine --most_p99=0.25 can be asked for:
the victim's time for a job. A machine that stands still for a moment lets much in before anybody can look: with --twice an
attack that did harm is made again, and counts if it does so again. The environment names the server's binary:
TRAVERSE_SERVER. Needs nothing but Python; frames are written by hand (http2_client.py).
"""
import argparse
import multiprocessing
import os
import random
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
import urllib.request

from http2_client import (CONTINUATION, DATA, END_HEADERS, END_STREAM, HEADERS, PING, RST_STREAM, SERVICE, SETTINGS,
                          WINDOW_UPDATE, Connection, Window, bomb, field, frame, literal, message, varint)

# What gRPC 1.51 holds of streams that were reset is seen by the server only a moment later: a proxy belongs in
# front of a port that strangers reach (server/SECURITY.md).
TRANSPORT_SHARE = 0.15
DRAIN_SECONDS = 2
HEALTH = "/grpc.health.v1.Health/Check"
REFLECTION = "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo"


def packed(doubles):
    return struct.pack(f"<{len(doubles)}d", *doubles)


def number(field_number, value):
    return varint(field_number << 3 | 1) + struct.pack("<d", value)


def layer(paths=20, random_points=None):
    point = random_points or (lambda: random.uniform(0, 200))
    contours = b"".join(field(2, field(2, packed([point() for _ in range(8)]))) for _ in range(paths))
    return field(2, field(3, contours))


def options(strategy="greedy", cost=b""):
    return field(1, field(2, field(1, strategy.encode())) + (field(6, field(2, cost)) if cost else b""))


class Server:
    def __init__(self, max_memory, flags=(), files=None):
        prefix = ["prlimit", f"--nofile={files}:{files}"] if files else []
        self.log = open("/dev/null", "w")
        self.process = subprocess.Popen(
            [*prefix, os.environ["TRAVERSE_SERVER"], "--listen=127.0.0.1:0", "--metrics_listen=127.0.0.1:0",
             f"--max_memory={max_memory}", f"--drain_timeout={DRAIN_SECONDS}s", *flags],
            stdout=subprocess.PIPE, stderr=self.log, text=True)
        self.port = int(self.process.stdout.readline().split()[-1])
        self.metrics_port = int(self.process.stdout.readline().split()[-1])

    def get(self, path, timeout=5):
        with urllib.request.urlopen(f"http://127.0.0.1:{self.metrics_port}{path}", timeout=timeout) as answer:
            return answer.read().decode()

    def memory(self):
        with open(f"/proc/{self.process.pid}/statm") as file:
            _, resident, shared = (int(word) for word in file.read().split()[:3])
        return (resident - shared) * os.sysconf("SC_PAGESIZE")

    def end(self):
        begin = time.monotonic()
        self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(timeout=60)
        self.process.stdout.close()
        self.log.close()
        return code, time.monotonic() - begin


class Watch:
    """Looks at the server while it is attacked: memory often, health and a victim's jobs now and then. In a process of its own,
    so that it is not the attacks that it waits for, and from an address of its own, as another caller."""

    def __init__(self, server):
        self.server, self.peak, self.health, self.jobs, self.failed = server, 0, [], [], 0
        ours, theirs = multiprocessing.Pipe()
        self.pipe = ours
        self.process = multiprocessing.get_context("fork").Process(target=self.watch, args=(theirs,))
        self.process.start()

    def stop(self):
        self.pipe.send("stop")
        self.peak, self.health, self.jobs, self.failed = self.pipe.recv()
        self.process.join()

    def watch(self, pipe):
        self.stopping = threading.Event()
        threads = [threading.Thread(target=target) for target in (self.watch_memory, self.watch_health, self.be_a_victim)]
        for thread in threads:
            thread.start()
        pipe.recv()
        self.stopping.set()
        for thread in threads:
            thread.join()
        pipe.send((self.peak, self.health, self.jobs, self.failed))

    def watch_memory(self):
        while not self.stopping.wait(0.01):
            try:
                self.peak = max(self.peak, self.server.memory())
            except OSError:
                return

    def watch_health(self):
        while not self.stopping.wait(0.2):
            begin = time.monotonic()
            try:
                self.server.get("/healthz")
                self.health.append(time.monotonic() - begin)
            except OSError as error:
                self.health.append(float("inf"))
                print("    /healthz:", error)

    def be_a_victim(self):
        body = options() + layer(5)
        while not self.stopping.wait(0.1):
            begin = time.monotonic()
            try:
                connection = Connection(self.server.port, source="127.0.0.2")
                stream = connection.call(SERVICE + "OptimizeBatch", [("authorization", "Bearer victim")])
                connection.send(frame(DATA, END_STREAM, stream, message(body)))
                answered = b""
                connection.socket.settimeout(5)
                while b"grpc-status" not in answered and time.monotonic() - begin < 5:
                    more = connection.socket.recv(65536)
                    if not more:
                        break
                    answered += more
                connection.close()
                if b"grpc-status" in answered and len(answered) > 150:
                    self.jobs.append(time.monotonic() - begin)
                else:
                    self.failed += 1
            except OSError:
                self.failed += 1


def until(end, step):
    while time.monotonic() < end:
        if step() is False:
            return


def rapid_reset(server, end):
    """Calls that are reset at once."""
    connection = Connection(server.port)

    def step():
        nonlocal connection
        block = b""
        for _ in range(100):
            stream = connection.next_stream
            connection.next_stream += 2
            block += frame(HEADERS, END_HEADERS, stream, connection.headers(SERVICE + "Optimize"))
            block += frame(RST_STREAM, 0, stream, struct.pack(">I", 8))
        if not connection.send(block):
            connection.close()
            connection = Connection(server.port)

    until(end, step)
    connection.close()


def resets_of(methods, deadline=None):
    """The same elsewhere: calls that no code of the service sees, or that are late before they are looked at."""
    def attack(server, end):
        dice = random.Random(13)
        connection = None

        def step():
            nonlocal connection
            if connection is None:
                connection = Connection(server.port)
            block = b""
            for _ in range(100):
                stream = connection.next_stream
                connection.next_stream += 2
                extra = [("grpc-timeout", dice.choice(deadline))] if deadline else ()
                block += frame(HEADERS, END_HEADERS, stream, connection.headers(dice.choice(methods), extra))
                if deadline is None:
                    block += frame(RST_STREAM, 0, stream, struct.pack(">I", 8))
            if not connection.send(block):
                connection.close()
                connection = None

        def patient_step():
            try:
                step()
            except OSError:
                time.sleep(0.05)

        until(end, patient_step)
        if connection is not None:
            connection.close()

    return attack


def half_closed(server, end):
    """Streams that end twice, send headers in the middle of a message, data after the end, or windows that overflow."""
    dice = random.Random(17)
    body = message(options("auto") + layer(30) * 5)

    def step():
        connection = Connection(server.port)
        for _ in range(10):
            stream = connection.call(SERVICE + dice.choice(["OptimizeBatch", "Optimize", "ListStrategies"]))
            pieces = [frame(DATA, 0, stream, body[:len(body) // 2]), frame(DATA, END_STREAM, stream, body[len(body) // 2:]),
                      frame(HEADERS, END_HEADERS | END_STREAM, stream, literal("x-late", "1")), frame(DATA, END_STREAM, stream),
                      frame(WINDOW_UPDATE, 0, stream, struct.pack(">I", 0x7FFFFFFF)), frame(DATA, 0, stream + 2, b"early"),
                      frame(RST_STREAM, 0, stream, struct.pack(">I", dice.randrange(20)))]
            dice.shuffle(pieces)
            if not connection.send(b"".join(pieces[:dice.randint(1, len(pieces))])):
                break
        connection.drain(dice.choice([0.001, 0.02]))
        connection.close()

    until(end, step)


def half_prefaces(server, end):
    """Connections that never come to their settings: nothing, half a preface, a handshake of TLS, HTTP/1.1."""
    dice = random.Random(19)
    held = []
    beginnings = [b"", b"PRI * HTTP", b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + bytes(32), b"POST / HTTP/1.1\r\nHost: a\r\n"]

    def step():
        try:
            held.append(socket.create_connection(("127.0.0.1", server.port), timeout=1))
            held[-1].sendall(dice.choice(beginnings))
        except OSError:
            time.sleep(0.02)
        if len(held) > 800:
            held.pop(0).close()

    until(end, step)
    for connection in held:
        connection.close()


def cancelled_uploads(server, end):
    """Messages of 30 MB that are cancelled in the middle, one after the other on one connection."""
    body = message(options() + layer(20_000) * 23)
    connection = Connection(server.port)
    window = Window(connection)

    def step():
        nonlocal connection, window
        stream = connection.call(SERVICE + "OptimizeBatch")
        sent = window.send(stream, body[:len(body) // 2], patience=0.3)
        if not connection.send(frame(RST_STREAM, 0, stream, struct.pack(">I", 8))) or sent == 0:
            connection.close()
            connection = Connection(server.port)
            window = Window(connection)

    until(end, step)
    connection.close()


def validate_only(strategy="auto"):
    """Options of a job that is checked and not done."""
    return field(1, field(2, field(1, strategy.encode())) + b"\x68\x01")


def many_pairs():
    """A node of a hundred thousand paths with as many pairs."""
    count = 60_000
    paths = field(1, field(1, field(2, packed([1.0, 2.0])))) * count
    pairs = b"".join(field(2, b"\x08" + varint(i) + b"\x10" + varint(i + 1)) for i in range(count - 1))
    nodes = field(2, field(3, field(1, b"".join(varint(i + 1) for i in range(count))) + pairs))
    nodes += b"".join(field(2, b"\x08" + varint(i)) for i in range(count))
    return validate_only() + field(2, field(4, paths + nodes))


def names(server, end):
    """Names of jobs and texts of metadata of every kind and length, and options by the thousand."""
    dice = random.Random(23)

    def text():
        return dice.choice([b"\x00", b"\xff" * 300, b"a" * 70_000, b"%", b"\r\nx-y: z", "\u2028".encode() * 100, b"x" * 255, b"\x9b31m"])

    def step():
        connection = Connection(server.port)
        for _ in range(5):
            some = b"".join(field(2, field(1, text()[:dice.choice([1, 100])]) + field(2, text())) for _ in range(dice.choice([0, 3, 2000])))
            body = field(1, field(1, text()) + field(2, field(1, b"auto") + some)) + layer(3)
            extra = [("x-a-bin", "!!!"), ("traceparent", "0" * 55), ("authorization", "Bearer " + "z" * dice.choice([0, 9000]))]
            stream = connection.call(SERVICE + "OptimizeBatch", [dice.choice(extra), ("traverse-message-bytes", dice.choice(
                ["-1", "9" * 30, "0x10", ""]))])
            Window(connection).send(stream, message(body), patience=0.05)
        connection.drain(0.02)
        connection.close()

    until(end, step)


def endless_headers(server, end):
    """CONTINUATION frames without an end."""
    connection = Connection(server.port)
    connection.send(frame(HEADERS, 0, 1, connection.headers(SERVICE + "Optimize")))
    block = b"".join(frame(CONTINUATION, 0, 1, b"".join(literal(f"x-{i}", "v" * 100) for i in range(120))) for _ in range(16))

    def step():
        nonlocal connection
        if not connection.send(block):
            connection.close()
            connection = Connection(server.port)
            connection.send(frame(HEADERS, 0, 1, connection.headers(SERVICE + "Optimize")))

    until(end, step)
    connection.close()


def control_frames(server, end):
    """Pings and settings by the thousand, whose answers nobody reads."""
    connection = Connection(server.port)
    block = (frame(PING, 0, 0, b"12345678") + frame(SETTINGS, 0, 0, struct.pack(">HI", 3, 100))) * 1000

    def step():
        nonlocal connection
        if not connection.send(block):
            connection.close()
            connection = Connection(server.port)

    until(end, step)
    connection.close()


def many_headers(server, end):
    """Header fields by the thousand."""
    connection = Connection(server.port)
    extra = [(f"x-{i}", "") for i in range(1000)]

    def step():
        nonlocal connection
        if not connection.send(frame(HEADERS, END_HEADERS | END_STREAM, connection.next_stream,
                                     connection.headers(SERVICE + "Optimize", extra)[:16000])):
            connection.close()
            connection = Connection(server.port)
        else:
            connection.next_stream += 2

    until(end, step)
    connection.close()


def unfinished(methods, connections, megabytes):
    def attack(server, end):
        def one(method):
            while time.monotonic() < end:
                try:
                    connection = Connection(server.port)
                except OSError:
                    time.sleep(0.05)
                    continue
                stream = connection.call(method)
                body = bytes([0]) + struct.pack(">I", (megabytes << 20) + 1) + bytes(megabytes << 20)
                Window(connection).send(stream, body, patience=0.5)
                while time.monotonic() < end and connection.send(frame(PING, 0, 0, b"12345678")):
                    time.sleep(0.2)
                connection.close()

        threads = [threading.Thread(target=one, args=(methods[i % len(methods)],)) for i in range(connections)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    return attack


def bombs(server, end):
    """A few bytes that unpack to many."""
    body = message(bomb(60), compressed=True)

    def step():
        for method in (SERVICE + "ListStrategies", SERVICE + "OptimizeBatch", HEALTH, REFLECTION):
            connection = Connection(server.port)
            stream = connection.call(method, [("grpc-encoding", "gzip")])
            Window(connection).send(stream, body, patience=0.2)
            connection.drain(0.05)
            connection.close()

    until(end, step)


def empty_islands(server, end):
    """Two bytes for each island, up to the limit of a message."""
    body = message(field(2, field(3, b"") * (15 << 20)))

    def step():
        connection = Connection(server.port)
        stream = connection.call(SERVICE + "OptimizeBatch")
        Window(connection).send(stream, body, patience=1)
        connection.drain(0.3)
        connection.close()

    until(end, step)


def small_contours(server, end):
    """Contours of one point, as many as the limits allow."""
    one = field(2, field(2, packed([1.0, 2.0])))
    body = message(options() + field(2, field(3, one * 500_000)))

    def step():
        connection = Connection(server.port)
        stream = connection.call(SERVICE + "OptimizeBatch")
        Window(connection).send(stream, body, patience=1)
        connection.drain(0.3)
        connection.close()

    until(end, step)


def stated_sizes(server, end):
    """Headers that state a size which never comes."""
    held = []

    def step():
        if len(held) < 40:
            connection = Connection(server.port)
            connection.call(SERVICE + "OptimizeBatch", [("traverse-message-bytes", "2147483647")])
            held.append(connection)
        time.sleep(0.05)

    until(end, step)
    for connection in held:
        connection.close()


def stalled_readers(server, end):
    """Jobs whose callers open no window."""
    held = []
    body = message(options() + layer(200) * 50)
    for _ in range(5):
        connection = Connection(server.port, window=0)
        stream = connection.call(SERVICE + "OptimizeBatch")
        Window(connection).send(stream, body, patience=1)
        held.append(connection)
    time.sleep(max(0.0, end - time.monotonic()))
    for connection in held:
        connection.close()


def idle_connections(server, end):
    """As many connections as there are files, and more."""
    held = []

    def step():
        try:
            held.append(Connection(server.port))
        except OSError:
            time.sleep(0.05)
        if len(held) >= 600:
            time.sleep(0.1)

    until(end, step)
    for connection in held:
        connection.close()


def one_byte_a_time(server, end):
    """A message in single bytes."""
    connection = Connection(server.port)
    stream = connection.call(SERVICE + "OptimizeBatch")
    body = message(options() + layer(3))

    def step():
        for at in range(len(body)):
            if time.monotonic() > end or not connection.send(frame(DATA, 0, stream, body[at:at + 1])):
                return False
            time.sleep(0.005)
        return False

    until(end, step)
    time.sleep(max(0.0, end - time.monotonic()))
    connection.close()


EXTREMES = [0.0, -0.0, 5e-324, 1e-320, 1e-306, 1e-5, 1.0, 1e5, 1e6, 1e7, 1e300, 1.7e308, float("inf"), float("-inf"), float("nan"), -1.0]


def extremes(server, end):
    """Random and extreme values of the cost and of coordinates, for every strategy."""
    dice = random.Random(7)

    def step():
        strategy = dice.choice(["none", "greedy", "ni2opt", "tabu", "exact", "auto", "", "x" * 100])
        cost = b"".join(number(n, dice.choice(EXTREMES)) for n in range(1, 5)) if dice.random() < 0.7 else b""
        scale = dice.choice([1e-6, 1.0, 1e3, 1e6, 1e9])
        points = (lambda: dice.choice(EXTREMES)) if dice.random() < 0.2 else (lambda: dice.uniform(0, scale))
        body = options(strategy, cost) + b"".join(layer(dice.randint(0, 30), points) for _ in range(dice.randint(0, 3)))
        if dice.random() < 0.1:
            body = bytes(dice.randrange(256) for _ in range(dice.randint(0, 200)))
        connection = Connection(server.port)
        stream = connection.call(SERVICE + dice.choice(["OptimizeBatch", "Optimize"]), [("grpc-timeout", "2S")])
        connection.send(frame(DATA, END_STREAM, stream, message(body)))
        connection.drain(0.05)
        connection.close()

    until(end, step)


def cancels(server, end):
    """Large messages that are cancelled while they come in, and just after."""
    dice = random.Random(3)
    body = message(options("auto") + layer(50) * 20)

    def step():
        connection = Connection(server.port)
        for _ in range(10):
            stream = connection.call(SERVICE + dice.choice(["OptimizeBatch", "Optimize"]))
            connection.send(b"".join(frame(DATA, 0, stream, body[at:at + 16384])
                                     for at in range(0, dice.choice([len(body), len(body) // 2]), 16384)))
            time.sleep(dice.choice([0, 0.001, 0.01]))
            connection.send(frame(RST_STREAM, 0, stream, struct.pack(">I", 8)))
        connection.close()

    until(end, step)


def batches(bodies, extra=(), seconds=0.3, window=None):
    """Sends each body as a batch, by a connection each, and waits a moment for the answer."""
    def attack(server, end):
        made = [message(body()) for body in bodies]
        dice = random.Random(5)

        def step():
            connection = Connection(server.port, window)
            stream = connection.call(SERVICE + "OptimizeBatch", extra)
            Window(connection).send(stream, dice.choice(made), patience=1)
            connection.drain(seconds)
            connection.close()

        until(end, step)

    return attack


# Time costs, in which alone walls count: so much for a retraction, a lift and a crossing, and ways around walls.
def time_cost(clearance=0.4):
    return b"".join(number(n, value) for n, value in ((1, 120.0), (2, 3000.0), (3, 0.1), (4, 2.0), (6, 0.1), (7, 1.0), (9, clearance)))


def one_contour(points):
    return field(3, field(2, field(2, packed([coordinate for point in points for coordinate in point]))))


def layer_of(paths):
    contours = b"".join(field(2, field(2, packed([random.uniform(0, 200) for _ in range(8)]))) for _ in range(paths))
    return field(3, contours)


def unknown_fields():
    """Empty texts that no version knows: two bytes each."""
    return options() + field(2, b"\x7a\x00" * (8 << 20))


def unknown_options():
    return field(1, b"\x7a\x00" * (8 << 20)) + layer(3)


def packed_children():
    """Children of a node, a byte each."""
    return options() + field(2, field(4, field(2, field(2, field(1, b"\x01" * (30 << 20))))))


def named_walls():
    """Walls that name a large contour again and again."""
    square = [(float(i), float(i % 2)) for i in range(50_000)]
    return options("greedy", time_cost()) + field(2, one_contour(square) + field(7, b"\x18\x00") * 100_000)


def exposed_paths():
    square = [(float(i), float(i % 2)) for i in range(50_000)]
    return options("greedy", time_cost()) + field(2, one_contour(square) + field(8, b"\x00" * (1 << 20)))


def upright_walls():
    """A wall that goes up and down all over the plate."""
    wall = [coordinate for i in range(400_000) for coordinate in (5e-4 * i, i % 2 * 200.0)]
    return options("greedy", time_cost(0)) + field(2, layer_of(5) + field(7, field(1, packed(wall))))


def clustered_walls():
    """Walls by the hundred thousand in one place, and two far away that make the place small."""
    wall = [coordinate for i in range(100_000) for coordinate in (100 + 1e-4 * (i % 300), 100 + 1e-4 * (i % 7))]
    far = packed([-9e5, -9e5, -9e5, -8e5])
    return options("greedy", time_cost()) + field(2, layer_of(300) + field(7, field(1, packed(wall))) + field(7, field(1, far)))


def barrier(strategy):
    """Half of the paths before a node without any, and that before the others: their pairs are the square of that."""
    def body():
        half = 20_000
        paths = b"".join(field(1, field(1, field(2, packed([random.uniform(0, 200), random.uniform(0, 200)]))))
                         for _ in range(2 * half))
        children = b"".join(varint(i + 1) for i in range(2 * half + 1))
        pairs = b"".join(field(2, b"\x08" + varint(i) + b"\x10" + varint(2 * half)) for i in range(half))
        pairs += b"".join(field(2, b"\x08" + varint(2 * half) + b"\x10" + varint(half + i)) for i in range(half))
        nodes = field(2, field(3, field(1, children) + pairs))
        nodes += b"".join(field(2, b"\x08" + varint(i)) for i in range(2 * half)) + field(2, field(2, b""))
        return options(strategy) + field(2, field(4, paths + nodes))

    return body


def fixed_order():
    """Paths that may not change places: as many steps, and hardly anything to choose."""
    count = 60_000
    dot = field(1, field(1, field(2, packed([100.0, 100.0]))))
    nodes = field(2, field(2, field(1, b"".join(varint(i + 1) for i in range(count)))))
    nodes += b"".join(field(2, b"\x08" + varint(i)) for i in range(count))
    return options("exact") + field(2, field(4, dot * count + nodes))


def two_clouds(strategy):
    """Two contours of many vertices that are in no order: each of the one may go with each of the other."""
    def body():
        cloud = field(2, field(2, packed([random.uniform(0, 200) for _ in range(200_000)])))
        return options(strategy) + field(2, field(3, cloud) + field(3, cloud))

    return body


def large_layers(strategy):
    return lambda: options(strategy) + field(2, field(3, b"".join(
        field(2, field(2, packed([random.uniform(0, 200), random.uniform(0, 200)]))) for _ in range(19_000))))


def paused_searches(server, end):
    """Layers of 19,000 paths by the dozen: each is searched for a moment, and then waits for its turn."""
    body = message(large_layers("auto")())
    held = []

    def step():
        if len(held) < 60:
            connection = Connection(server.port)
            Window(connection).send(connection.call(SERVICE + "OptimizeBatch"), body, patience=0.3)
            held.append(connection)
        time.sleep(0.05)

    until(end, step)
    for connection in held:
        connection.close()


def unread_answers(server, end):
    """Large answers by the dozen that nobody reads."""
    body = message(options("none") + layer(20_000) * 4)
    held = []

    def step():
        if len(held) < 60:
            connection = Connection(server.port, window=0)
            Window(connection).send(connection.call(SERVICE + "OptimizeBatch"), body, patience=0.3)
            held.append(connection)
        time.sleep(0.05)

    until(end, step)
    for connection in held:
        connection.close()


def corners(server, end):
    """Every number of the options at its corners, in both calls, half-closed or not, with deadlines that race."""
    dice = random.Random(11)
    whole = [0, 1, 2, 127, 2**31 - 1, 2**31, 2**32 - 1, 2**63, 2**64 - 1]

    def some_number(at):
        return number(at, dice.choice(EXTREMES)) if dice.random() < 0.6 else varint(at << 3) + varint(dice.choice(whole))

    def some_point():
        return number(1, dice.choice(EXTREMES)) + number(2, dice.choice(EXTREMES))

    def some_duration():
        return b"\x08" + varint(dice.choice(whole)) + b"\x10" + varint(dice.choice(whole))

    def some_options():
        name = dice.choice(["none", "greedy", "ni2opt", "tabu", "exact", "auto"])
        option = dice.choice(["effort", "least_gain_each", "bound", "pure", "point_release", "diversifications", "tenure", "neighbors",
                              "spacing_mm", "relinked", "elite", "patience", "model", "start", "polish", ""])
        value = dice.choice(["0", "-1", "1e308", "nan", "inf", "1e-320", "true", "", "9" * 400, "\x00", "thesis"])
        strategy = field(1, name.encode())
        if dice.random() < 0.4:
            strategy += field(2, field(1, option.encode()) + field(2, value.encode()))
        parts = [field(2, strategy)]
        optional = [lambda: field(1, bytes(dice.randrange(256) for _ in range(dice.choice([1, 300])))),
                    lambda: b"\x18" + varint(dice.choice(whole)), lambda: field(4, some_point()),
                    lambda: field(5, field(1, some_point()) + b"\x10" + varint(dice.choice(whole)) + b"\x18" + varint(dice.choice(whole))),
                    lambda: field(6, field(2, b"".join(some_number(n) for n in range(1, 11)))), lambda: some_number(7),
                    lambda: b"\x40" + varint(dice.choice(whole)), lambda: field(9, some_duration()), lambda: field(10, some_duration()),
                    lambda: b"\x58" + varint(dice.choice(whole)), lambda: b"\x60\x01", lambda: b"\x68\x01"]
        parts += [make() for make in optional if dice.random() < 0.15]
        return field(1, b"".join(parts))

    def step():
        connection = Connection(server.port)
        for _ in range(4):
            body = some_options() + b"".join(layer(dice.randint(0, 12)) for _ in range(dice.randint(0, 3)))
            deadline = dice.choice(["1n", "1u", "5m", "20m", "50m", "1S", "99999999H"])
            stream = connection.call(SERVICE + dice.choice(["OptimizeBatch", "Optimize"]), [("grpc-timeout", deadline)])
            connection.send(frame(DATA, dice.choice([0, END_STREAM]), stream, message(body)))
            if dice.random() < 0.3:
                connection.send(frame(RST_STREAM, 0, stream, struct.pack(">I", 8)))
        connection.drain(dice.choice([0.001, 0.03]))
        connection.close()

    until(end, step)


def many_channels(server, end):
    """New connections as fast as they come, with a call each."""
    def step():
        connection = Connection(server.port)
        connection.call(SERVICE + "ListStrategies", [(f"x-{i}", "v" * 500) for i in range(20)], END_HEADERS | END_STREAM)
        connection.close()

    until(end, step)


ATTACKS = {
    "rapid_reset": rapid_reset,
    "resets_elsewhere": resets_of([HEALTH, REFLECTION, "/no.such.Service/Method", SERVICE + "ListStrategies"]),
    "late_calls": resets_of([SERVICE + "Optimize", SERVICE + "OptimizeBatch"], ["1n", "1u", "1m"]),
    "half_closed": half_closed,
    "half_prefaces": half_prefaces,
    "cancelled_uploads": cancelled_uploads,
    "validate_only": batches([many_pairs, lambda: validate_only() + layer(200_000)]),
    "names": names,
    "endless_headers": endless_headers,
    "control_frames": control_frames,
    "many_headers": many_headers,
    "unfinished_strangers": unfinished([HEALTH, REFLECTION, SERVICE + "ListStrategies"], 12, 60),
    "unfinished_batches": unfinished([SERVICE + "OptimizeBatch", SERVICE + "Optimize"], 22, 60),
    "oversize": unfinished([SERVICE + "OptimizeBatch"], 3, 300),
    "bombs": bombs,
    "empty_islands": empty_islands,
    "small_contours": small_contours,
    "stated_sizes": stated_sizes,
    "stalled_readers": stalled_readers,
    "idle_connections": idle_connections,
    "one_byte_a_time": one_byte_a_time,
    "extremes": extremes,
    "cancels": cancels,
    "unknown_fields": batches([unknown_fields, unknown_options]),
    "packed_children": batches([packed_children]),
    "named_walls": batches([named_walls, exposed_paths]),
    "upright_walls": batches([upright_walls]),
    "clustered_walls": batches([clustered_walls]),
    "barriers": batches([barrier("auto"), barrier("tabu"), barrier("exact")], seconds=1),
    "fixed_order": batches([fixed_order], seconds=1),
    "two_clouds": batches([two_clouds("auto"), two_clouds("tabu"), two_clouds("exact")], seconds=1),
    "paused_searches": paused_searches,
    "unread_answers": unread_answers,
    "corners": corners,
    "many_channels": many_channels,
}


def still_held(server):
    """What the server holds for callers who have gone, five seconds later."""
    held = [f"traverse_{name} 0" for name in ("queue_layers", "queue_points", "jobs_in_flight", "workers_busy", "connections",
                                              'memory_bytes{kind="receiving"}', 'memory_bytes{kind="jobs"}')]
    end = time.monotonic() + 5
    while held and time.monotonic() < end:
        told = server.get("/metrics").splitlines()
        held = [line for line in held if line not in told]
        time.sleep(0.1)
    return [f"it still holds what {line[:-2]} counts" for line in held]


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
        refused = {line.split('"')[1]: int(float(line.split()[-1])) for line in server.get("/metrics").splitlines()
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


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--seconds", type=float, default=3)
    arguments.add_argument("--only", default=",".join(ATTACKS))
    arguments.add_argument("--max_memory", type=int, default=400_000_000)
    arguments.add_argument("--most_p99", type=float, default=float("inf"))
    arguments.add_argument("--twice", action="store_true")
    given = arguments.parse_args()
    found = {}
    for name in given.only.split(","):
        for _ in range(2 if given.twice else 1):
            faults = run(name, given.seconds, given.max_memory, given.most_p99)
            if not faults:
                break
            print(f"  {name}: FAULT: {'; '.join(faults)}")
        if faults:
            found[name] = faults
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
