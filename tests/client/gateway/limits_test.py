"""What the gateway holds on to: its spool, memory, time, connections; and its end.

The environment names the binaries: TRAVERSE and TRAVERSE_GATEWAY.
"""
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
from gateway_process import ENDLESS, Gateway, detail, endless_infill, form, lines_of_infill

PART = lines_of_infill(3)


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


class Files(unittest.TestCase):
    """Of what the process may open, nobody takes what others need."""

    def few(self, files, *flags):
        gateway = Gateway(*flags, files=files)
        self.addCleanup(gateway.close)
        return gateway

    def connect(self, port, count, source):
        held = []
        for _ in range(count):
            try:
                held.append(socket.create_connection(("127.0.0.1", port), source_address=(source, 0), timeout=5))
                self.addCleanup(held[-1].close)
            except OSError:
                pass  # turned away
        return held

    def ask_from(self, source, gateway, path, body):
        other = http.client.HTTPConnection("127.0.0.1", gateway.http_port, source_address=(source, 0), timeout=60)
        self.addCleanup(other.close)
        other.request("POST", path, body)
        answer = other.getresponse()
        return answer.status, answer.read()

    def test_idle_connections_leave_files_to_uploads(self):
        for files in (512, 256, 150):
            gateway = self.few(files)
            for source in ("127.0.0.3", "127.0.0.4"):
                self.connect(gateway.grpc_port, 300, source)
                self.connect(gateway.http_port, 300, source)
                self.connect(gateway.metrics_port, 100, source)
            for i in range(4):
                status, answer = self.ask_from("127.0.0.2", gateway, "/v1/gcode?strategy=none", PART)
                self.assertEqual(status, 200, (files, i, answer))

    def test_a_limit_that_is_lowered_later_holds_too(self):
        gateway = Gateway()
        self.addCleanup(gateway.close)
        resource.prlimit(gateway.process.pid, resource.RLIMIT_NOFILE, (512, 512))
        self.connect(gateway.grpc_port, 600, "127.0.0.3")
        self.assertEqual(gateway.ask("POST", "/v1/gcode?strategy=none", PART)[0], 200)

    def test_jobs_that_are_kept_leave_files_to_others(self):
        gateway = self.few(256)
        answer = b""
        for i in range(1000):
            _, _, answer = gateway.ask("POST", "/v1/jobs?strategy=none", PART, {"Idempotency-Key": str(i)})
            if b"this caller may have" in answer:
                break
            time.sleep(0.02)  # for work under way
        self.assertIn(b"this caller may have 24 jobs now", answer)
        for source, path, good in (("127.0.0.2", "/v1/jobs", 202), ("127.0.0.3", "/v1/gcode", 200)):
            status, answer = self.ask_from(source, gateway, path + "?strategy=none", PART)
            self.assertEqual(status, good, answer)

    def test_the_start_says_what_files_are_too_few_for(self):
        gateway = self.few(512)
        gateway.ask("POST", "/v1/gcode", PART)
        with open(gateway.log.name, encoding="utf-8") as file:
            told = [line for line in file if '"few_files"' in line]
        self.assertEqual(len(told), 1)
        self.assertIn("the limit of 512 open files leaves room for 64 connections of gRPC, 64 connections of HTTP, 96 jobs, "
                      "24 requests", told[0])
        many = Gateway()
        self.addCleanup(many.close)
        many.ask("POST", "/v1/gcode", PART)
        with open(many.log.name, encoding="utf-8") as file:
            self.assertNotIn("few_files", file.read())


