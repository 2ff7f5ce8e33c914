"""traverse.v1.GcodeService over gRPC, with Debian's Python client.

Skips without it. The environment names the binaries: TRAVERSE and TRAVERSE_GATEWAY.
"""
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
import unittest

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
from gateway_process import ENDLESS, TESTS, Gateway, endless_infill, lines_of_infill, optimised_by_command, square_wall, until

sys.path.append(os.path.join(TESTS, "chaos"))
from http2_client import GCODE_SERVICE, Connection, Window, field, message

PROTO = os.path.join(os.path.dirname(TESTS), "proto")
PART = lines_of_infill(3)

try:
    import grpc
    from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
except ImportError:
    if sys.executable != "/usr/bin/python3" and os.path.exists("/usr/bin/python3"):
        os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv])  # which has Debian's packages
    print("SKIPPED: no python3-grpcio")
    sys.exit(77)


def messages():
    """The messages of gcode_service.proto by name."""
    with tempfile.NamedTemporaryFile() as file:
        subprocess.run(["protoc", "-I", PROTO, "--include_imports", "-o", file.name, "traverse/v1/gcode_service.proto"],
                       check=True)
        files = descriptor_pb2.FileDescriptorSet.FromString(file.read())
    pool = descriptor_pool.DescriptorPool()
    for one in files.file:
        pool.Add(one)
    made = message_factory.MessageFactory(pool)
    names = [message.name for message in files.file[-1].message_type]
    return {name: made.GetPrototype(pool.FindMessageTypeByName("traverse.v1." + name)) for name in names}


MESSAGES = messages()
SEARCHING = 3  # RewriteProgress.STAGE_SEARCHING
# What ENDLESS says in words.
ENDLESS_OPTIONS = {"layer_time_limit": {"seconds": 1000},
                   "strategy": {"name": "tabu", "options": {"evaluations": "0", "diversifications": "1000000"}}}


def pieces(content, size=1000):
    return [content[at:at + size] for at in range(0, len(content), size)]


