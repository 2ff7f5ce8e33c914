"""Connections to the gateway on the wire: slow ones, cut ones, strange ones.

The environment names the binaries: TRAVERSE and TRAVERSE_GATEWAY.
"""
import gzip
import os
import socket
import sys
import time
import unittest

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
from gateway_process import Gateway, lines_of_infill

PART = lines_of_infill(3)


class Sockets(unittest.TestCase):
    """What happens on the wire: raw sockets to the gateway that `flags` start."""

    flags = ()

    @classmethod
    def setUpClass(cls):
        cls.gateway = Gateway(*cls.flags)

    @classmethod
    def tearDownClass(cls):
        cls.gateway.close()

    def connect(self):
        connection = socket.create_connection(("127.0.0.1", self.gateway.http_port), timeout=20)
        self.addCleanup(connection.close)
        return connection

    def answer(self, connection):
        connection.settimeout(20)
        text = b""
        while True:
            try:
                piece = connection.recv(65536)
            except ConnectionResetError:
                break
            if not piece:
                break
            text += piece
        return text

    def status(self, connection):
        return self.answer(connection).split(b"\r\n")[0]


class Patience(Sockets):
    """Clients that take their time are given up."""

    flags = ("--idle_timeout=1s", "--header_timeout=1s", "--min_upload_rate=100000")

    def test_a_body_that_stops_is_given_up(self):
        connection = self.connect()
        connection.sendall(b"POST /v1/gcode HTTP/1.1\r\nHost: x\r\nContent-Length: 1000\r\n\r\nG1")
        self.assertIn(b"408", self.status(connection))  # within the 20 seconds of answer()

    def test_a_body_that_drips_is_given_up(self):
        connection = self.connect()
        connection.sendall(b"POST /v1/gcode HTTP/1.1\r\nHost: x\r\nContent-Length: 100000\r\n\r\n")
        with self.assertRaises((BrokenPipeError, ConnectionResetError)):
            for _ in range(200):
                connection.sendall(b"G1 X1\n")
                time.sleep(0.1)

    def test_an_answer_that_is_read_too_slowly_is_given_up(self):
        gateway = Gateway("--idle_timeout=1s", "--min_upload_rate=4000000")
        self.addCleanup(gateway.close)
        body = PART + b"; of no layer\n" * 500_000  # longer than what sockets hold
        connection = socket.socket()
        self.addCleanup(connection.close)
        connection.settimeout(60)
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 65536)
        connection.connect(("127.0.0.1", gateway.http_port))
        connection.sendall(b"POST /v1/gcode?strategy=greedy HTTP/1.1\r\nHost: x\r\n"
                           b"Content-Length: %d\r\n\r\n" % len(body) + body)
        connection.recv(1000)
        try:
            for _ in range(100):  # a little all the time
                time.sleep(0.1)
                if not connection.recv(10000):
                    break
        except ConnectionResetError:
            pass
        deadline = time.time() + 5
        while gateway.metric("traverse_gateway_spool_bytes") > 0 and time.time() < deadline:
            time.sleep(0.1)
        self.assertEqual(gateway.metric("traverse_gateway_spool_bytes"), 0)

    def test_who_goes_on_after_a_refusal_is_cut_off(self):
        """As fast as he can, so that hardly ever anything waits."""
        connection = self.connect()
        connection.sendall(b"POST /v1/gcode HTTP/1.1\r\nHost: x\r\nContent-Length: 99999999999999\r\n\r\n")
        end = time.time() + 20
        with self.assertRaises((BrokenPipeError, ConnectionResetError)):
            while time.time() < end:
                connection.sendall(bytes(65536))

    def test_a_head_that_drips_is_given_up(self):
        connection = self.connect()
        connection.sendall(b"POST /v1/gcode HTTP/1.1\r\nHost: x\r\n")
        self.assertIn(b"408", self.status(connection))  # within the 20 seconds of answer()

    def test_a_piece_that_never_comes_is_given_up(self):
        connection = self.connect()
        connection.sendall(b"POST /v1/gcode HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n280000000\r\nG1")
        text = self.answer(connection)
        self.assertIn(b"408", text.split(b"\r\n")[0])
        self.assertIn(b"too slowly", text)


