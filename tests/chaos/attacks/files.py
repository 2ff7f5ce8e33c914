"""Attacks on the gateway by what it is sent: bodies that never end, files that unpack to much, and hoarded places."""
import gzip
import http.client
import lzma
import random
import socket
import struct
import threading
import time
import zlib

from attacks.attacked_server import infill
from attacks.transport import patiently, until
from http2_client import DATA, END_STREAM, GCODE_SERVICE, RST_STREAM, Connection, Window, field, frame, message, varint


def open_http(server, source="127.0.0.1"):
    return socket.create_connection(("127.0.0.1", server.http_port), timeout=1, source_address=(source, 0))


def held_heads(beginning, most=700, addresses=1, pause=0.0):
    """Connections that say no more than this."""
    def attack(server, end):
        held = []

        def step():
            if len(held) >= most:
                held.pop(0).close()
            held.append(open_http(server, f"127.0.1.{1 + len(held) % addresses}"))
            held[-1].sendall(beginning)
            time.sleep(pause)

        until(end, patiently(step))
        for connection in held:
            connection.close()

    return attack


def unfinished_uploads(sent, addresses=1, most=200, chunked=False):
    """Bodies of which `sent` bytes come, and then a byte now and then."""
    head = b"Transfer-Encoding: chunked" if chunked else b"Content-Length: 200000000"
    body = b"%x\r\n" % 200_000_000 if chunked else b""

    def attack(server, end):
        held = []

        def step():
            if len(held) < most:
                connection = open_http(server, f"127.0.1.{1 + len(held) % addresses}")
                connection.sendall(b"POST /v1/gcode HTTP/1.1\r\nHost: 127.0.0.1\r\n" + head + b"\r\n\r\n" + body + b";" * sent)
                held.append(connection)
            for connection in list(held):
                try:
                    connection.send(b";")
                except OSError:
                    held.remove(connection)
            time.sleep(0.02)

        until(end, patiently(step))
        for connection in held:
            connection.close()

    return attack


def leave_unread(server, end, request, addresses=1):
    """Sends `request` on connections, a hundred of which stay open at a time, and nobody reads an answer."""
    held = []

    def step():
        connection = open_http(server, f"127.0.1.{1 + len(held) % addresses}")
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
        connection.setblocking(False)
        connection.send(request)
        held.append(connection)
        if len(held) > 100:
            held.pop(0).close()
        time.sleep(0.01)

    until(end, patiently(step))
    for connection in held:
        connection.close()


def unread_answers(server, end):
    """Pipelined requests whose answers nobody reads."""
    body = infill(300)
    leave_unread(server, end, (b"POST /v1/gcode?strategy=none HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: %d\r\n\r\n" % len(body) + body) * 20)


def readers_that_go(server, end):
    """Files, good and refused, whose readers let no answer in, or a few bytes, or all, and leave at any moment."""
    dice = random.Random(53)
    contents = infill(2), infill(15), b"nothing of a slicer\n"
    layers_that_are_not_there = varint(5 << 3) + varint(9) + varint(6 << 3) + varint(9)
    calls = [("Rewrite", message(field(1, options)) + message(field(2, content)))
             for options in (b"", layers_that_are_not_there) for content in contents]
    calls += [("CreateJob", message(field(1, b"")) + message(field(2, content))) for content in contents]
    calls += [("Inspect", message(field(2, content))) for content in contents]
    calls += [("Verify", message(field(1, content)) + message(field(2, content))) for content in contents]

    def step():
        connection = Connection(server.port, window=dice.choice([0, 5, None]))
        for _ in range(5):
            method, messages = dice.choice(calls)
            stream = connection.call(GCODE_SERVICE + method)
            connection.send(frame(DATA, END_STREAM, stream, messages))
            time.sleep(dice.choice([0, 0.001, 0.01, 0.1]))
            if dice.randrange(4):
                connection.send(frame(RST_STREAM, 0, stream, struct.pack(">I", 8)))
        connection.close()

    until(end, patiently(step))


def rubbish(server, end):
    """Heads and forms that break the rules of HTTP/1.1."""
    dice = random.Random(31)
    host = b"Host: 127.0.0.1\r\n"
    requests = [b"GET / HTTP/1.1\r\n\r\n", b"GET / HTTP/1.1\r\n" + host * 2 + b"\r\n", b"GET http://127.0.0.1/ HTTP/1.1\r\n" + host + b"\r\n",
                b"POST /v1/gcode HTTP/1.1\r\n" + host + b"Expect: 100-Continue\r\nContent-Length: 5\r\n\r\nG1 X1",
                b"GET / HTTP/1.1\r\n" + host + b"A: b\r\n c\r\n\r\n", b"GET /" + b"a" * 100_000, b"\x16\x03\x01" + bytes(50),
                b"POST /v1/gcode HTTP/1.1\r\n" + host + b"Transfer-Encoding: chunked\r\n\r\n" + b"1;" + b"x" * 9000 + b"\r\n;\r\n" * 99,
                b"POST /v1/gcode HTTP/1.1\r\n" + host + b"Transfer-Encoding: chunked\r\nContent-Length: 4\r\n\r\n0\r\n\r\n",
                b"POST /v1/gcode HTTP/1.1\r\n" + host + b"Content-Length: 99999999999999999999\r\n\r\n", dice.randbytes(3000),
                b"POST /v1/gcode HTTP/1.1\r\n" + host + b"Content-Type: multipart/form-data; boundary=a\r\nContent-Length: 200000\r\n\r\n"
                + b'--a\r\nContent-Disposition: form-data; name="x"\r\n\r\n1\r\n' * 3000]

    def step():
        connection = open_http(server)
        connection.sendall(dice.choice(requests))
        connection.settimeout(0.02)
        try:
            connection.recv(4096)
        finally:
            connection.close()

    until(end, patiently(step))