class OnGateway(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.gateway = Gateway("--max_file_bytes=2000000", "--idle_timeout=2s", "--gateway_name=one")
        cls.channel = grpc.insecure_channel(f"127.0.0.1:{cls.gateway.grpc_port}")

    @classmethod
    def tearDownClass(cls):
        cls.channel.close()
        cls.gateway.close()

    def method(self, name, kind="stream_stream", channel=None):
        return getattr(channel or self.channel, kind)(
            "/traverse.v1.GcodeService/" + name, request_serializer=lambda message: message.SerializeToString(),
            response_deserializer=MESSAGES[name + "Response"].FromString)


class Calls(OnGateway):
    def requests(self, content, **options):
        request = MESSAGES["RewriteRequest"]
        yield request(options=MESSAGES["RewriteOptions"](**options))
        for piece in pieces(content):
            yield request(data=piece)

    def rewrite(self, content, timeout=60, **options):
        """File, report, summary and stages."""
        file, report, summary, stages = b"", b"", None, []
        for answer in self.method("Rewrite")(self.requests(content, **options), timeout=timeout):
            self.assertIsNone(summary)
            file += answer.data
            report += answer.report
            if answer.HasField("progress"):
                stages.append(answer.progress.stage)
            if answer.HasField("summary"):
                summary = answer.summary
        return file, report, summary, stages

    def refused(self, code, words, requests, name="Rewrite", kind="stream_stream", timeout=60):
        with self.assertRaises(grpc.RpcError) as raised:
            answer = self.method(name, kind)(iter(requests), timeout=timeout)
            if kind == "stream_stream":
                list(answer)
        self.assertEqual(raised.exception.code(), code, raised.exception.details())
        self.assertIn(words, raised.exception.details())

    def test_the_bytes_are_those_of_the_command(self):
        for options, flags in [({}, []), ({"policy": 3, "seed": 3}, ["--policy=free", "--seed=3"]),
                               ({"policy": 3, "crossings": 3}, ["--policy=free", "--crossings=any"]),
                               ({"crossings": 2, "allow": [1, 2, 3, 4]},
                                ["--crossings=fewer", "--allow=infill_order,wall_order,fan_order,wipes"]),
                               ({"min_revisit_s": 12.5}, ["--min_revisit=12.5"]),
                               ({"first_layer": 2, "last_layer": 3}, ["--layers=2-3"]),
                               ({"strategy": {"name": "greedy"}}, ["--strategy=greedy"])]:
            file, report, summary, _ = self.rewrite(PART, name="part.gcode", **options)
            self.assertEqual(file, optimised_by_command(PART, *flags), flags)
            self.assertEqual(report, b"")
            self.assertTrue(summary.verified)
            self.assertEqual(summary.bytes, len(file))
            # Where islands must rest, greedy's order may leave nothing to gain.
            least = self.assertLessEqual if "strategy" in options else self.assertLess
            least(summary.written.travel_mm, summary.given.travel_mm)

    def test_moves_that_cannot_be_read_are_named(self):
        lines = PART.decode().split("\n")
        place = [i for i, line in enumerate(lines) if line.startswith("G1 X")][10]
        lines[place] = lines[place].replace("G1 ", "G1 (here) ")
        left = self.rewrite("\n".join(lines).encode(), name="odd.gcode")[2].left
        self.assertIn(f"1 line begins as a move does, but cannot be read (first in odd.gcode:{place + 1}), "
                      "and nothing passes such a line.", left)

    def test_the_machine_and_the_container_are_those_of_the_command(self):
        printer = "[printer]\nmax_velocity: 300\nmax_accel: 150\n"
        with tempfile.TemporaryDirectory() as folder:
            config, text, packed, made = (os.path.join(folder, name) for name in ("p.cfg", "a.gcode", "a.bgcode", "b.bgcode"))
            for path, content in [(config, printer.encode()), (text, PART)]:
                with open(path, "wb") as file:
                    file.write(content)
            file, _, slow, _ = self.rewrite(PART, name="a.gcode", machine=printer)
            self.assertEqual(file, optimised_by_command(PART, "--machine=" + config))
            self.assertGreater(slow.given.print_seconds, self.rewrite(PART, name="a.gcode")[2].given.print_seconds)
            command = [os.environ["TRAVERSE"], "optimize", "--quiet"]
            subprocess.run([*command, text, "-o", packed, "--container=bgcode", "--strategy=none"], check=True)
            subprocess.run([*command, packed, "-o", made, "--restate_times"], check=True)
            with open(packed, "rb") as file:
                content = file.read()
            with open(made, "rb") as file:
                self.assertEqual(self.rewrite(content, name="a.bgcode", restate_times=True)[0], file.read())
            back = self.rewrite(content, name="a.bgcode", container=1)[0]
            self.assertIn(b"\nG1 X10 Y", back.replace(b"X0", b"X10"))

    def test_report_and_progress(self):
        _, report, summary, stages = self.rewrite(lines_of_infill(50), report=True)
        self.assertIn(b"</html>", report)
        self.assertEqual(summary.layers, 50)
        self.assertTrue(stages)

    def test_a_large_file_comes_back_whole(self):
        content = lines_of_infill(100).replace(b";LAYER_CHANGE\n", b"; of no layer\n" * 700 + b";LAYER_CHANGE\n")
        file, _, summary, _ = self.rewrite(content, strategy={"name": "greedy"})
        self.assertGreater(len(file), 500000)
        self.assertEqual(file, optimised_by_command(content, "--strategy=greedy"))
        self.assertEqual(summary.bytes, len(file))

    def test_inspect_and_verify(self):
        request = MESSAGES["InspectRequest"]
        found = self.method("Inspect", "stream_unary")(
            iter([request(name="part.gcode")] + [request(data=piece) for piece in pieces(PART)]), timeout=60)
        self.assertEqual((found.format, found.layers), ("G-code", 3))
        self.assertGreater(found.totals.travel_mm, 0)
        request = MESSAGES["VerifyRequest"]
        made = optimised_by_command(PART)
        same = self.method("Verify", "stream_unary")(iter([request(original=PART), request(optimised=made)]), timeout=60)
        self.assertTrue(same.same)
        other = self.method("Verify", "stream_unary")(
            iter([request(original=PART), request(optimised=made.replace(b"E.5", b"E.6"))]), timeout=60)
        self.assertFalse(other.same)
        self.assertIn("optimised:", other.difference)
        self.assertEqual((other.rules[0].name, other.rules[0].breaks > 0), ("same_print", True))
        self.assertEqual(other.rules[0].first.message, other.difference)

    def test_verify_holds_a_file_to_the_policy_of_the_request(self):
        request, options = MESSAGES["VerifyRequest"], MESSAGES["VerifyOptions"]
        stated = b"; optimised by Traverse 0.1.0, policy free: travel 1 -> 1 mm\n"
        files = [request(original=square_wall(0)), request(optimised=stated + square_wall(2))]
        safe, balanced, free, fast, none = 1, 2, 3, 4, 0
        for policy, same, held in [(none, True, free), (safe, False, safe), (free, True, free), (fast, True, fast)]:
            answer = self.method("Verify", "stream_unary")(
                iter([request(options=options(policy=policy))] + files), timeout=60)
            self.assertEqual((answer.same, answer.policy), (same, held))
        broken = {rule.name for rule in self.method("Verify", "stream_unary")(
            iter([request(options=options(policy=safe))] + files), timeout=60).rules if rule.breaks}
        self.assertIn("seam", broken)
        answer = self.method("Verify", "stream_unary")(
            iter([request(options=options(policy=balanced, allow=[1, 3]))] + files), timeout=60)
        self.assertEqual((answer.policy, list(answer.allow)), (balanced, [1, 3]))
        bad = grpc.StatusCode.INVALID_ARGUMENT
        for wrong, words in [([request(options=options(policy=9))], "options.policy"),
                             ([request(options=options(allow=[0]))], "options.allow[0]"),
                             ([request(options=options())] * 2, "first message alone"),
                             ([files[0], request(options=options())], "first message alone")]:
            self.refused(bad, words, wrong, "Verify", "stream_unary")

    def test_what_is_wrong(self):
        request, options = MESSAGES["RewriteRequest"], MESSAGES["RewriteOptions"]
        bad = grpc.StatusCode.INVALID_ARGUMENT
        self.refused(bad, "options: missing", [])
        self.refused(bad, "options: missing", [request(data=PART)])
        self.refused(bad, "without data", [request(options=options()), request()])
        self.refused(bad, "only in the first message", [request(options=options()), request(options=options())])
        self.refused(bad, "the file is missing", [request(options=options())])
        self.refused(bad, "options.name", [request(options=options(name="../x"))])
        self.refused(bad, "options.policy", [request(options=options(policy=9))])
        self.refused(bad, "options.crossings", [request(options=options(crossings=9))])
        self.refused(bad, "options.allow[1]", [request(options=options(allow=[1, 0]))])
        self.refused(bad, "options.allow", [request(options=options(allow=[1] * 17))])
        self.refused(bad, "options.container", [request(options=options(container=9))])
        self.refused(bad, "options.machine:2", [request(options=options(machine="[printer]\nmax_accel: fast\n"))])
        self.refused(bad, "options.machine", [request(options=options(machine=" " * ((1 << 20) + 1)))])
        self.refused(bad, "plate", self.requests(PART, plate=2))
        for seconds in (-1, 3601, float("nan"), float("inf")):
            self.refused(bad, "options.min_revisit_s", [request(options=options(min_revisit_s=seconds))])
        self.refused(bad, "options.last_layer", [request(options=options(first_layer=3, last_layer=2))])
        self.refused(bad, "layers=2-9", self.requests(PART, first_layer=2, last_layer=9))
        self.refused(bad, "layer_time_limit", [request(options=options(layer_time_limit={"seconds": -1}))])
        self.refused(bad, "magic", self.requests(PART, strategy={"name": "magic"}))
        self.refused(bad, "file.gcode", self.requests(b"nothing of a slicer\n"))
        self.refused(grpc.StatusCode.OUT_OF_RANGE, "longer than", self.requests(b"; comment\n" * 210000))
        verify = MESSAGES["VerifyRequest"]
        self.refused(bad, "optimised: missing", [verify(original=PART)], "Verify", "stream_unary")

    def test_the_deadline(self):
        layer = endless_infill()
        began = time.time()
        self.rewrite(layer, timeout=120, strategy={"name": "greedy"})
        # On a busy machine reading and proving the file alone may take a second.
        enough = 3 + 4 * (time.time() - began)
        _, _, summary, _ = self.rewrite(layer, timeout=enough, **ENDLESS_OPTIONS)
        self.assertLess(summary.written.travel_mm, summary.given.travel_mm)
        with self.assertRaises(grpc.RpcError) as raised:
            self.rewrite(lines_of_infill(200), timeout=0.3)
        self.assertIn(raised.exception.code(), (grpc.StatusCode.FAILED_PRECONDITION, grpc.StatusCode.DEADLINE_EXCEEDED))

    def await_metric(self, name, value):
        until(lambda: self.gateway.metric(name) == value)
        self.assertEqual(self.gateway.metric(name), value)

    def test_cancelling_ends_the_work(self):
        call = self.method("Rewrite")(self.requests(endless_infill(), **ENDLESS_OPTIONS), timeout=60)
        while next(call).progress.stage != SEARCHING:
            pass
        call.cancel()
        self.await_metric("traverse_gateway_requests_in_flight", 0)

    def test_a_reader_that_goes_frees_a_call_whose_work_has_failed(self):
        """The work ends while the first word of its progress waits for a reader whose window is shut."""
        refused = 'traverse_gateway_files_total{outcome="refused"}'
        before = self.gateway.metric(refused)
        connection = Connection(self.gateway.grpc_port, window=0)
        stream = connection.call(GCODE_SERVICE + "Rewrite")
        requests = self.requests(PART, first_layer=2, last_layer=9)
        connection.data(stream, b"".join(message(request.SerializeToString()) for request in requests), end=True)
        self.await_metric(refused, before + 1)
        connection.close()
        self.await_metric("traverse_gateway_requests_in_flight", 0)

    def test_an_answer_that_is_not_let_in_is_given_up(self):
        part = message(field(2, PART))
        name = message(field(1, json.loads(self.gateway.ask("POST", "/v1/jobs", PART)[2])["id"].encode()))
        for method, request in [("Inspect", part), ("Verify", message(field(1, PART)) + part),
                                ("CreateJob", message(field(1, b"")) + part), ("GetJob", name), ("CancelJob", name)]:
            connection = Connection(self.gateway.grpc_port, window=0)
            stream = connection.call(GCODE_SERVICE + method)
            connection.data(stream, request, end=True)
            self.assertTrue(self.is_ended(connection), method)
            connection.close()

    def is_ended(self, connection):
        """Whether the gateway ends the one call of it, by trailers or by a reset, long after --idle_timeout at the latest."""
        window, end = Window(connection), time.time() + 30
        while time.time() < end and window.read(1):
            if window.ended:
                return True
        return window.ended

    def test_a_client_that_stops_is_given_up(self):
        stop = threading.Event()
        self.addCleanup(stop.set)

        def requests():
            yield MESSAGES["RewriteRequest"](options=MESSAGES["RewriteOptions"]())
            stop.wait(60)

        began = time.time()
        with self.assertRaises(grpc.RpcError):
            list(self.method("Rewrite")(requests(), timeout=30))
        self.assertLess(time.time() - began, 20)


class Jobs(OnGateway):
    def create(self, content, key="", deadline_s=None, **rewrite):
        def requests():
            request, options = MESSAGES["CreateJobRequest"], MESSAGES["CreateJobOptions"](idempotency_key=key)
            options.rewrite.CopyFrom(MESSAGES["RewriteOptions"](**rewrite))
            if deadline_s is not None:
                options.deadline.FromNanoseconds(int(deadline_s * 1e9))
            yield request(options=options)
            for piece in pieces(content):
                yield request(data=piece)

        return self.method("CreateJob", "stream_unary")(requests(), timeout=60).job

    def ask(self, name, channel=None, **fields):
        return self.method(name, "unary_unary", channel)(MESSAGES[name + "Request"](**fields), timeout=60)

    def stream(self, name, channel=None, **fields):
        return self.method(name, "unary_stream", channel)(MESSAGES[name + "Request"](**fields), timeout=60)

    def read(self, **fields):
        return b"".join(piece.data for piece in self.stream("ReadJob", **fields))

    def fault(self, code, words, ask):
        with self.assertRaises(grpc.RpcError) as raised:
            ask()
        self.assertEqual(raised.exception.code(), code, raised.exception.details())
        self.assertIn(words, raised.exception.details())

    def test_a_file_comes_back_without_its_call(self):
        job = self.create(PART, name="a.gcode", report=True)
        told = [answer.job for answer in self.stream("WatchJob", id=job.id)]
        self.assertEqual((told[-1].state, told[-1].name), (3, "a.gcode"))
        self.assertEqual([one.revision for one in told], sorted(one.revision for one in told))
        made = self.read(id=job.id)
        self.assertEqual(made, optimised_by_command(PART))
        self.assertEqual(self.read(id=job.id, offset=1000), made[1000:])
        self.assertEqual(self.read(id=job.id, offset=len(made)), b"")
        self.fault(grpc.StatusCode.INVALID_ARGUMENT, "offset", lambda: self.read(id=job.id, offset=len(made) + 1))
        self.assertIn(b"</html>", self.read(id=job.id, report=True))
        self.assertEqual(self.ask("GetJob", id=job.id).job, told[-1])
        late = [answer.job for answer in self.stream("WatchJob", id=job.id, known_revision=told[-1].revision)]
        self.assertEqual(late, [])
        self.ask("CancelJob", id=job.id)
        for call in ("GetJob", "CancelJob"):
            self.fault(grpc.StatusCode.ABORTED, "cancelled", lambda call=call: self.ask(call, id=job.id))
        self.fault(grpc.StatusCode.ABORTED, "cancelled", lambda: list(self.stream("WatchJob", id=job.id)))

    def test_the_job_is_the_same_over_http(self):
        job = self.create(PART)
        list(self.stream("WatchJob", id=job.id))
        status, _, made = self.gateway.ask("GET", f"/v1/jobs/{job.id}/file")
        self.assertEqual((status, made), (200, optimised_by_command(PART)))

    def test_the_same_key_makes_one_job(self):
        options = {"strategy": {"name": "auto", "options": {"effort": "1", "bound": "false", "gain_window": "200"}}}
        job = self.create(PART, key="k", **options)
        self.assertEqual(self.create(PART, key="k", **options).id, job.id)
        exists = grpc.StatusCode.ALREADY_EXISTS
        self.fault(exists, "another file", lambda: self.create(PART + b";\n", key="k", **options))
        self.fault(exists, "other options", lambda: self.create(PART, key="k"))

    def test_what_fails_says_what_rewrite_would(self):
        job = self.create(b"no file of a slicer\n")
        *_, last = self.stream("WatchJob", id=job.id)
        self.assertEqual((last.job.state, last.job.fault.code), (4, grpc.StatusCode.INVALID_ARGUMENT.value[0]))
        self.fault(grpc.StatusCode.INVALID_ARGUMENT, "file.gcode", lambda: self.read(id=job.id))
        late = self.create(lines_of_infill(400), deadline_s=0.001)
        *_, last = self.stream("WatchJob", id=late.id)
        self.assertEqual(last.job.fault.code, grpc.StatusCode.FAILED_PRECONDITION.value[0])

    def test_what_is_wrong_is_said_at_once(self):
        bad = grpc.StatusCode.INVALID_ARGUMENT
        self.fault(bad, "data: the file is missing or empty", lambda: self.create(b""))
        self.fault(bad, "options.rewrite.policy", lambda: self.create(PART, policy=77))
        self.fault(bad, "options.idempotency_key", lambda: self.create(PART, key="\n"))
        self.fault(bad, "options.deadline", lambda: self.create(PART, deadline_s=-1))
        data = MESSAGES["CreateJobRequest"](data=b"x")
        self.refused(bad, "options: missing", [data])
        self.refused(bad, "options: missing", [])

    def refused(self, code, words, requests):
        self.fault(code, words, lambda: self.method("CreateJob", "stream_unary")(iter(requests), timeout=60))

    def test_ids_of_others_and_of_other_gateways(self):
        job = self.create(PART)
        unknown = grpc.StatusCode.NOT_FOUND
        for wrong in ("", "x", job.id[:-1] + ("0" if job.id[-1] != "0" else "1")):
            self.fault(unknown, "no such job", lambda wrong=wrong: self.ask("GetJob", id=wrong))
            self.fault(unknown, "no such job", lambda wrong=wrong: self.read(id=wrong))
        other = Gateway("--gateway_name=two")
        self.addCleanup(other.close)
        with grpc.insecure_channel(f"127.0.0.1:{other.grpc_port}") as channel:
            elsewhere = grpc.StatusCode.FAILED_PRECONDITION
            self.fault(elsewhere, "gateway one", lambda: self.ask("GetJob", channel, id=job.id))

    def test_who_only_watches_gives_way(self):
        gateway = Gateway("--max_connections=3", "--workers=1")
        self.addCleanup(gateway.close)
        waiting = [json.loads(gateway.ask("POST", "/v1/jobs" + ENDLESS, endless_infill())[2])["id"] for _ in range(2)][1]

        def connect():
            channel = grpc.insecure_channel(f"127.0.0.1:{gateway.grpc_port}", [("grpc.use_local_subchannel_pool", 1)])
            self.addCleanup(channel.close)
            return channel

        watching = [self.stream("WatchJob", connect(), id=waiting) for _ in range(3)]
        for call in watching:
            next(call)
        time.sleep(1.1)
        self.assertEqual(self.ask("GetJob", connect(), id=waiting).job.id, waiting)
        # Which one is cut off, and what it was told before, depends on when the gateway heard of each.
        cut = threading.Event()

        def watch(call):
            try:
                for _ in call:
                    pass
            except grpc.RpcError:
                cut.set()

        for call in watching:
            threading.Thread(target=watch, args=(call,), daemon=True).start()
        self.assertTrue(cut.wait(60))

    def test_a_reader_that_goes_does_not_end_the_job(self):
        job = self.create(lines_of_infill(600), strategy={"name": "greedy"})
        call = self.stream("WatchJob", id=job.id)
        next(call)
        call.cancel()
        *_, last = self.stream("WatchJob", id=job.id)
        self.assertEqual(last.job.state, 3)


if __name__ == "__main__":
    unittest.main()
