"""Callers of all methods who leave at any moment: what they send, how they stop, and how they go.

Each caller makes a few calls on a connection, some of them cut short or late, with a window that is shut, of a few bytes, or
open. Then it resets some, opens windows, reads a little or ends its side; and it closes the connection, or keeps it open and
reads no more.
"""
import json
import random
import re
import socket
import struct
import time

from attacks.files import open_http
from attacks.jobs import ENDLESS, endless_infill
from attacks.requests import layer, options
from attacks.transport import HEALTH, REFLECTION, WATCH
from gateway_process import form, lines_of_infill
from http2_client import (DATA, END_STREAM, GCODE_SERVICE, GOAWAY, PING, RST_STREAM, SERVICE, SETTINGS, WINDOW_UPDATE,
                          Connection, field, frame, message, varint)

WINDOWS = [0, 0, 5, 100, 1000, None, None, None]
DEADLINES = ["1m", "20m", "100m", "500m", "2S"]
PAUSES = [0, 0, 0.001, 0.01, 0.1, 0.4]
KEPT = 0.05  # of all connections
NEW_ID = re.compile(rb"[\w.-]+-[0-9a-f]{56}")


def cut(dice, data):
    return data if dice.random() < 0.85 else data[:dice.randrange(len(data) + 1)]


def leave(dice, connection):
    """Closes a connection: at once, by a reset, or first only the side that sends."""
    with connection:
        way = dice.choice(["close", "reset", "half"])
        if way == "reset":
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        elif way == "half":
            connection.shutdown(socket.SHUT_WR)
            time.sleep(dice.random() * 0.1)


class Leavers:
    """Callers of one program. A subclass has its calls: `some_call` returns a method and messages.

    `visit` is one connection; it returns the socket if the caller keeps it open.
    """

    endless = ()  # Messages of jobs that end only with their call, not when nobody reads.

    def __init__(self, program):
        self.program = program

    def visit_by_grpc(self, dice, source):
        connection = Connection(self.program.port, dice.choice(WINDOWS), source)
        connection.socket.settimeout(2)
        stays = dice.random() < KEPT
        streams = []
        for _ in range(dice.choice([1, 1, 3, 8])):
            method, messages = self.some_call(dice, source)
            late = dice.random() < 0.3 or stays and messages in self.endless
            streams.append(connection.call(method, [("grpc-timeout", dice.choice(DEADLINES))] if late else []))
            sent = cut(dice, messages)
            connection.data(streams[-1], sent, end=sent == messages and dice.random() < 0.9)
            if dice.random() < 0.5:
                self.change_mind(dice, source, connection, streams)
        for _ in range(dice.randrange(4)):
            self.change_mind(dice, source, connection, streams)
        if stays:
            return connection.socket
        leave(dice, connection.socket)
        return None

    def change_mind(self, dice, source, connection, streams):
        """Reads a little, or sends what changes a call or the connection."""
        time.sleep(dice.choice(PAUSES))
        if dice.random() < 0.25:
            self.learn(source, connection.drain(dice.choice([0.01, 0.1, 0.3])))
            return
        stream = dice.choice(streams)
        reset = frame(RST_STREAM, 0, stream, struct.pack(">I", dice.choice([0, 2, 7, 8, 8, 8, 11])))
        opened = frame(WINDOW_UPDATE, 0, stream, struct.pack(">I", dice.choice([1, 50, 1000, 70_000])))
        resized = frame(SETTINGS, 0, 0, struct.pack(">HI", 4, dice.choice([0, 10, 200, 1 << 20])))
        half_closed = frame(DATA, END_STREAM, stream)
        ping, go_away = frame(PING, 0, 0, bytes(8)), frame(GOAWAY, 0, 0, bytes(8))
        connection.send(dice.choice([reset] * 4 + [opened, resized, half_closed] * 2 + [ping, go_away]))

    def learn(self, source, answer):
        """What a caller at `source` takes from an answer that it did read."""


class ServerLeavers(Leavers):
    visit = Leavers.visit_by_grpc

    def __init__(self, program, dice):
        super().__init__(program)
        small, middle, large = (layer(paths, lambda: dice.uniform(0, 200)) for paths in (3, 60, 600))
        bad = field(2, field(3, field(2, field(2, b""))))  # a contour without points
        partial = field(1, field(2, field(1, b"ni2opt")) + b"\x70\x01")
        batches = [options(strategy) + layers for strategy in ("none", "greedy", "ni2opt", "auto")
                   for layers in (b"", small, small * 4 + middle, small * 200, bad)]
        batches += [partial + (bad + small) * 100, dice.randbytes(200), b""]
        self.endless = tuple(message(options(strategy) + large) for strategy in ("exact", "tabu"))
        self.batches = [message(batch) for batch in batches]
        self.streams = [begin + more for begin in self.batches for more in (b"", message(small) * 5, message(bad))]

    def some_call(self, dice, source):
        method = dice.choice(["Optimize"] * 6 + ["OptimizeBatch"] * 6 + ["ListStrategies", HEALTH, WATCH, REFLECTION])
        if method not in ("Optimize", "OptimizeBatch"):
            return method if method.startswith("/") else SERVICE + method, message(b"")
        if dice.random() < 0.1:
            return SERVICE + method, dice.choice(self.endless)
        return SERVICE + method, dice.choice(self.streams if method == "Optimize" else self.batches)


