"""Attacks by messages that the service reads: strange, large, cancelled, late, or never answered."""
import random
import struct
import time

from attacks.requests import layer, number, options
from attacks.transport import until
from http2_client import DATA, END_STREAM, RST_STREAM, SERVICE, Connection, Window, field, frame, message, varint

EXTREMES = [0.0, -0.0, 5e-324, 1e-320, 1e-306, 1e-5, 1.0, 1e5, 1e6, 1e7, 1e300, 1.7e308, float("inf"), float("-inf"), float("nan"), -1.0]


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


def half_characters(server, end):
    """Texts that are too long and end, where they are cut, in the middle of a character; and characters that turn others."""
    turning = b"\xe2\x80\xae\xe2\x81\xa6\xd8\x9c"

    def step():
        connection = Connection(server.port)
        for begin in range(4):
            text = b"a" * begin + turning + "\u20ac".encode() * 400
            for strategy in (field(1, text), field(1, b"greedy") + field(2, field(1, b"pure") + field(2, text)),
                             field(1, b"greedy") + field(2, field(1, text) + field(2, b"1"))):
                stream = connection.call(SERVICE + "OptimizeBatch")
                body = field(1, field(1, turning + b"a" * begin) + field(2, strategy)) + layer(3)
                connection.send(frame(DATA, END_STREAM, stream, message(body)))
        connection.drain(0.02)
        connection.close()

    until(end, step)


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


def open_jobs(body, window=None, most=60, callers=1):
    """Jobs whose connections stay open to the end; with a window of 0 nobody reads their answers."""
    def attack(server, end):
        made = message(body())
        held = []

        def step():
            if len(held) < most:
                connection = Connection(server.port, window, source=f"127.0.1.{1 + len(held) % callers}")
                Window(connection).send(connection.call(SERVICE + "OptimizeBatch"), made, patience=0.3)
                held.append(connection)
            time.sleep(3 / most)

        until(end, step)
        for connection in held:
            connection.close()

    return attack


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
