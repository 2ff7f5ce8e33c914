"""Files as jobs over HTTP: /v1/jobs.

The environment names the binaries: TRAVERSE and TRAVERSE_GATEWAY.
"""
import http.client
import json
import os
import signal
import sys
import time
import unittest

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
from gateway_process import ENDLESS, TESTS, Gateway, detail, endless_infill, form, lines_of_infill, optimised_by_command, until

sys.path.append(os.path.join(TESTS, "chaos"))
from http2_client import GCODE_SERVICE, Connection, field, message

PART = lines_of_infill(3)
LONG = lines_of_infill(1500)


class Stream:
    """The events of a job, as they come."""

    def __init__(self, gateway, path, known=None):
        self.connection = http.client.HTTPConnection("127.0.0.1", gateway.http_port, timeout=60)
        headers = {"Accept": "text/event-stream"}
        if known is not None:
            headers["Last-Event-ID"] = str(known)
        self.connection.request("GET", path, headers=headers)
        self.answer = self.connection.getresponse()

    def next(self):
        """The next event as (id, name, data); None at the end."""
        fields = {}
        for line in iter(self.answer.readline, b"\n"):
            if not line:
                return None
            name, value = line.decode().rstrip("\n").split(": ", 1)
            fields[name] = value
        return int(fields.get("id", 0)), fields["event"], json.loads(fields["data"])

    def rest(self):
        told = list(iter(self.next, None))
        self.close()
        return told

    def close(self):
        self.answer.close()
        self.connection.close()


