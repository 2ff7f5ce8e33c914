"""Frames of HTTP/2 and messages of gRPC by hand, for callers who do not keep the rules.

Headers are sent as literals without indexing, so that no table of HPACK is needed; what comes back is read as frames and not
decoded, but for the status of a call, which gRPC writes as a literal or indexes: `trailers` looks for nothing but its bytes.
"""
import gzip
import socket
import struct

PREFACE = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"
DATA, HEADERS, RST_STREAM, SETTINGS, PING, GOAWAY, WINDOW_UPDATE, CONTINUATION = 0, 1, 3, 4, 6, 7, 8, 9
END_STREAM, END_HEADERS, ACK = 1, 4, 1
SERVICE = "/traverse.v1.RouteOptimizerService/"
GCODE_SERVICE = "/traverse.v1.GcodeService/"


def frame(kind, flags, stream, payload=b""):
    return struct.pack(">I", len(payload))[1:] + bytes([kind, flags]) + struct.pack(">I", stream) + payload


def literal(name, value):
    name, value = name.encode(), value.encode()

    def string(text):
        if len(text) < 127:
            return bytes([len(text)]) + text
        rest, size = len(text) - 127, b"\x7f"
        while rest >= 128:
            size += bytes([rest % 128 + 128])
            rest //= 128
        return size + bytes([rest]) + text

    return b"\x00" + string(name) + string(value)


def message(body, compressed=False):
    return bytes([compressed]) + struct.pack(">I", len(body)) + body


def varint(number):
    out = b""
    while number > 127:
        out += bytes([number % 128 + 128])
        number //= 128
    return out + bytes([number])


def field(number, body):
    """A field of bytes, text or a message."""
    return varint(number << 3 | 2) + varint(len(body)) + body


def bomb(megabytes):
    """gzip that unpacks to so many megabytes of unknown fields."""
    return gzip.compress(bytes(megabytes << 20), 6)


class Connection:
    def __init__(self, port, window=None, source="127.0.0.1"):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=10, source_address=(source, 0))
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.next_stream = 1
        settings = b"" if window is None else struct.pack(">HI", 4, window)
        self.socket.sendall(PREFACE + frame(SETTINGS, 0, 0, settings))

    def close(self):
        self.socket.close()

    def send(self, data):
        """Whether the server took it; it may have had enough."""
        try:
            self.socket.sendall(data)
            return True
        except OSError:
            return False

    def headers(self, method, extra=()):
        pairs = [(":method", "POST"), (":scheme", "http"), (":path", method), (":authority", "a"), ("te", "trailers"),
                 ("content-type", "application/grpc"), *extra]
        return b"".join(literal(name, value) for name, value in pairs)

    def call(self, method, extra=(), flags=END_HEADERS):
        stream = self.next_stream
        self.next_stream += 2
        self.send(frame(HEADERS, flags, stream, self.headers(method, extra)))
        return stream

    def data(self, stream, data, end=False):
        """Sends data as the window of the peer allows, for as long as it goes on opening it."""
        return all(self.send(frame(DATA, 0, stream, data[at:at + 16384])) for at in range(0, len(data), 16384)) and (
            not end or self.send(frame(DATA, END_STREAM, stream)))

    def drain(self, seconds):
        """What the server has sent by then."""
        self.socket.settimeout(seconds)
        got = b""
        try:
            while True:
                more = self.socket.recv(65536)
                if not more:
                    return got
                got += more
                if len(got) > 1 << 22:
                    return got
        except OSError:
            return got


class Window:
    """What a peer lets in: read from its frames, so that a long message can be sent as a client would."""

    def __init__(self, connection):
        self.connection, self.left, self.streams, self.initial, self.rest = connection, 65535, {}, 65535, b""
        self.ended = False  # a stream was ended by the peer

    def read(self, seconds):
        self.connection.socket.settimeout(seconds)
        try:
            more = self.connection.socket.recv(65536)
        except TimeoutError:
            return True
        except OSError:
            return False
        self.rest += more
        while len(self.rest) >= 9:
            size = int.from_bytes(self.rest[:3], "big")
            if len(self.rest) < 9 + size:
                break
            kind, flags, stream = self.rest[3], self.rest[4], int.from_bytes(self.rest[5:9], "big") & 0x7FFFFFFF
            body, self.rest = self.rest[9:9 + size], self.rest[9 + size:]
            if kind == WINDOW_UPDATE:
                more_window = int.from_bytes(body, "big")
                if stream == 0:
                    self.left += more_window
                else:
                    self.streams[stream] = self.streams.get(stream, self.initial) + more_window
            elif kind == SETTINGS and not flags & ACK:
                for at in range(0, size, 6):
                    name, value = struct.unpack(">HI", body[at:at + 6])
                    if name == 4:
                        self.streams = {s: w + value - self.initial for s, w in self.streams.items()}
                        self.initial = value
                self.connection.send(frame(SETTINGS, ACK, 0))
            elif kind == PING and not flags & ACK:
                self.connection.send(frame(PING, ACK, 0, body))
            self.ended |= kind == RST_STREAM or kind in (HEADERS, DATA) and flags & END_STREAM != 0
            if kind in (RST_STREAM, GOAWAY):
                return False
        return bool(more)

    def send(self, stream, data, patience=3.0):
        """Sends data within the windows. Returns how much went out before the peer would have no more."""
        sent = 0
        while sent < len(data):
            room = min(self.left, self.streams.get(stream, self.initial), 16384, len(data) - sent)
            if room <= 0:
                before = (self.left, self.streams.get(stream, self.initial))
                if not self.read(patience) or before == (self.left, self.streams.get(stream, self.initial)):
                    return sent
                continue
            if not self.connection.send(frame(DATA, 0, stream, data[sent:sent + room])):
                return sent
            sent += room
            self.left -= room
            self.streams[stream] = self.streams.get(stream, self.initial) - room
        return sent
