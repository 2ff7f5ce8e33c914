"""The gateway over HTTP: files, what is answered to bad input, limits.

The environment names the binaries: TRAVERSE and TRAVERSE_GATEWAY.
"""
import base64
import gzip
import http.client
import json
import lzma
import os
import re
import resource
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
from gateway_process import SAMPLE, TESTS, Gateway, detail, events, form, lines_of_infill, optimised_by_command

PART = lines_of_infill(3)


class Files(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.gateway = Gateway()

    @classmethod
    def tearDownClass(cls):
        cls.gateway.close()

    def post(self, path, body, headers=None):
        return self.gateway.ask("POST", path, body, headers)

    def refused(self, status, words, answer):
        self.assertEqual(answer[0], status, answer)
        self.assertEqual(answer[1]["content-type"], "application/problem+json")
        self.assertIn(words, detail(answer[2]))
        self.assertEqual(json.loads(answer[2])["status"], status)

    def test_the_bytes_are_those_of_the_command(self):
        with open(SAMPLE, "rb") as file:
            sample = file.read()
        for content, flags in [(PART, []), (PART, ["--policy=free", "--seed=3"]), (PART, ["--layers=2-3"]),
                               (PART, ["--strategy=greedy"]), (PART, ["--option=effort=2"]),
                               (sample, ["--strategy=greedy", "--policy=balanced"])]:
            query = "&".join(flag[2:].replace("=", "%3D").replace("%3D", "=", 1) for flag in flags)
            status, headers, body = self.post("/v1/gcode?name=part.gcode&" + query, content)
            self.assertEqual(status, 200, body[:300])
            self.assertEqual(body, optimised_by_command(content, *flags), flags)
            self.assertEqual(headers["traverse-verified"], "true")

    def test_every_small_file_of_the_tests_comes_back_as_by_the_command(self):
        folder = os.path.join(TESTS, "data", "gcode")
        for name in ["ps_vase_spiral", "ar_clusters13_arcs", "ps_nameplate_mmu_tower"]:
            with open(os.path.join(folder, name + ".gcode.xz"), "rb") as file:
                packed = file.read()
            status, _, body = self.post("/v1/gcode?strategy=greedy", packed)
            self.assertEqual(status, 200, body[:300])
            self.assertEqual(body, optimised_by_command(lzma.decompress(packed), "--strategy=greedy"), name)

    def test_a_form_is_as_good_as_a_body(self):
        body, headers = form([("policy", "free"), ("file", "my part.gcode", PART)])
        status, answer_headers, made = self.post("/v1/gcode", body, headers)
        self.assertEqual(status, 200, made[:300])
        self.assertEqual(made, optimised_by_command(PART, "--policy=free"))
        self.assertEqual(answer_headers["content-disposition"],
                         "attachment; filename=\"my part.gcode\"; filename*=UTF-8''my%20part.gcode")

    def test_the_summary_as_json(self):
        status, _, body = self.post("/v1/gcode", PART, {"Accept": "application/json"})
        summary = json.loads(body)
        self.assertEqual(status, 200)
        self.assertLess(summary["written"]["travel_mm"], summary["given"]["travel_mm"])
        self.assertEqual((summary["policy"], summary["layers"], summary["verified"]), ("POLICY_SAFE", 3, True))

    def test_events_tell_of_progress_and_bring_the_file(self):
        status, headers, body = self.post("/v1/gcode?report=true", PART, {"Accept": "text/event-stream"})
        self.assertEqual((status, headers["content-type"]), (200, "text/event-stream"))
        told = events(body)
        stages = [json.loads(data)["stage"] for name, data in told if name == "progress"]
        self.assertEqual(stages[:2], ["STAGE_QUEUED", "STAGE_READING"])
        self.assertIn("STAGE_SEARCHING", stages)
        file = b"".join(base64.b64decode(data) for name, data in told if name == "file")
        self.assertEqual(file, optimised_by_command(PART))
        report = b"".join(base64.b64decode(data) for name, data in told if name == "report")
        self.assertIn(b"</html>", report)
        self.assertEqual(told[-1][0], "summary")

    def test_events_of_a_bad_file_end_with_the_problem(self):
        _, _, body = self.post("/v1/gcode", b"no file of a slicer\n", {"Accept": "text/event-stream"})
        name, data = events(body)[-1]
        self.assertEqual(name, "problem")
        self.assertEqual(json.loads(data)["status"], 400)

    def test_the_report_instead_of_the_file(self):
        status, headers, body = self.post("/v1/gcode?report=true", PART)
        self.assertEqual((status, headers["content-type"]), (200, "text/html; charset=utf-8"))
        self.assertIn(b"</html>", body)

    def test_compressed_files_come_back_plain(self):
        for packed, headers in [(gzip.compress(PART), {"Content-Encoding": "gzip"}), (gzip.compress(PART), {}),
                                (lzma.compress(PART), {})]:
            status, _, body = self.post("/v1/gcode", packed, headers)
            self.assertEqual(status, 200, body[:300])
            self.assertEqual(body, optimised_by_command(PART))

    def test_a_container_comes_back_as_one(self):
        with tempfile.TemporaryDirectory() as folder:
            text, packed, made = (os.path.join(folder, name) for name in ("a.gcode", "a.bgcode", "b.bgcode"))
            with open(text, "wb") as file:
                file.write(PART)
            command = [os.environ["TRAVERSE"], "optimize", "--quiet"]
            subprocess.run([*command, text, "-o", packed, "--container=bgcode", "--strategy=none"], check=True)
            subprocess.run([*command, packed, "-o", made], check=True)
            with open(packed, "rb") as file:
                status, headers, body = self.post("/v1/gcode?name=a.bgcode", file.read())
            self.assertEqual((status, headers["content-type"]), (200, "application/octet-stream"), body[:300])
            with open(made, "rb") as file:
                self.assertEqual(body, file.read())
            status, headers, body = self.post("/v1/gcode?name=a.bgcode&container=text", body)
            self.assertEqual((status, headers["content-type"]), (200, "text/x.gcode"))

    def test_what_is_in_a_file(self):
        status, _, body = self.post("/v1/inspect", PART)
        found = json.loads(body)
        self.assertEqual((status, found["format"], found["layers"]), (200, "G-code", 3))
        self.assertIn({"name": "slicer", "value": "PrusaSlicer 2.5.0"}, found["facts"])

    def test_whether_two_files_print_the_same(self):
        made = optimised_by_command(PART)
        body, headers = form([("original", "a.gcode", PART), ("optimised", "b.gcode", made)])
        self.assertEqual(json.loads(self.post("/v1/verify", body, headers)[2]), {"same": True, "difference": ""})
        body, headers = form([("optimised", "b.gcode", made.replace(b"E.5", b"E.6", 1)), ("original", "a.gcode", PART)])
        answer = json.loads(self.post("/v1/verify", body, headers)[2])
        self.assertFalse(answer["same"])
        self.assertIn("optimised:", answer["difference"])
        body, headers = form([("original", "a.gcode", PART)])
        self.refused(400, "original and optimised", self.post("/v1/verify", body, headers))

    def test_parameters_that_are_wrong_are_said_before_the_file_is_sent(self):
        for query, words in [("polcy=safe", "polcy"), ("policy=wild", "wild"), ("policy=safe&policy=free", "twice"),
                             ("layers=9-1", "layers"), ("seed=-1", "seed"), ("seed=1.5", "seed"), ("deadline=soon", "deadline"),
                             ("report=perhaps", "report"), ("machine=/etc/passwd", "machine"), ("json=/tmp/x", "json"),
                             ("o=/tmp/x", "parameter o"), ("Policy=safe", "Policy"), ("name=../x.gcode", "slash"),
                             ("name=%00", "control"), ("name=..", "name"), ("policy=%zz", "percent"), ("option=effort", "effort"),
                             ("allow=walls", "allow=walls"), ("allow=infill_order,", "allow"),
                             ("min_revisit=-1", "min_revisit"), ("min_revisit=nan", "min_revisit")]:
            self.refused(400, words, self.post("/v1/gcode?" + query, PART))
        self.refused(400, "strategy", self.post("/v1/gcode?strategy=magic", PART))
        self.refused(400, "layers=4-9", self.post("/v1/gcode?layers=4-9", PART))

    def test_bodies_that_are_no_files(self):
        self.refused(400, "no file", self.post("/v1/gcode", b""))
        self.refused(400, "file.gcode", self.post("/v1/gcode", b"\n\n"))
        self.refused(415, "DAMAT", self.post("/v1/gcode", b"nF,1\nF1,1\nI1,1,0\nC1,X1,Y1,X2,Y1,X2,Y2\n"))
        self.refused(400, "file.gcode", self.post("/v1/gcode", gzip.compress(PART)[:-20]))
        self.refused(415, "gzip", self.post("/v1/gcode", PART, {"Content-Encoding": "br"}))
        for size in [1, 100, 5000]:
            self.assertIn(self.post("/v1/gcode", os.urandom(size))[0], (400, 415))

    def test_forms_that_are_wrong(self):
        two, headers = form([("file", "a.gcode", PART), ("file", "b.gcode", PART)])
        self.refused(400, "one is expected", self.post("/v1/gcode", two, headers))
        body, headers = form([("file", "a.gcode", PART), ("colour", "red")])
        self.refused(400, "colour", self.post("/v1/gcode", body, headers))
        body, headers = form([("policy", "safe")])
        self.refused(400, "no file", self.post("/v1/gcode", body, headers))
        body, headers = form([("file", "a.gcode", PART)])
        self.refused(400, "cut short", self.post("/v1/gcode", body[:-10], headers))
        self.refused(400, "boundary", self.post("/v1/gcode", body, {"Content-Type": "multipart/form-data"}))
        self.refused(400, "boundary", self.post("/v1/gcode", body, {"Content-Type": "multipart/mixed; boundary=x"}))
        for name in ["../a.gcode", "a\\b.gcode", "a\x01.gcode", ".."]:
            body, headers = form([("file", name, PART)])
            self.assertEqual(self.post("/v1/gcode", body, headers)[0], 400, name)

    def test_paths_and_methods(self):
        self.refused(404, "openapi", self.gateway.ask("GET", "/nothing"))
        self.refused(405, "POST", self.gateway.ask("GET", "/v1/gcode"))
        self.refused(405, "GET", self.gateway.ask("DELETE", "/"))
        self.refused(400, "..", self.gateway.ask("GET", "/v1/../etc/passwd"))
        self.refused(400, "..", self.gateway.ask("GET", "/%2e%2e/etc/passwd"))
        self.refused(404, "printers", self.gateway.ask("GET", "/api/version"))

    def test_pages_of_other_sites_may_not_send_files(self):
        for headers in [{"Origin": "http://evil.example"}, {"Sec-Fetch-Site": "cross-site"}, {"Origin": "null"}]:
            status, answer_headers, _ = self.post("/v1/gcode", PART, headers)
            self.assertEqual(status, 403)
            self.assertNotIn("access-control-allow-origin", answer_headers)
        own = {"Origin": f"http://127.0.0.1:{self.gateway.http_port}", "Sec-Fetch-Site": "same-origin"}
        self.assertEqual(self.post("/v1/gcode", PART, own)[0], 200)

    def test_a_name_that_a_stranger_leads_here_is_refused(self):
        port = self.gateway.http_port
        rebound = {"Host": f"evil.example:{port}", "Origin": f"http://evil.example:{port}", "Sec-Fetch-Site": "same-origin"}
        self.refused(421, "--allowed_hosts", self.post("/v1/gcode", PART, rebound))
        self.refused(421, "--allowed_hosts", self.gateway.ask("GET", "/metrics", headers={"Host": "evil.example"}))
        for host in ["localhost", "gateway:8080", "farm.local", f"[::1]:{port}"]:
            self.assertEqual(self.post("/v1/gcode?strategy=greedy", PART, {"Host": host})[0], 200, host)
        for path in ["/healthz", "/readyz"]:
            self.assertEqual(self.gateway.ask("GET", path, headers={"Host": "evil.example"})[0], 200)
        named = Gateway("--allowed_hosts=farm.example")
        self.addCleanup(named.close)
        for host, status in [("farm.example:1", 200), ("FARM.example", 200), ("evil.example", 421), ("127.0.0.1", 200)]:
            self.assertEqual(named.ask("POST", "/v1/gcode?strategy=greedy", PART, {"Host": host})[0], status, host)

    def test_what_operators_ask(self):
        self.assertEqual(self.gateway.ask("GET", "/healthz")[::2], (200, b"ok\n"))
        self.assertEqual(self.gateway.ask("GET", "/readyz")[::2], (200, b"ready\n"))
        self.assertEqual(self.gateway.ask("HEAD", "/readyz")[::2], (200, b""))
        before = self.gateway.metric('traverse_gateway_requests_total{code="200",route="/v1/gcode"}')
        self.post("/v1/gcode", PART)
        self.assertEqual(self.gateway.metric('traverse_gateway_requests_total{code="200",route="/v1/gcode"}'), before + 1)
        self.assertGreater(self.gateway.metric("traverse_gateway_print_seconds_saved_total"), 0)

    def test_the_page_needs_nothing_from_elsewhere(self):
        status, headers, body = self.gateway.ask("GET", "/")
        self.assertEqual((status, headers["content-type"]), (200, "text/html; charset=utf-8"))
        self.assertIn("connect-src 'self'", headers["content-security-policy"])
        self.assertNotIn(b"http://", body)
        self.assertNotIn(b"https://", body)

    def test_nothing_is_left_in_the_spool(self):
        self.post("/v1/gcode", PART)
        self.assertEqual(os.listdir(self.gateway.spool.name), [])
        deadline = time.time() + 5
        while self.gateway.metric("traverse_gateway_spool_bytes") > 0 and time.time() < deadline:
            time.sleep(0.05)
        self.assertEqual(self.gateway.metric("traverse_gateway_spool_bytes"), 0)


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
        body = lines_of_infill(16000)  # longer than what sockets hold
        connection = socket.socket()
        self.addCleanup(connection.close)
        connection.settimeout(60)
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 65536)
        connection.connect(("127.0.0.1", gateway.http_port))
        connection.sendall(b"POST /v1/gcode?strategy=greedy&layers=1 HTTP/1.1\r\nHost: x\r\nContent-Length: %d\r\n\r\n" % len(body))
        connection.sendall(body)
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

    def test_a_full_spool_is_said(self):
        connections = []
        for _ in range(3):
            connection = self.connect()
            connection.sendall(b"POST /v1/gcode HTTP/1.1\r\nHost: x\r\nContent-Length: 199000\r\n\r\n" + b"; comment\n" * 19000)
            connections.append(connection)
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