class Connections(Sockets):
    """Clients that do all they want at once: a machine that stands still for seconds changes nothing."""

    flags = ("--max_file_bytes=200000", "--max_spool_bytes=700000", "--max_requests_per_caller=3")

    def test_half_an_upload_is_answered_and_leaves_nothing(self):
        connection = self.connect()
        connection.sendall(b"POST /v1/gcode HTTP/1.1\r\nHost: x\r\nContent-Length: 1000\r\n\r\n" + b"G1 X1\n" * 10)
        connection.shutdown(socket.SHUT_WR)
        text = self.answer(connection)
        self.assertIn(b"400 Bad Request", text)
        self.assertIn(b"cut short after 60 bytes", text)

    def test_too_long_is_said_before_it_is_sent(self):
        connection = self.connect()
        connection.sendall(b"POST /v1/gcode HTTP/1.1\r\nHost: x\r\nContent-Length: 10737418240\r\n"
                           b"Expect: 100-continue\r\n\r\n")
        self.assertIn(b"413", self.status(connection))

    def test_too_long_in_pieces_is_refused_when_it_is(self):
        connection = self.connect()
        connection.sendall(b"POST /v1/gcode HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n")
        piece = b"2710\r\n" + b"; comment\n" * 1000 + b"\r\n"
        try:
            for _ in range(50):
                connection.sendall(piece)
        except (BrokenPipeError, ConnectionResetError):
            pass
        self.assertIn(b"413", self.status(connection))

    def test_gzip_that_unpacks_to_too_much_is_refused(self):
        status, _, body = self.gateway.ask("POST", "/v1/gcode", gzip.compress(b"G1 X1\n" * 1000000))
        self.assertEqual(status, 413, body)

    def test_expect_is_answered(self):
        connection = self.connect()
        connection.sendall(b"POST /v1/gcode HTTP/1.1\r\nHost: x\r\nConnection: close\r\nContent-Length: %d\r\n"
                           b"Expect: 100-continue\r\n\r\n" % len(PART))
        self.assertEqual(connection.recv(1000), b"HTTP/1.1 100 Continue\r\n\r\n")
        connection.sendall(PART)
        self.assertIn(b"200 OK", self.status(connection))

    def test_heads_that_proxies_read_otherwise_are_refused(self):
        host = b"Host: 127.0.0.1\r\n"
        for what, head, status in [
                ("no host", b"GET /healthz HTTP/1.1\r\n", 400), ("of HTTP/1.0 none is asked", b"GET /healthz HTTP/1.0\r\n", 200),
                ("two", b"GET /healthz HTTP/1.1\r\n" + host + host, 400), ("no name", b"GET /healthz HTTP/1.1\r\nHost: a b\r\n", 400),
                ("folded", b"GET /healthz HTTP/1.1\r\n" + host + b"A: b\r\n c\r\n", 400),
                ("folded host", b"GET /healthz HTTP/1.1\r\nHost:\r\n 127.0.0.1\r\n", 400),
                ("long but whole", b"GET /healthz HTTP/1.1\r\n" + host + b"A: " + b"b" * 9000 + b"\r\n", 200)]:
            connection = self.connect()
            connection.sendall(head + b"Connection: close\r\n\r\n")
            self.assertEqual(int(self.status(connection).split()[1]), status, what)

    def test_an_absolute_target_names_the_host(self):
        for target, status in [(b"http://127.0.0.1/healthz", 200), (b"HTTP://127.0.0.1:80/healthz?x=1", 200), (b"http://127.0.0.1", 200),
                               (b"http://strange.example.com/metrics", 421)]:
            connection = self.connect()
            connection.sendall(b"GET " + target + b" HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n")
            self.assertEqual(int(self.status(connection).split()[1]), status, target)

    def test_expect_may_be_in_capitals(self):
        connection = self.connect()
        connection.sendall(b"POST /v1/inspect HTTP/1.1\r\nHost: x\r\nExpect: 100-Continue\r\nContent-Length: 10\r\n\r\n")
        self.assertTrue(connection.recv(100).startswith(b"HTTP/1.1 100 Continue"))

    def test_chunks_are_a_body_too(self):
        connection = self.connect()
        connection.sendall(b"POST /v1/gcode HTTP/1.1\r\nHost: x\r\nConnection: close\r\nTransfer-Encoding: chunked\r\n\r\n")
        for at in range(0, len(PART), 100):
            piece = PART[at:at + 100]
            connection.sendall(b"%x\r\n%s\r\n" % (len(piece), piece))
        connection.sendall(b"0\r\n\r\n")
        self.assertIn(b"200 OK", self.status(connection))

    def test_what_is_no_http(self):
        for text in [b"nonsense\r\n\r\n", b"GET / HTTP/1.1\r\nno colon\r\n\r\n",
                     b"POST /v1/gcode HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
                     b"POST /v1/gcode HTTP/1.1\r\nContent-Length: 5\r\nContent-Length: 6\r\n\r\nhello",
                     b"POST /v1/gcode HTTP/1.1\r\nContent-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
                     b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + bytes(200)]:
            connection = self.connect()
            connection.sendall(text)
            self.assertIn(b"400", self.status(connection), text)

    def test_bodies_that_lie_about_their_pieces(self):
        head = b"POST /v1/gcode HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: %s\r\n\r\n"
        for coding, body, status, words in [
                (b"chunked", b"-5\r\nhello\r\n0\r\n\r\n", b"400", b"chunks cannot be read after 0 bytes"),
                (b"chunked", b"5\r\nhelloX0\r\n\r\n", b"400", b"chunks cannot be read after 5 bytes"),
                (b"chunked", b"fffffffffffffffff\r\nG1\r\n", b"400", b"chunks cannot be read"),
                (b"gzip, chunked", b"5\r\nhello\r\n0\r\n\r\n", b"501", b"chunked"),
                (b"xchunked", b"GET /metrics HTTP/1.1\r\n\r\n", b"501", b"chunked")]:
            connection = self.connect()
            connection.sendall(head % coding + body)
            text = self.answer(connection)
            self.assertIn(status, text.split(b"\r\n")[0], body)
            self.assertIn(words, text)
            self.assertEqual(text.count(b"HTTP/1.1"), 1)

    def test_a_head_that_is_too_long(self):
        connection = self.connect()
        try:
            connection.sendall(b"GET / HTTP/1.1\r\nX: " + b"x" * 100000 + b"\r\n\r\n")
        except (BrokenPipeError, ConnectionResetError):
            pass
        self.assertIn(b"431", self.status(connection))

    def test_two_requests_on_one_connection(self):
        connection = self.connect()
        connection.sendall(b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\nGET /readyz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")
        text = self.answer(connection)
        self.assertEqual(text.count(b"200 OK"), 2)

    def uploads(self, count, length):
        """Connections that have sent all but the end of a file, of `length` bytes each."""
        begun = []
        for _ in range(count):
            connection = self.connect()
            connection.sendall(b"POST /v1/gcode HTTP/1.1\r\nHost: x\r\nContent-Length: 199000\r\n\r\n" +
                               b"; comment\n" * (length // 10))
            begun.append(connection)
        return begun

    def test_a_full_spool_is_said(self):
        first, *others = self.uploads(3, 190000)  # a caller may have 350,000 bytes
        answers = [self.answer(connection) for connection in others]
        first.close()
        for answer in answers:
            self.assertIn(b"507", answer.split(b"\r\n")[0])
            self.assertIn(b"the spool is full for this caller", answer)

    def test_a_caller_with_too_many_requests_is_told(self):
        connections = self.uploads(3, 10000)
        deadline = time.time() + 20  # until the three have come
        status = 200
        while status == 200 and time.time() < deadline:
            status, headers, body = self.gateway.ask("POST", "/v1/gcode", PART)
        self.assertEqual(status, 429, body)  # the fourth request of this caller
        self.assertIn("retry-after", headers)
        for connection in connections:
            connection.close()

    def test_health_while_others_are_slow(self):
        for _ in range(20):
            self.connect().sendall(b"POST /v1/gcode HTTP/1.1\r\nHost: x\r\nContent-Length: 199000\r\n\r\nG1")
        self.assertEqual(self.gateway.ask("GET", "/healthz", timeout=10)[0], 200)  # they wait 30 s


if __name__ == "__main__":
    unittest.main()