def posts(makers, callers=4, path="/v1/gcode?strategy=greedy", content_type="application/octet-stream"):
    """Files, one after the other, by several callers at a time, each of whom waits for a moment and goes."""
    def attack(server, end):
        bodies = [maker() for maker in makers]

        def one(number):
            dice = random.Random(number)
            while time.monotonic() < end:
                connection = http.client.HTTPConnection("127.0.0.1", server.http_port, timeout=3)
                try:
                    connection.request("POST", path, dice.choice(bodies),
                                       {"Authorization": f"Bearer {number}", "Content-Type": content_type})
                    connection.getresponse().read()
                except (OSError, http.client.HTTPException):
                    time.sleep(0.02)
                finally:
                    connection.close()

        threads = [threading.Thread(target=one, args=(i,)) for i in range(callers)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    return attack


def stated_meatpack(stated=1_500_000_000):
    """A binary G-code whose block of MeatPack, compressed by deflate, states gigabytes."""
    packed = zlib.compress(bytes(1 << 20) * 200, 9)
    def block(kind, parameters, data, compression=0, size=None):
        head = struct.pack("<HHI", kind, compression, len(data) if size is None else size)
        if compression:
            head += struct.pack("<I", len(data))
        body = head + parameters + data
        return body + struct.pack("<I", zlib.crc32(body))
    return (b"GCDE" + struct.pack("<IH", 1, 1) + block(3, struct.pack("<H", 0), b"Producer=PrusaSlicer 2.7.0\n")
            + block(4, struct.pack("<H", 0), b"a=b\n") + block(2, struct.pack("<H", 0), b"a=b\n")
            + block(1, struct.pack("<H", 2), packed, compression=1, size=stated))


def large_dictionary():
    filters = [{"id": lzma.FILTER_LZMA2, "preset": 6, "dict_size": 500 << 20}]
    return lzma.compress(infill(20) + bytes(200 << 20), format=lzma.FORMAT_XZ, filters=filters)


def gzip_bomb():
    return gzip.compress(bytes(250 << 20), 9)


def gzip_text():
    return gzip.compress(infill(20) + b"G1X1Y1E1\n" * 3_000_000, 9)


def many_parts():
    """A form of empty fields."""
    return b"--b\r\nContent-Disposition: form-data; name=\"a\"\r\n\r\n\r\n" * 200_000 + b"--b--\r\n"


def boundaries_but_for_a_letter():
    """A part full of beginnings of the boundary that ends it."""
    head = b"--" + BOUNDARY + b"\r\nContent-Disposition: form-data; name=\"file\"; filename=\"a.gcode\"\r\n\r\n"
    return head + (b"\r\n--" + BOUNDARY[1:]) * 400_000 + b"\r\n--" + BOUNDARY + b"--\r\n"


BOUNDARY = b"a" * 70


def tiny_chunks(server, end):
    """Bodies in chunks of one byte, as fast as they are taken."""
    piece = b"1\r\n;\r\n" * 40_000

    def one(number):
        def step():
            with open_http(server, f"127.0.1.{number}") as connection:
                connection.sendall(b"POST /v1/inspect HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\n")
                while time.monotonic() < end:
                    connection.sendall(piece)

        until(end, patiently(step))

    threads = [threading.Thread(target=one, args=(i,)) for i in range(1, 5)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def dense():
    return infill(2) + b"G1X1Y1E1\nG1X2Y1E1\n" * 900_000


def short_lines():
    return infill(2) + b"\n" * 16_000_000


def long_line():
    return infill(2) + b";" + b"a" * 16_000_000 + b"\n"


def tools():
    return infill(2) + b"".join(b"T%d\nG1 X%d Y1 E1\n" % (i, i % 100) for i in range(200_000))


def crossings(lines=12_000):
    """Infill whose lines all cross each other."""
    out = [b"; generated by PrusaSlicer 2.5.0 on x\n\nM83\n;LAYER_CHANGE\n;Z:1\nG1 Z1 F9000\n;TYPE:Internal infill\n"]
    for i in range(lines):
        x = i * 200 / lines
        out.append(b"G1 X%.3f Y0 F9000\nG1 F1200\nG1 X%.3f Y200 E9\n" % (x, 200 - x))
    return b"".join(out)


def verify(maker):
    """The same file twice, as a form."""
    body = maker()
    part = b'--a\r\nContent-Disposition: form-data; name="%s"; filename="a.gcode"\r\n\r\n%s\r\n'
    form = part % (b"original", body) + part % (b"optimised", body) + b"--a--\r\n"

    def attack(server, end):
        while time.monotonic() < end:
            connection = http.client.HTTPConnection("127.0.0.1", server.http_port, timeout=3)
            try:
                connection.request("POST", "/v1/verify", form, {"Content-Type": "multipart/form-data; boundary=a"})
                connection.getresponse().read()
            except (OSError, http.client.HTTPException):
                time.sleep(0.02)
            finally:
                connection.close()

    return attack


def hoarded_places(callers=5, each=64):
    """Calls that hold a place and send nothing more."""
    def attack(server, end):
        held = []

        def step():
            if len(held) < callers:
                connection = Connection(server.port, source=f"127.0.1.{1 + len(held)}")
                for _ in range(each):
                    Window(connection).send(connection.call(GCODE_SERVICE + "Inspect"), message(field(1, b"a.gcode")), patience=0.01)
                held.append(connection)
            time.sleep(0.01)

        until(end, patiently(step))
        for connection in held:
            connection.close()

    return attack