class Time(unittest.TestCase):
    def test_the_best_until_the_deadline_or_a_reason(self):
        gateway = Gateway()
        self.addCleanup(gateway.close)
        began = time.time()
        status, headers, body = gateway.ask("POST", "/v1/gcode" + ENDLESS + "&deadline=3s", endless_infill())
        self.assertLess(time.time() - began, 20)
        self.assertEqual(status, 200, body[:300])
        self.assertLess(float(headers["traverse-travel-mm"]), float(headers["traverse-travel-given-mm"]))
        status, _, body = gateway.ask("POST", "/v1/gcode?deadline=1ms", lines_of_infill(400))
        self.assertEqual(status, 504, body[:300])

    def test_inspecting_and_comparing_end_in_time(self):
        gateway = Gateway("--max_time=200ms")
        self.addCleanup(gateway.close)
        long = lines_of_infill(20_000)
        both, headers = form([("original", "a.gcode", long), ("optimised", "b.gcode", long)])
        for answer in (gateway.ask("POST", "/v1/inspect", long), gateway.ask("POST", "/v1/verify", both, headers)):
            self.assertEqual(answer[0], 504, answer[2][:300])
        self.assertEqual(gateway.ask("POST", "/v1/inspect", PART)[0], 200)

    def test_what_needs_more_memory_than_there_is_is_refused(self):
        gateway = Gateway("--max_memory=33554432")  # 16 MiB, and some hundred bytes for each path
        self.addCleanup(gateway.close)
        long = lines_of_infill(8000)
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

    def settled_addresses(self, gateway):
        """The same, once all threads have begun that there will be."""
        size, before = self.addresses(gateway), 0
        while size != before:
            time.sleep(0.3)
            size, before = self.addresses(gateway), size
        if size > 1 << 40:
            self.skipTest("a sanitizer has taken all addresses")
        return size

    def test_layers_for_which_the_process_has_no_thread_are_refused(self):
        gateway = Gateway()
        self.addCleanup(gateway.close)
        layers = b'{"layers": [{"islands": [{"contours": [{"points": [1, 2]}]}]}]}'

        def status():
            return gateway.ask("POST", "/v1/optimize?deadline=5s", layers, {"Content-Type": "application/json"})[0]

        self.assertEqual(status(), 200)
        most = self.settled_addresses(gateway) + (1 << 20)  # a thread has 8 MiB
        resource.prlimit(gateway.process.pid, resource.RLIMIT_AS, (most, resource.RLIM_INFINITY))
        refused = [status() for _ in range(3)]
        resource.prlimit(gateway.process.pid, resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        self.assertEqual(set(refused) - {200, 503, 504}, set())
        self.assertEqual(status(), 200)

    def test_a_packed_file_that_there_is_no_memory_to_measure_is_refused(self):
        gateway = Gateway()
        self.addCleanup(gateway.close)
        self.assertEqual(gateway.ask("POST", "/v1/gcode", PART)[0], 200)  # starts all threads there will be
        most = self.settled_addresses(gateway) + (32 << 20)
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

    def test_the_longest_idle_connection_gives_way(self):
        gateway = Gateway("--max_connections=4")
        self.addCleanup(gateway.close)
        held = [socket.create_connection(("127.0.0.1", gateway.http_port), source_address=(f"127.0.0.{3 + i % 2}", 0)) for i in range(4)]
        for connection in held:
            self.addCleanup(connection.close)
        time.sleep(1.1)
        self.assertEqual(gateway.ask("GET", "/healthz")[0], 200)
        held[0].settimeout(5)
        self.assertEqual(held[0].recv(1), b"", "the oldest is closed")
        held[3].sendall(b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n")
        self.assertTrue(held[3].recv(100).startswith(b"HTTP/1.1 200"), "the others are not")

    def test_who_only_watches_gives_way(self):
        gateway = Gateway("--max_connections=4", "--workers=1")
        self.addCleanup(gateway.close)
        jobs = [json.loads(gateway.ask("POST", "/v1/jobs" + ENDLESS, endless_infill())[2])["id"] for _ in range(2)]
        watchers = []
        for name in 2 * jobs:  # the first job makes progress, the second one waits
            watchers.append(socket.create_connection(("127.0.0.1", gateway.http_port), timeout=5))
            self.addCleanup(watchers[-1].close)
            watchers[-1].sendall(b"GET /v1/jobs/%s HTTP/1.1\r\nHost: x\r\nAccept: text/event-stream\r\n\r\n" % name.encode())
            self.assertTrue(watchers[-1].recv(1000).startswith(b"HTTP/1.1 200"))
        other = http.client.HTTPConnection("127.0.0.1", gateway.http_port, source_address=("127.0.0.2", 0), timeout=10)
        self.addCleanup(other.close)
        other.request("POST", "/v1/inspect", PART)
        self.assertEqual(other.getresponse().status, 200)
        operator = http.client.HTTPConnection("127.0.0.1", gateway.metrics_port)
        self.addCleanup(operator.close)
        operator.request("GET", "/metrics")
        self.assertIn(b"\ntraverse_gateway_jobs 2\n", operator.getresponse().read(), "they go on")

    def test_who_is_worked_for_does_not_give_way(self):
        gateway = Gateway("--max_connections=2")
        self.addCleanup(gateway.close)
        body = endless_infill()
        for accept in ("*/*", "text/event-stream"):
            working = socket.create_connection(("127.0.0.1", gateway.http_port), timeout=5)
            self.addCleanup(working.close)
            working.sendall(b"POST /v1/gcode%s HTTP/1.1\r\nHost: x\r\nAccept: %s\r\nContent-Length: %d\r\n\r\n"
                            % (ENDLESS.encode(), accept.encode(), len(body)) + body)
            if accept != "*/*":
                self.assertTrue(working.recv(1000).startswith(b"HTTP/1.1 200"))
        time.sleep(1.1)
        status, _, answer = gateway.ask("GET", "/healthz")
        self.assertEqual((status, detail(answer)), (503, "too many connections"))

    def test_addresses_take_turns_with_new_connections(self):
        gateway = Gateway("--max_requests=2")
        self.addCleanup(gateway.close)
        gateway.stop()  # so that all have come when it looks
        many = [socket.create_connection(("127.0.0.1", gateway.http_port), source_address=("127.0.0.2", 0)) for _ in range(50)]
        for connection in many:
            self.addCleanup(connection.close)
            connection.sendall(b"POST /v1/inspect HTTP/1.1\r\nHost: x\r\nContent-Length: 1000\r\n\r\n")  # each keeps a place
        late = http.client.HTTPConnection("127.0.0.1", gateway.http_port, source_address=("127.0.0.3", 0))
        self.addCleanup(late.close)
        late.request("POST", "/v1/inspect", PART)
        gateway.process.send_signal(signal.SIGCONT)
        self.assertEqual(late.getresponse().status, 200, "the second place, not one after fifty")

    def test_connections_that_wait_for_their_turn_give_way(self):
        gateway = Gateway("--max_connections=20", "--max_connections_per_address=15")
        self.addCleanup(gateway.close)
        gateway.stop()
        for i in range(90):
            many = socket.create_connection(("127.0.0.1", gateway.http_port), source_address=(f"127.0.0.{3 + i % 3}", 0))
            self.addCleanup(many.close)
        late = http.client.HTTPConnection("127.0.0.1", gateway.http_port, source_address=("127.0.0.2", 0))
        self.addCleanup(late.close)
        late.request("POST", "/v1/inspect", PART)
        gateway.process.send_signal(signal.SIGCONT)
        self.assertEqual(late.getresponse().status, 200)

    def test_the_last_places_are_for_callers_who_have_none(self):
        gateway = Gateway("--max_requests=4")
        self.addCleanup(gateway.close)
        head = b"POST /v1/inspect HTTP/1.1\r\nHost: x\r\nContent-Length: 1000\r\n\r\n"
        for _ in range(3):
            connection = socket.create_connection(("127.0.0.1", gateway.http_port))
            self.addCleanup(connection.close)
            connection.sendall(head)
        deadline = time.time() + 5
        while gateway.metric("traverse_gateway_requests_in_flight") < 3 and time.time() < deadline:
            time.sleep(0.02)
        status, headers, answer = gateway.ask("POST", "/v1/inspect", PART)
        self.assertEqual(status, 429, answer)
        self.assertIn("who have none", detail(answer))
        self.assertIn("retry-after", headers)
        other = http.client.HTTPConnection("127.0.0.1", gateway.http_port, source_address=("127.0.0.2", 0))
        self.addCleanup(other.close)
        other.request("POST", "/v1/inspect", PART)
        self.assertEqual(other.getresponse().status, 200)

    def test_an_upload_has_a_deadline_as_a_whole(self):
        gateway = Gateway("--max_transfer_time=1s", "--min_upload_rate=1")
        self.addCleanup(gateway.close)
        connection = socket.create_connection(("127.0.0.1", gateway.http_port), timeout=10)
        self.addCleanup(connection.close)
        connection.sendall(b"POST /v1/inspect HTTP/1.1\r\nHost: x\r\nContent-Length: 1000\r\n\r\n")
        began = time.time()
        answer = b""
        connection.settimeout(0.1)
        while not answer and time.time() < began + 8:
            connection.sendall(b";")
            try:
                answer = connection.recv(1000)
            except TimeoutError:
                pass
        self.assertTrue(answer.startswith(b"HTTP/1.1 408"), answer)

    def test_who_goes_stops_the_work(self):
        gateway = Gateway("--workers=1")
        self.addCleanup(gateway.close)
        connection = socket.create_connection(("127.0.0.1", gateway.http_port))
        body = endless_infill()
        head = f"POST /v1/gcode{ENDLESS} HTTP/1.1\r\nHost: x\r\nContent-Length: {len(body)}\r\n\r\n"
        connection.sendall(head.encode() + body)
        deadline = time.time() + 10
        while gateway.metric("traverse_gateway_workers_busy") == 0 and time.time() < deadline:
            time.sleep(0.02)
        connection.close()
        began = time.time()
        while gateway.metric("traverse_gateway_workers_busy") > 0 and time.time() < began + 20:
            time.sleep(0.02)
        self.assertLess(time.time() - began, 10)
        self.assertEqual(gateway.metric('traverse_gateway_files_total{outcome="cancelled"}'), 1)

    def test_who_goes_stops_any_work(self):
        gateway = Gateway("--workers=1")
        self.addCleanup(gateway.close)
        long = lines_of_infill(60_000)
        both, headers = form([("original", "a.gcode", long), ("optimised", "b.gcode", long)])
        for path, body, kind in (("/v1/inspect", long, ""), ("/v1/verify", both, f"Content-Type: {headers['Content-Type']}\r\n")):
            connection = socket.create_connection(("127.0.0.1", gateway.http_port))
            head = f"POST {path} HTTP/1.1\r\nHost: x\r\n{kind}Content-Length: {len(body)}\r\n\r\n"
            connection.sendall(head.encode() + body)
            deadline = time.time() + 10
            while gateway.metric("traverse_gateway_work_bytes") < 20 << 20 and time.time() < deadline:
                time.sleep(0.01)
            connection.close()
            began = time.time()
            while gateway.metric("traverse_gateway_workers_busy") > 0 and time.time() < began + 20:
                time.sleep(0.02)
            self.assertLess(time.time() - began, 10, path)

    def test_draining_waits_for_a_slow_reader(self):
        gateway = Gateway("--drain_timeout=60s")
        self.addCleanup(gateway.close)
        part = lines_of_infill(3) + b"; of no layer\n" * 700_000  # longer than what sockets hold
        connection = socket.socket()
        self.addCleanup(connection.close)
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 65536)
        connection.connect(("127.0.0.1", gateway.http_port))
        connection.sendall(b"POST /v1/gcode?strategy=greedy HTTP/1.1\r\nHost: x\r\nContent-Length: %d\r\n\r\n" % len(part) + part)
        answer = connection.recv(65536)
        gateway.process.send_signal(signal.SIGTERM)
        for _ in range(16):
            time.sleep(0.5)
            answer += connection.recv(10000)
        while piece := connection.recv(1 << 20):
            answer += piece
        head, body = answer.split(b"\r\n\r\n", 1)
        self.assertIn(b"Content-Length: %d" % len(body), head)
        self.assertEqual(gateway.process.wait(timeout=20), 0)

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
