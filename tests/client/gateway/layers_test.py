"""Layers as JSON over HTTP: what is answered, how faults are told, and that nothing is held for who does not read.

The environment names the binaries: TRAVERSE, TRAVERSE_GATEWAY and TRAVERSE_SERVER.
"""
import gzip
import http.client
import json
import os
import pathlib
import random
import signal
import socket
import subprocess
import sys
import time
import unittest

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
from gateway_process import Gateway, detail

JSON = {"Content-Type": "application/json"}


def square(x, y, size=5.0):
    return {"points": [x, y, x + size, y, x + size, y + size, x, y + size]}


def layer(contours=6, number=1, seed=1):
    dice = random.Random(seed)
    return {"id": number, "islands": [{"contours": [square(dice.uniform(0, 190), dice.uniform(0, 190)) for _ in range(contours)]}]}


def job(layers=3, **options):
    return {"options": {"seed": 7, **options}, "layers": [layer(number=i + 1, seed=i) for i in range(layers)]}


class Server:
    """A traverse-server; ended by close()."""

    def __init__(self, *flags):
        self.process = subprocess.Popen([os.environ["TRAVERSE_SERVER"], "--listen=127.0.0.1:0", "--metrics_listen=", *flags],
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.address = "127.0.0.1:" + self.process.stdout.readline().split()[-1]

    def close(self):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()


class Case(unittest.TestCase):
    def start(self, kind, *flags):
        program = kind(*flags)
        self.addCleanup(program.close)
        return program

    def post(self, gateway, body, query="", **headers):
        body = body if isinstance(body, (bytes, str)) else json.dumps(body)
        return gateway.ask("POST", "/v1/optimize" + query, body, {**JSON, **headers})

    def lines(self, answer):
        status, headers, body = answer
        self.assertEqual((status, headers["content-type"]), (200, "application/x-ndjson"), body[:500])
        self.assertTrue(body.endswith(b"\n"))
        return [json.loads(line) for line in body.splitlines()]

    def refused(self, status, words, answer):
        self.assertEqual(answer[0], status, answer)
        self.assertEqual(answer[1]["content-type"], "application/problem+json")
        self.assertIn(words, detail(answer[2]))
        return json.loads(answer[2])


class Answers(Case):
    @classmethod
    def setUpClass(cls):
        cls.gateway = Gateway()

    @classmethod
    def tearDownClass(cls):
        cls.gateway.close()

    def test_a_line_for_each_layer_and_one_for_the_summary(self):
        lines = self.lines(self.post(self.gateway, job(3)))
        self.assertEqual([line["layer"]["id"] for line in lines[:-1]], ["1", "2", "3"])
        for line in lines[:-1]:
            self.assertEqual(sorted(visit["contour"] for visit in line["layer"]["visits"]), list(range(6)))
        self.assertEqual(lines[-1]["summary"]["layers"], "3")

    def test_the_routes_are_those_of_the_command(self):
        folder = self.gateway.spool.name
        given, routes = os.path.join(folder, "job.json"), os.path.join(folder, "routes.json")
        with open(given, "w", encoding="utf-8") as file:
            json.dump(job(4), file)
        subprocess.run([os.environ["TRAVERSE"], "optimize", given, f"--json={routes}", "--quiet"], check=True)
        with open(routes, encoding="utf-8") as file:
            totals = [one["travel_mm"] for one in json.load(file)["layers"]]
        for path in (given, routes):
            os.unlink(path)
        lines = self.lines(self.post(self.gateway, job(4)))
        for line, total in zip(lines, totals, strict=False):
            self.assertAlmostEqual(line["layer"]["travel"]["total_mm"], total, places=6)

    def test_one_document_where_that_is_wanted(self):
        status, headers, body = self.post(self.gateway, job(2), Accept="application/json")
        self.assertEqual((status, headers["content-type"]), (200, "application/json"))
        results = json.loads(body)["results"]
        self.assertEqual([list(result) for result in results], [["layer"], ["layer"], ["summary"]])

    def test_gzip_and_names_in_camel_case(self):
        body = gzip.compress(json.dumps(job(2)).replace("job_id", "jobId").encode())
        for headers in ({"Content-Encoding": "gzip"}, {}):
            self.assertEqual(len(self.lines(self.post(self.gateway, body, **headers))), 3)

    def test_an_empty_job_is_answered(self):
        lines = self.lines(self.post(self.gateway, {}))
        self.assertEqual(lines[0]["summary"]["layers"], "0")

    # Routes look one layer ahead: the first is known when the second is.
    def test_a_line_comes_before_the_last_layer_is_done(self):
        endless = {"options": {"seed": 1, "strategy": {"name": "auto", "options": {"effort": "1e6"}},
                               "layer_time_limit": "50s"},
                   "layers": [layer(1), layer(1, 2), layer(900, 3)]}
        connection = http.client.HTTPConnection("127.0.0.1", self.gateway.http_port, timeout=60)
        self.addCleanup(connection.close)
        connection.request("POST", "/v1/optimize?deadline=55s", json.dumps(endless), JSON)
        answer = connection.getresponse()
        self.assertEqual(json.loads(answer.readline())["layer"]["id"], "1")
        self.assertEqual(self.gateway.metric("traverse_gateway_workers_busy"), 1)  # at the last layer

    def test_the_strategies(self):
        status, _, body = self.gateway.ask("GET", "/v1/strategies")
        found = json.loads(body)
        self.assertEqual(status, 200)
        self.assertIn("auto", [strategy["name"] for strategy in found["strategies"]])
        self.assertRegex(found["server_version"], r"^\d+\.\d+\.\d+$")
        self.assertEqual(self.gateway.ask("POST", "/v1/strategies", b"x")[0], 405)

    def test_faults_have_the_text_and_place_of_the_service(self):
        bad = job(2)
        bad["layers"][1]["islands"][0]["contours"][3]["points"] = [1, 2, 3]
        bad["layers"][1]["islands"][0]["contours"][4]["points"][3] = "NaN"
        problem = self.refused(400, "layers[1].islands[0].contours[3].points", self.post(self.gateway, bad, Accept="application/json"))
        self.assertEqual(problem["code"], "INVALID_ARGUMENT")
        self.assertEqual([fault["field"] for fault in problem["details"]],
                         ["layers[1].islands[0].contours[3].points", "layers[1].islands[0].contours[4].points[1].y"])
        inner = {"layers": [{"islands": [{"rasters": [{"points": [0, 0, 1, "NaN", 2, 2]}]}]}]}
        self.refused(400, "layers[0].islands[0].rasters[0].points[1].y: not finite", self.post(self.gateway, inner, Accept="application/json"))
        # In lines, the first layer may have been answered by then.
        answer = self.post(self.gateway, bad)
        if answer[0] == 200:
            self.assertIn("layers[1].islands", self.lines(answer)[-1]["error"]["detail"])
        else:
            self.refused(400, "layers[1].islands", answer)

    def test_what_is_refused_says_where(self):
        for body, status, words in [
                ('{"layers": [{"id": 1, "id": 2}]}', 400, "layers[0].id: given twice"),
                ('{"layers": [{"id": NaN}]}', 400, "layers[0].id: "),
                ('{"layers": [{"z_mm": 1e999}]}', 400, "layers[0].z_mm: "),
                ('{"layers": [{"isles": []}]}', 501, 'layers[0]: field "isles" is unknown'),
                ('{"options": {"strategy": {"name": "magic"}}}', 400, 'no strategy "magic"'),
                ('{"layers": [' * 100_000, 501, 'layers[0]: field "layers" is unknown'),
                ("[" * 1_000_000, 400, "not an object"),
                ("{", 400, "parse error"), ("hello", 400, "parse error"), (b"\x1f\x8b\x08garbage", 400, ""),
                (b"", 400, "there is no job")]:
            with self.subTest(body[:40]):
                self.refused(status, words, self.post(self.gateway, body))

    def test_requests_of_another_kind(self):
        for headers in ({}, {"Content-Type": "application/x-ndjson"}, {"Content-Type": "text/plain"}):
            self.refused(415, "application/json", self.gateway.ask("POST", "/v1/optimize", b"{}", headers))
        self.assertEqual(self.gateway.ask("GET", "/v1/optimize")[0], 405)
        self.refused(400, "colour", self.post(self.gateway, {}, "?colour=red"))
        self.refused(400, "deadline", self.post(self.gateway, {}, "?deadline=soon"))
        self.refused(403, "other sites", self.post(self.gateway, {}, Origin="http://evil.example"))

    def test_the_time_ends_with_the_best_so_far(self):
        hard = {"layers": [layer(1500, seed=3)], "options": {"strategy": {"name": "tabu"}}}
        begin = time.monotonic()
        lines = self.lines(self.post(self.gateway, hard, "?deadline=2s"))
        self.assertLess(time.monotonic() - begin, 10)
        self.assertEqual(lines[0]["layer"]["stop_reason"], "STOP_REASON_TIME_LIMIT")
        self.refused(504, "", self.post(self.gateway, hard, "?deadline=1ms"))

    def test_it_is_counted_and_logged(self):
        before = self.gateway.metric('traverse_gateway_requests_total{code="200",route="/v1/optimize"}')
        self.lines(self.post(self.gateway, job(1, job_id="plate-9")))
        self.assertEqual(self.gateway.metric('traverse_gateway_requests_total{code="200",route="/v1/optimize"}'), before + 1)
        with open(self.gateway.log.name, encoding="utf-8") as file:
            told = [json.loads(line) for line in file if '"plate-9"' in line]
        self.assertEqual([(line["event"], line["route"], line["layers"]) for line in told], [("layers", "/v1/optimize", "1")])


class Limits(Case):
    def test_a_body_beyond_the_limit_packed_or_not(self):
        gateway = self.start(Gateway, "--max_file_bytes=100000")
        large = json.dumps(job(200)).encode()
        self.refused(413, "longer than", self.post(gateway, large))
        self.refused(413, "", self.post(gateway, gzip.compress(b" " * 200_000 + b"{}")))

    def test_a_job_beyond_the_memory(self):
        gateway = self.start(Gateway, "--max_memory=100000000")
        self.refused(413, "MiB of memory", self.post(gateway, '{"layers": [{"islands": [' + "{}," * 300_000 + "{}]}]}"))
        self.assertLess(gateway.memory_mb(), 120)

    def test_who_does_not_read_is_held_on_disk_and_others_go_on(self):
        gateway = self.start(Gateway, "--workers=1", "--idle_timeout=5m")
        many = self.much_to_read()
        with socket.create_connection(("127.0.0.1", gateway.http_port)) as slow:
            slow.sendall(b"POST /v1/optimize HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
                         b"Content-Length: %d\r\n\r\n" % len(many) + many)
            self.wait(lambda: gateway.metric("traverse_gateway_spool_bytes") > 2_000_000
                      and gateway.metric("traverse_gateway_work_bytes") == 0)
            self.assertEqual(len(self.lines(self.post(gateway, job(2)))), 3)
            answer = http.client.HTTPResponse(slow)
            answer.begin()
            read = answer.read()
        lines = [json.loads(line) for line in read.splitlines()]
        self.assertEqual([line["layer"]["index"] for line in lines[:-1]], [str(i) for i in range(300)])
        self.assertEqual(lines[-1]["summary"]["layers"], "300")
        self.wait(lambda: gateway.metric("traverse_gateway_spool_bytes") == 0)

    def test_who_does_not_read_has_his_share_of_the_spool(self):
        gateway = self.start(Gateway, "--max_spool_bytes=3000000", "--idle_timeout=5m")
        many = self.much_to_read()
        with socket.create_connection(("127.0.0.1", gateway.http_port)) as slow:
            slow.sendall(b"POST /v1/optimize HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
                         b"Content-Length: %d\r\n\r\n" % len(many) + many)
            self.wait(lambda: b"RESOURCE_EXHAUSTED" in pathlib.Path(gateway.log.name).read_bytes())
            answer = http.client.HTTPResponse(slow)
            answer.begin()
            last = json.loads(answer.read().splitlines()[-1])
        self.assertIn("spool", last["error"]["detail"])
        self.assertEqual(503, last["error"]["status"])
        self.assertLess(0, last["error"]["retry_after"])

    def much_to_read(self):
        """A short job whose answer of 13 MB is more than sockets hold."""
        lines = {"islands": [{"rasters": [{"points": [0, 0, 1, 1]}] * 1000}]}
        return gzip.compress(json.dumps({"options": {"strategy": {"name": "none"}}, "layers": [lines] * 300}).encode())

    def test_a_client_who_goes_ends_the_work(self):
        gateway = self.start(Gateway)
        hard = json.dumps({"layers": [layer(3000, seed=3)], "options": {"strategy": {"name": "tabu"}}}).encode()
        with socket.create_connection(("127.0.0.1", gateway.http_port)) as client:
            client.sendall(b"POST /v1/optimize HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
                           b"Content-Length: %d\r\n\r\n" % len(hard) + hard)
            self.wait(lambda: gateway.metric("traverse_gateway_workers_busy") == 1)
        self.wait(lambda: gateway.metric("traverse_gateway_workers_busy") == 0)
        self.wait(lambda: gateway.metric("traverse_gateway_spool_bytes") == 0)

    def wait(self, condition, seconds=60):
        end = time.monotonic() + seconds
        while not condition():
            self.assertLess(time.monotonic(), end, "it did not come to that")
            time.sleep(0.05)


class Behind(Case):
    """With servers elsewhere."""

    def test_limits_and_advice_of_a_server_are_passed_on(self):
        server = self.start(Server, "--max_points_per_layer=100", "--max_jobs=1")
        gateway = self.start(Gateway, f"--server={server.address}")
        problem = self.refused(413, "more than this server's limit of 100",
                               self.post(gateway, {"layers": [layer(50)]}, Accept="application/json"))
        self.assertEqual(problem["code"], "RESOURCE_EXHAUSTED")
        hard = json.dumps({"layers": [layer(20, number=i + 1, seed=i) for i in range(2000)], "options": {"strategy": {"name": "tabu"}}})
        with socket.create_connection(("127.0.0.1", gateway.http_port)) as busy:
            busy.sendall(b"POST /v1/optimize HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
                         b"Content-Length: %d\r\n\r\n" % len(hard) + hard.encode())
            busy.recv(1)  # admitted
            answer = self.post(gateway, job(1))
        problem = self.refused(503, "", answer)
        self.assertEqual(str(problem["retry_after"]), answer[1]["retry-after"])

    def test_a_server_that_is_gone(self):
        server = self.start(Server)
        gateway = self.start(Gateway, f"--server={server.address}")
        self.assertEqual(len(self.lines(self.post(gateway, job(1)))), 2)
        server.close()
        self.refused(503, "", self.post(gateway, job(1), "?deadline=20s"))
        self.assertEqual(gateway.ask("GET", "/v1/strategies")[0], 503)

    def test_a_client_who_leaves_holds_no_worker_while_the_strategies_are_awaited(self):
        with socket.create_server(("127.0.0.1", 0)) as silent:
            gateway = self.start(lambda *flags: Gateway(*flags, threads=2), f"--server=127.0.0.1:{silent.getsockname()[1]}")
            clients = [socket.create_connection(("127.0.0.1", gateway.http_port)) for _ in range(2)]
            for client in clients:
                self.addCleanup(client.close)
                client.sendall(b"GET /v1/strategies HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
            def wait_for_busy(workers):
                while gateway.metric("traverse_gateway_workers_busy") != workers:
                    time.sleep(.01)
            wait_for_busy(2)
            clients[0].close()
            wait_for_busy(1)
            clients[1].setblocking(False)
            self.assertRaises(BlockingIOError, clients[1].recv, 1)  # it waits on

    def test_of_two_servers_one_dies_and_no_layer_is_lost_or_told_twice(self):
        servers = [self.start(Server) for _ in range(2)]
        gateway = self.start(Gateway, "--server=" + ",".join(server.address for server in servers))
        many = {"layers": [layer(60, number=i + 1, seed=i) for i in range(300)], "options": {"strategy": {"name": "ni2opt"}}}
        connection = http.client.HTTPConnection("127.0.0.1", gateway.http_port, timeout=120)
        self.addCleanup(connection.close)
        connection.request("POST", "/v1/optimize", json.dumps(many), JSON)
        answer = connection.getresponse()
        lines = [answer.readline()]
        servers[0].process.send_signal(signal.SIGKILL)
        lines += answer.read().splitlines()
        told = [json.loads(line) for line in lines]
        self.assertEqual([line["layer"]["index"] for line in told[:-1]], [str(i) for i in range(300)])
        self.assertEqual(told[-1]["summary"]["layers"], "300")

    def test_a_server_that_dies_in_the_middle_leaves_a_last_line(self):
        server = self.start(Server)
        gateway = self.start(Gateway, f"--server={server.address}")
        # The second layer takes all the time that there is.
        hard = {"layers": [layer(2), layer(3000, 2, seed=5)], "options": {"strategy": {"name": "tabu"}}}
        connection = http.client.HTTPConnection("127.0.0.1", gateway.http_port, timeout=120)
        self.addCleanup(connection.close)
        connection.request("POST", "/v1/optimize?deadline=60s", json.dumps(hard), JSON)
        answer = connection.getresponse()
        answer.readline()
        server.process.send_signal(signal.SIGKILL)
        last = json.loads(answer.read().splitlines()[-1])
        self.assertEqual(list(last), ["error"])
        self.assertEqual((last["error"]["status"], last["error"]["code"]), (503, "UNAVAILABLE"))


if __name__ == "__main__":
    unittest.main()