class Jobs(unittest.TestCase):
    def start(self, *flags):
        gateway = Gateway(*flags)
        self.addCleanup(gateway.close)
        return gateway

    def create(self, gateway, body=PART, query="", key=None, **headers):
        if key is not None:
            headers["Idempotency-Key"] = key
        status, headers, answer = gateway.ask("POST", "/v1/jobs" + query, body, headers)
        self.assertEqual(status, 202, answer)
        job = json.loads(answer)
        self.assertEqual(headers["location"], "/v1/jobs/" + job["id"])
        return job

    def path(self, job, part=""):
        return "/v1/jobs/" + job["id"] + part

    def now(self, gateway, job):
        status, _, answer = gateway.ask("GET", self.path(job))
        self.assertEqual(status, 200, answer)
        return json.loads(answer)

    def ended(self, gateway, job):
        states = ("STATE_DONE", "STATE_FAILED")
        self.assertTrue(until(lambda: self.now(gateway, job)["state"] in states))
        return self.now(gateway, job)

    def refused(self, status, words, answer):
        self.assertEqual((answer[0], answer[1]["content-type"]), (status, "application/problem+json"), answer)
        self.assertIn(words, detail(answer[2]))

    def test_a_file_comes_back_without_its_request(self):
        gateway = self.start()
        job = self.create(gateway, query="?report=true&name=a.gcode")
        done = self.ended(gateway, job)
        self.assertEqual((done["state"], done["name"], done["summary"]["verified"]), ("STATE_DONE", "a.gcode", True))
        for _ in range(2):  # it stays
            status, headers, made = gateway.ask("GET", self.path(job, "/file"))
            self.assertEqual((status, headers["content-type"]), (200, "text/x.gcode"))
            self.assertEqual(made, optimised_by_command(PART))
            self.assertIn("a.gcode", headers["content-disposition"])
        status, headers, report = gateway.ask("GET", self.path(job, "/report"))
        self.assertEqual((status, headers["content-type"]), (200, "text/html; charset=utf-8"))
        self.assertIn(b"</html>", report)
        self.assertEqual(gateway.ask("HEAD", self.path(job, "/file"))[::2], (200, b""))
        self.refused(405, "GET", gateway.ask("POST", self.path(job, "/file"), b""))
        self.refused(404, "openapi", gateway.ask("GET", self.path(job, "/files")))

    def test_what_is_not_there_is_said(self):
        gateway = self.start()
        job = self.create(gateway)
        self.ended(gateway, job)
        self.refused(404, "report=true", gateway.ask("GET", self.path(job, "/report")))
        bad = self.create(gateway, b"no file of a slicer\n")
        self.assertEqual(self.ended(gateway, bad)["fault"]["http_status"], 400)
        self.refused(400, "file.gcode", gateway.ask("GET", self.path(bad, "/file")))
        slow = self.create(gateway, endless_infill(), ENDLESS)
        self.refused(409, "under way", gateway.ask("GET", self.path(slow, "/file")))

    def test_files_that_are_none_are_refused_at_once(self):
        gateway = self.start("--max_file_bytes=1000000")
        self.refused(400, "empty", gateway.ask("POST", "/v1/jobs", b""))
        body, headers = form([("file", "a.gcode", b"")])
        self.refused(400, "empty", gateway.ask("POST", "/v1/jobs", body, headers))
        self.refused(400, "policy", gateway.ask("POST", "/v1/jobs?policy=wild", PART))
        self.refused(413, "1000000", gateway.ask("POST", "/v1/jobs", b";" * 1000001))
        self.refused(400, "Idempotency-Key", gateway.ask("POST", "/v1/jobs", PART, {"Idempotency-Key": "k" * 256}))
        self.refused(405, "POST", gateway.ask("GET", "/v1/jobs"))
        self.assertEqual(gateway.metric("traverse_gateway_jobs"), 0)

    def test_the_same_key_makes_one_job(self):
        gateway = self.start()
        job = self.create(gateway, key="order 7")
        for body, query in ((PART, ""), (PART, "?")):
            self.assertEqual(self.create(gateway, body, query, key="order 7")["id"], job["id"])
        body, headers = form([("file", "", PART)])
        self.assertEqual(self.create(gateway, body, key="order 7", **headers)["id"], job["id"])
        for body, query in ((PART + b";\n", ""), (PART, "?seed=2")):
            answer = gateway.ask("POST", "/v1/jobs" + query, body, {"Idempotency-Key": "order 7"})
            self.refused(409, "another file", answer)
        self.assertNotEqual(self.create(gateway, key="order 8")["id"], job["id"])
        self.assertNotEqual(self.create(gateway)["id"], self.create(gateway)["id"])
        self.assertEqual(gateway.ask("DELETE", self.path(job))[0], 204)
        self.assertNotEqual(self.create(gateway, PART, "?seed=2", key="order 7")["id"], job["id"])

    def test_a_key_is_free_again_after_a_failure_that_may_pass(self):
        gateway = self.start()
        late = self.create(gateway, LONG, "?deadline=1ms", key="a")
        self.assertEqual(self.ended(gateway, late)["fault"]["http_status"], 504)
        self.assertNotEqual(self.create(gateway, LONG, "?deadline=1ms", key="a")["id"], late["id"])
        bad = self.create(gateway, b"no file of a slicer\n", key="b")
        self.ended(gateway, bad)
        self.assertEqual(self.create(gateway, b"no file of a slicer\n", key="b")["id"], bad["id"])

    def test_events_go_on_where_they_were_lost(self):
        gateway = self.start("--workers=1")
        before = self.create(gateway, endless_infill(), ENDLESS)
        job = self.create(gateway)
        stream = Stream(gateway, self.path(job))
        known, name, first = stream.next()
        self.assertEqual((name, first["id"]), ("progress", job["id"]))
        stream.close()
        self.assertEqual(gateway.ask("DELETE", self.path(before))[0], 204)
        told = Stream(gateway, self.path(job), known).rest()
        self.assertGreater(told[0][0], known)
        self.assertEqual([number for number, _, _ in told], sorted(number for number, _, _ in told))
        self.assertEqual([name for _, name, _ in told][-1], "done")
        last = told[-1][0]
        self.assertEqual([event[1] for event in Stream(gateway, self.path(job), last - 1).rest()], ["done"])
        nothing = Stream(gateway, self.path(job), last)
        self.addCleanup(nothing.close)
        self.assertEqual(nothing.answer.status, 204)
        self.refused(400, "Last-Event-ID", gateway.ask("GET", self.path(job), headers={
            "Accept": "text/event-stream", "Last-Event-ID": "first"}))
        failed = self.create(gateway, b"no file of a slicer\n")
        self.assertEqual(Stream(gateway, self.path(failed)).rest()[-1][1], "failed")

    def test_the_oldest_of_too_many_readers_ends(self):
        gateway = self.start()
        job = self.create(gateway, endless_infill(), ENDLESS)
        streams = [Stream(gateway, self.path(job)) for _ in range(5)]
        for stream in streams:
            self.addCleanup(stream.close)
            self.assertEqual(stream.next()[1], "progress")
        self.assertEqual(streams[0].rest()[-1][1], "problem")
        self.assertEqual(gateway.ask("DELETE", self.path(job))[0], 204)
        self.assertEqual(streams[4].rest()[-1][2]["status"], 410)

    def test_cancelling_ends_the_work(self):
        gateway = self.start("--workers=1")
        jobs = [self.create(gateway, endless_infill(), ENDLESS) for _ in range(2)]
        self.assertTrue(until(lambda: gateway.metric("traverse_gateway_workers_busy") == 1))
        for job in jobs:
            self.assertEqual(gateway.ask("DELETE", self.path(job))[0], 204)
            self.refused(410, "cancelled", gateway.ask("GET", self.path(job)))
            self.refused(410, "cancelled", gateway.ask("DELETE", self.path(job)))
        self.assertTrue(until(lambda: gateway.metric("traverse_gateway_requests_in_flight") == 0))
        self.assertTrue(until(lambda: gateway.metric("traverse_gateway_spool_bytes") == 0))
        self.assertEqual(gateway.metric("traverse_gateway_jobs"), 0)

    def test_cancelled_jobs_wait_for_no_worker(self):
        gateway = self.start("--workers=1", "--max_requests_per_caller=4")
        self.create(gateway, endless_infill(), ENDLESS)
        self.assertTrue(until(lambda: gateway.metric("traverse_gateway_workers_busy") == 1))
        waiting = [self.create(gateway) for _ in range(3)]
        self.refused(429, "of this caller", gateway.ask("POST", "/v1/jobs", PART))
        for job in waiting:
            self.assertEqual(gateway.ask("DELETE", self.path(job))[0], 204)
        self.assertTrue(until(lambda: gateway.metric("traverse_gateway_requests_in_flight") == 1))
        self.create(gateway)

    def test_results_expire(self):
        gateway = self.start("--job_ttl=1s")
        job = self.create(gateway)
        self.assertTrue(until(lambda: gateway.ask("GET", self.path(job))[0] == 410))
        self.refused(410, "expired", gateway.ask("GET", self.path(job, "/file")))
        self.assertTrue(until(lambda: gateway.metric("traverse_gateway_spool_bytes") == 0))
        self.assertEqual(gateway.metric("traverse_gateway_jobs"), 0)

    def test_ids_are_nothing_to_others(self):
        gateway = self.start("--gateway_name=a.b-c")
        job = self.create(gateway)
        self.assertTrue(job["id"].startswith("a.b-c-"), job)
        self.ended(gateway, job)
        other = http.client.HTTPConnection("127.0.0.1", gateway.http_port, source_address=("127.0.0.2", 0))
        self.addCleanup(other.close)
        answers = []
        for path in (self.path(job), self.path(job, "/file"), "/v1/jobs/nonsense", "/v1/jobs/",
                     "/v1/jobs/" + job["id"][:-1] + ("0" if job["id"][-1] != "0" else "1")):
            for method in ("GET", "DELETE") if not path.endswith("file") else ("GET",):
                other.request(method, path)
                answer = other.getresponse()
                answers.append((answer.status, detail(answer.read())))
        self.assertEqual(set(answers), {(404, "there is no such job of this caller")})
        self.assertEqual(self.now(gateway, job)["state"], "STATE_DONE")

    def test_the_id_names_its_gateway(self):
        gateways = [self.start("--gateway_name=" + name) for name in ("one", "two")]
        job = self.create(gateways[0])
        for part in ("", "/file", "/report"):
            self.refused(421, "gateway one", gateways[1].ask("GET", self.path(job, part)))
        self.refused(421, "gateway one", gateways[1].ask("DELETE", self.path(job)))

    def test_a_killed_gateway_has_lost_its_jobs_and_says_so(self):
        gateway = self.start("--gateway_name=one")
        job = self.create(gateway, key="k")
        gateway.process.send_signal(signal.SIGKILL)
        gateway.process.wait()
        again = self.start("--gateway_name=one")
        self.refused(410, "send the file again", again.ask("GET", self.path(job)))
        self.assertEqual(self.ended(again, self.create(again, key="k"))["state"], "STATE_DONE")

    def test_draining_waits_until_results_are_fetched(self):
        gateway = self.start("--drain_timeout=280s")
        part = lines_of_infill(20)
        job, bad = self.create(gateway, part), self.create(gateway, b"no file of a slicer\n")
        gateway.process.send_signal(signal.SIGTERM)
        self.assertTrue(until(lambda: gateway.ask("GET", "/readyz")[0] == 503))
        self.refused(503, "another", gateway.ask("POST", "/v1/jobs", PART))
        self.assertEqual(self.ended(gateway, job)["state"], "STATE_DONE")
        self.assertEqual(self.ended(gateway, bad)["state"], "STATE_FAILED")
        time.sleep(0.5)
        self.assertIsNone(gateway.process.poll(), "it ended before the result was fetched")
        self.assertEqual(gateway.ask("GET", self.path(job, "/file"))[2], optimised_by_command(part))
        self.assertEqual(gateway.process.wait(timeout=20), 0)

    def test_draining_waits_for_who_had_nothing_of_a_result(self):
        """Whose window was shut when the file was read for him."""
        gateway = self.start("--drain_timeout=280s")
        job = self.create(gateway)
        self.ended(gateway, job)
        connection = Connection(gateway.grpc_port, window=0)
        stream = connection.call(GCODE_SERVICE + "ReadJob")
        connection.data(stream, message(field(1, job["id"].encode())), end=True)
        self.assertTrue(until(lambda: gateway.metric("traverse_gateway_grpc_connections") == 1))
        time.sleep(0.3)
        connection.close()
        self.assertTrue(until(lambda: gateway.metric("traverse_gateway_grpc_connections") == 0))
        self.assertEqual(gateway.metric("traverse_gateway_jobs_unfetched"), 1)
        gateway.process.send_signal(signal.SIGTERM)
        self.assertTrue(until(lambda: gateway.ask("GET", "/readyz")[0] == 503))
        self.assertEqual(gateway.ask("GET", self.path(job, "/file"))[2], optimised_by_command(PART))
        self.assertEqual(gateway.process.wait(timeout=20), 0)

    def test_draining_does_not_wait_for_ever(self):
        gateway = self.start("--drain_timeout=1s")
        self.ended(gateway, self.create(gateway))
        gateway.process.send_signal(signal.SIGTERM)
        self.assertEqual(gateway.process.wait(timeout=20), 0)

    def test_a_full_spool_is_said(self):
        gateway = self.start("--max_spool_bytes=300000")
        first = self.create(gateway, lines_of_infill(100), "?strategy=none")
        self.ended(gateway, first)
        self.refused(507, "spool", gateway.ask("POST", "/v1/jobs", lines_of_infill(1000)))
        kept = [first]
        while True:  # results fill the caller's share
            status, _, answer = gateway.ask("POST", "/v1/jobs?strategy=none", lines_of_infill(100))
            if status != 202:
                break
            kept.append(json.loads(answer))
            if self.ended(gateway, kept[-1])["state"] == "STATE_FAILED":
                self.assertIn("spool", self.now(gateway, kept[-1])["fault"]["message"])
                break
        self.assertLess(len(kept), 20)
        for job in kept:
            self.assertEqual(gateway.ask("DELETE", self.path(job))[0], 204)
        self.assertEqual(self.ended(gateway, self.create(gateway))["state"], "STATE_DONE")

    def test_jobs_are_bounded_and_a_caller_has_a_share(self):
        gateway = self.start("--max_jobs=4")
        jobs = [self.create(gateway) for _ in range(2)]
        self.refused(429, "2 jobs", gateway.ask("POST", "/v1/jobs", PART))
        self.assertEqual(gateway.metric("traverse_gateway_jobs"), 2)
        self.assertEqual(gateway.ask("DELETE", self.path(jobs[0]))[0], 204)
        self.create(gateway)

    def test_pages_of_other_sites_see_no_jobs(self):
        gateway = self.start()
        job = self.create(gateway)
        for headers in ({"Origin": "http://evil.example"}, {"Sec-Fetch-Site": "cross-site"}):
            self.assertEqual(gateway.ask("GET", self.path(job), headers=headers)[0], 403)
            self.assertEqual(gateway.ask("DELETE", self.path(job), headers=headers)[0], 403)
        self.assertEqual(self.ended(gateway, job)["state"], "STATE_DONE")
        self.assertEqual(gateway.metric('traverse_gateway_requests_total{code="202",route="/v1/jobs"}'), 1)
        _, _, text = gateway.ask("GET", "/metrics")
        self.assertNotIn(job["id"], text.decode())


if __name__ == "__main__":
    unittest.main()