ENDLESS_OPTIONS = field(3, field(1, b"tabu") + b"".join(field(2, field(1, name) + field(2, value)) for name, value in (
    (b"evaluations", b"0"), (b"diversifications", b"1000000")))) + field(7, b"\x08" + varint(1000))
REPORT = b"\x40\x01"
LAYERS_THAT_ARE_NOT_THERE = varint(5 << 3) + varint(9) + varint(6 << 3) + varint(9)


class GatewayLeavers(Leavers):
    """Callers by gRPC and HTTP in turn, who ask for each other's jobs now and then."""

    def __init__(self, program, dice):
        super().__init__(program)
        self.jobs = []  # (address of who began it, id)
        self.endless_file = endless_infill()
        small, middle = lines_of_infill(2), lines_of_infill(40)
        self.files = [small] * 4 + [middle, small[:len(small) // 2], b"nothing of a slicer\n", b""]
        squares = [{"contours": [{"points": [x, y, x + 2, y, x + 2, y + 2, x, y + 2]}]} for x in range(0, 90, 30)
                   for y in range(0, 60, 20)]
        self.layers = json.dumps({"layers": [{"id": number, "islands": squares} for number in range(6)]}).encode()

    def visit(self, dice, source):
        return self.visit_by_grpc(dice, source) if dice.random() < 0.5 else self.visit_by_http(dice, source)

    def learn(self, source, answer):
        self.jobs += [(source, name) for name in NEW_ID.findall(answer)]

    def some_job(self, dice, source):
        known = [name for address, name in self.jobs[-200:] if address == source or dice.random() < 0.03]
        return dice.choice(known[-8:]) if known else b"never-begun"

    def some_file(self, dice):
        return self.endless_file if dice.random() < 0.015 else dice.choice(self.files)

    def some_call(self, dice, source):
        method = dice.choice(["Rewrite"] * 4 + ["CreateJob"] * 3 + ["WatchJob"] * 3 + ["Inspect", "Verify", "ReadJob"] * 2
                             + ["GetJob", "CancelJob"])
        if method in ("Rewrite", "CreateJob"):
            content = self.some_file(dice)
            chosen = dice.choice([b"", b"", REPORT, LAYERS_THAT_ARE_NOT_THERE, field(1, b"part.gcode")])
            chosen = ENDLESS_OPTIONS if content is self.endless_file else chosen
            if method == "CreateJob":
                chosen = field(1, chosen) + (field(2, b"key%d" % dice.randrange(6)) if dice.random() < 0.4 else b"")
            messages = message(field(1, chosen)) + message(field(2, content))
        elif method == "Inspect":
            messages = message(field(2, self.some_file(dice)))
        elif method == "Verify":
            messages = message(field(1, self.some_file(dice))) + message(field(2, self.some_file(dice)))
        else:
            messages = message(field(1, self.some_job(dice, source)))
        return GCODE_SERVICE + method, messages

    def some_request(self, dice, source):
        """A request of HTTP."""
        head = f" HTTP/1.1\r\nHost: 127.0.0.1\r\nAccept: {dice.choice(['*/*', 'text/event-stream', 'application/json'])}\r\n"
        if dice.random() < 0.4:
            path = "/v1/jobs/" + self.some_job(dice, source).decode() + dice.choice(["", "", "/file", "/report"])
            return (dice.choice(["GET", "GET", "GET", "HEAD", "DELETE"]) + f" {path}{head}\r\n").encode()
        path = dice.choice(["/v1/gcode", "/v1/jobs"] * 3 + ["/v1/inspect", "/v1/verify", "/v1/optimize"])
        body = self.some_file(dice)
        if path in ("/v1/gcode", "/v1/jobs"):
            some = ["", "?report=true", "?policy=free", "?policy=none", "?deadline=50ms"]
            path += ENDLESS if body is self.endless_file else dice.choice(some)
            head += f"Idempotency-Key: key{dice.randrange(6)}\r\n" if dice.random() < 0.3 else ""
        elif path == "/v1/verify":
            body, headers = form([("original", "a.gcode", body), ("optimised", "b.gcode", self.some_file(dice))])
            head += f"Content-Type: {headers['Content-Type']}\r\n"
        elif path == "/v1/optimize":
            body = self.layers
            head += "Content-Type: application/json\r\n"
        if dice.random() < 0.3:
            head += "Transfer-Encoding: chunked\r\n"
            body = (b"%x\r\n%s\r\n" % (len(body), body) if body else b"") + b"0\r\n\r\n"
        else:
            head += f"Content-Length: {len(body)}\r\n"
        return f"POST {path}{head}\r\n".encode() + body

    def visit_by_http(self, dice, source):
        connection = open_http(self.program, source)
        if dice.random() < 0.3:
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        try:
            for _ in range(dice.choice([1, 1, 2, 4])):
                connection.sendall(cut(dice, self.some_request(dice, source)))
                time.sleep(dice.choice(PAUSES))
                if dice.random() < 0.5:
                    connection.settimeout(dice.choice([0.05, 0.3, 1]))
                    self.learn(source, connection.recv(65536))
        except OSError:
            pass  # Not read in time, or closed by the gateway.
        if dice.random() < KEPT:
            return connection
        leave(dice, connection)
        return None