class Disk(unittest.TestCase):
    def test_a_spool_without_room_is_said(self):
        gateway = Gateway("--max_spool_bytes=1000")
        self.addCleanup(gateway.close)
        status, _, body = gateway.ask("POST", "/v1/gcode", lines_of_infill(20))
        self.assertEqual(status, 507, body)
        self.assertIn("spool is full", detail(body))
        self.assertEqual(gateway.metric("traverse_gateway_spool_bytes"), 0)

    def test_a_spool_that_is_not_there_ends_the_start(self):
        done = subprocess.run([os.environ["TRAVERSE_GATEWAY"], "--spool_dir=/not/there", "--listen_http=127.0.0.1:0",
                               "--listen=", "--metrics_listen="], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("/not/there", done.stderr)

    def test_killed_it_leaves_nothing_in_the_spool(self):
        with tempfile.TemporaryDirectory() as spool:
            gateway = Gateway("--spool_dir=" + spool)
            self.addCleanup(gateway.close)
            connection = socket.create_connection(("127.0.0.1", gateway.http_port))
            self.addCleanup(connection.close)
            connection.sendall(b"POST /v1/gcode HTTP/1.1\r\nHost: x\r\nContent-Length: 199000\r\n\r\n" + PART)
            deadline = time.time() + 5
            while gateway.metric("traverse_gateway_spool_bytes") < len(PART) and time.time() < deadline:
                time.sleep(0.02)
            gateway.process.send_signal(signal.SIGKILL)
            gateway.process.wait()
            self.assertEqual(os.listdir(spool), [])


class Time(unittest.TestCase):
    def test_the_best_until_the_deadline_or_a_reason(self):
        gateway = Gateway()
        self.addCleanup(gateway.close)
        long = lines_of_infill(400)
        began = time.time()
        status, headers, body = gateway.ask("POST", "/v1/gcode?deadline=5s&option=effort=100", long)
        self.assertLess(time.time() - began, 20)
        self.assertEqual(status, 200, body[:300])
        self.assertLess(float(headers["traverse-travel-mm"]), float(headers["traverse-travel-given-mm"]))
        status, _, body = gateway.ask("POST", "/v1/gcode?deadline=1ms", long)
        self.assertEqual(status, 504, body[:300])

    def test_what_needs_more_memory_than_there_is_is_refused(self):
        gateway = Gateway("--max_memory=33554432")  # 16 MiB, and twelve bytes for each of the text
        self.addCleanup(gateway.close)
        long = lines_of_infill(8000)
        self.assertGreater(12 * len(long), 16 << 20)
        self.assertLess(len(gzip.compress(long)), 1 << 20)
        for path in ["/v1/gcode?strategy=none", "/v1/inspect"]:
            for body in [long, gzip.compress(long)]:
                status, _, answer = gateway.ask("POST", path, body)
                self.assertEqual(status, 413, answer[:300])
                self.assertIn("this gateway has 32", detail(answer))
        for packed in [gzip.compress(PART), lzma.compress(PART), b"\x1f\x8b damaged"]:
            status, _, answer = gateway.ask("POST", "/v1/gcode", packed)
            self.assertEqual(status, 400 if packed.endswith(b"damaged") else 200, answer[:300])

    def addresses(self, gateway):
        """How many bytes of addresses the gateway has taken."""
        with open(f"/proc/{gateway.process.pid}/status", encoding="utf-8") as status:
            return 1024 * int(re.search(r"VmSize:\s+(\d+)", status.read())[1])

    def test_a_packed_file_that_there_is_no_memory_to_measure_is_refused(self):
        gateway = Gateway()
        self.addCleanup(gateway.close)
        self.assertEqual(gateway.ask("POST", "/v1/gcode", PART)[0], 200)  # starts all threads there will be
        size, before = self.addresses(gateway), 0
        while size != before:
            time.sleep(0.3)
            size, before = self.addresses(gateway), size
        if size > 1 << 40:
            self.skipTest("a sanitizer has taken all addresses")
        most = size + (32 << 20)
        resource.prlimit(gateway.process.pid, resource.RLIMIT_AS, (most, most))
        for first in (b"\x1f\x8b", b"GCDE\x01\0\0\0\0\0"):
            status, _, answer = gateway.ask("POST", "/v1/gcode", first + bytes(100_000_000))
            self.assertEqual((status, detail(answer)), (503, "there is not enough memory for this file now"))
        self.assertEqual(gateway.ask("GET", "/healthz")[0], 200)

    def test_one_address_leaves_connections_to_others(self):
        gateway = Gateway("--max_connections_per_address=5")
        self.addCleanup(gateway.close)
        held = [socket.create_connection(("127.0.0.1", gateway.http_port)) for _ in range(5)]
        for connection in held:
            self.addCleanup(connection.close)
        status, _, answer = gateway.ask("GET", "/healthz")  # connections are accepted in their order
        self.assertEqual((status, detail(answer)), (503, "too many connections from this address"))
        other = http.client.HTTPConnection("127.0.0.1", gateway.http_port, source_address=("127.0.0.2", 0))
        self.addCleanup(other.close)
        other.request("GET", "/healthz")
        self.assertEqual(other.getresponse().status, 200)
        for connection in held:
            connection.close()
        deadline = time.time() + 10
        while gateway.ask("GET", "/healthz")[0] != 200 and time.time() < deadline:
            time.sleep(0.05)
        self.assertEqual(gateway.ask("GET", "/healthz")[0], 200)

    def test_who_goes_stops_the_work(self):
        gateway = Gateway("--workers=1")
        self.addCleanup(gateway.close)
        connection = socket.create_connection(("127.0.0.1", gateway.http_port))
        body = lines_of_infill(1500)
        connection.sendall(b"POST /v1/gcode?option=effort=100 HTTP/1.1\r\nHost: x\r\nContent-Length: %d\r\n\r\n" % len(body) + body)
        deadline = time.time() + 10
        while gateway.metric("traverse_gateway_workers_busy") == 0 and time.time() < deadline:
            time.sleep(0.02)
        connection.close()
        began = time.time()
        while gateway.metric("traverse_gateway_workers_busy") > 0 and time.time() < began + 20:
            time.sleep(0.02)
        self.assertLess(time.time() - began, 10)
        self.assertEqual(gateway.metric('traverse_gateway_files_total{outcome="cancelled"}'), 1)

    def test_draining_ends_what_is_under_way_well(self):
        gateway = Gateway()
        self.addCleanup(gateway.close)
        answers = []
        thread = threading.Thread(
            target=lambda: answers.append(gateway.ask("POST", "/v1/gcode?option=effort=10", lines_of_infill(100))))
        thread.start()
        deadline = time.time() + 10
        while gateway.metric("traverse_gateway_requests_in_flight") == 0 and time.time() < deadline:
            time.sleep(0.01)
        gateway.process.send_signal(signal.SIGTERM)
        thread.join()
        self.assertEqual(answers[0][0], 200)
        self.assertEqual(gateway.process.wait(timeout=20), 0)


if __name__ == "__main__":
    unittest.main()
