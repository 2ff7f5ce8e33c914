"""The gateway over HTTP: files, what is answered to bad input.

The environment names the binaries: TRAVERSE and TRAVERSE_GATEWAY.
"""
import base64
import gzip
import io
import json
import lzma
import os
import subprocess
import sys
import tempfile
import time
import unittest
import zipfile

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
from gateway_process import SAMPLE, TESTS, Gateway, detail, events, form, lines_of_infill, optimised_by_command, square_wall

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
        for content, flags in [(PART, []), (PART, ["--policy=free", "--seed=3"]), (PART, ["--policy=fast"]), (PART, ["--layers=2-3"]),
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

    def test_the_summary_tells_how_long_islands_rest(self):
        with open(SAMPLE, "rb") as file:
            sample = file.read()
        status, _, body = self.post("/v1/gcode?strategy=ni2opt", sample, {"Accept": "application/json"})
        self.assertEqual(status, 200, body[:300])
        self.assertRegex(json.loads(body)["text"],
                         r"least rest of an island [\d.]+ -> [\d.]+ s \([\d.]+ s are enough\)")

    def test_the_summary_of_many_plates_is_cut(self):
        archive = io.BytesIO()
        with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as file:
            for plate in range(1, 31):
                file.writestr(f"Metadata/plate_{plate}.gcode", lines_of_infill(2))
        status, headers, body = self.post("/v1/gcode?policy=free&strategy=greedy", archive.getvalue())
        self.assertEqual(status, 200, body[:300])
        self.assertTrue(headers["traverse-summary"].endswith("; ..."))
        self.assertLess(max(len(value) for value in headers.values()), 2048)
        with open(self.gateway.log.name, encoding="utf-8") as log:
            self.assertLess(max(len(line) for line in log), 3000)

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
        answer = json.loads(self.post("/v1/verify", body, headers)[2])
        self.assertEqual((answer["same"], answer["difference"], answer["policy"]), (True, "", "POLICY_SAFE"))
        self.assertEqual((answer["rules"][0]["name"], {rule["breaks"] for rule in answer["rules"]}), ("same_print", {0}))
        body, headers = form([("optimised", "b.gcode", made.replace(b"E.5", b"E.6", 1)), ("original", "a.gcode", PART)])
        answer = json.loads(self.post("/v1/verify", body, headers)[2])
        self.assertFalse(answer["same"])
        self.assertIn("optimised:", answer["difference"])
        body, headers = form([("original", "a.gcode", PART)])
        self.refused(400, "original and optimised", self.post("/v1/verify", body, headers))

    def test_a_file_is_held_to_the_policy_of_the_request_whatever_it_states(self):
        stated = b"; optimised by Traverse 0.1.0, policy free: travel 1 -> 1 mm\n"
        body, headers = form([("original", "a.gcode", square_wall(0)),
                              ("optimised", "b.gcode", stated + square_wall(2))])
        self.assertTrue(json.loads(self.post("/v1/verify", body, headers)[2])["same"])
        answer = json.loads(self.post("/v1/verify?policy=safe", body, headers)[2])
        broken = [rule for rule in answer["rules"] if rule["breaks"]]
        self.assertEqual((answer["same"], answer["policy"]), (False, "POLICY_SAFE"))
        self.assertIn("seam", [rule["name"] for rule in broken])
        self.assertGreater(broken[0]["first"]["optimised_line"], 0)
        for wrong in ["policy=wild", "allow=walls", "seed=1", "policy=safe&policy=free"]:
            self.refused(400, wrong.split("=")[0], self.post("/v1/verify?" + wrong, body, headers))

    def test_the_limits_of_the_machine_come_with_the_file(self):
        seconds = []
        for accel in [100, 10000]:
            printer = f"[printer]\nmax_velocity: 300\nmax_accel: {accel}\n".encode()
            body, headers = form([("machine", "printer.cfg", printer), ("file", "a.gcode", PART)])
            seconds.append(json.loads(self.post("/v1/inspect", body, headers)[2])["totals"]["print_seconds"])
            with tempfile.NamedTemporaryFile(suffix=".cfg") as file:
                file.write(printer)
                file.flush()
                made = optimised_by_command(PART, "--machine=" + file.name)
            self.assertEqual(self.post("/v1/gcode", body, headers)[2], made)
        self.assertGreater(seconds[0], 2 * seconds[1])
        for printer, words in [(b"[printer]\nmax_accel: fast\n", "printer.cfg:2"), (b" " * (2 << 20), "1048576"), (b"", "printer.cfg")]:
            body, headers = form([("file", "a.gcode", PART), ("machine", "printer.cfg", printer)])
            self.refused(400, words, self.post("/v1/gcode", body, headers))

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
        self.refused(400, "send one", self.post("/v1/gcode", two, headers))
        # Refused where the second file begins: the rest of the body does not matter.
        self.refused(400, "send one", self.post("/v1/gcode", two[:-10], headers))
        long, headers = form([("file", "a.gcode", PART), ("machine", "a.cfg", b" " * (2 << 20))])
        self.refused(400, "machine: longer than 1048576", self.post("/v1/gcode", long[:-10], headers))
        body, headers = form([("machine", "a.cfg", b"M204 P1000"), ("file", "a.gcode", PART), ("machine", "b.cfg", b"x")])
        self.refused(400, "machine: given twice", self.post("/v1/gcode", body, headers))
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


if __name__ == "__main__":
    unittest.main()
