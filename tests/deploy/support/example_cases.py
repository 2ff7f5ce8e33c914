"""What an example client must do, in any language: the same cases for each.

A subclass says how to start its submit_job. The generated Python classes serve the tests themselves, for a
server that refuses and breaks off as a script says.
"""

import concurrent.futures
import contextlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import unittest

import support
from support import certificates, jobs

grpc = support.module("grpc", "python3-grpcio")
json_format = support.module("google.protobuf.json_format", "python3-protobuf")

generated = tempfile.TemporaryDirectory(prefix="traverse-generated-")
sys.path.insert(0, generated.name)


def generate():
    """Makes the Python classes of the API."""
    support.run(support.DEPLOY / "examples/python/generate.sh", generated.name)


class ScriptedServer:
    """Answers each attempt as its turn of the script says, and notes the requests.

    A turn is (layers to answer, status code or None for all and a summary, retry delay in s or None).
    """

    def __init__(self, *script):
        from google.rpc import error_details_pb2, status_pb2
        from traverse.v1 import route_optimizer_service_pb2 as api
        from traverse.v1 import route_optimizer_service_pb2_grpc as service

        self.requests = requests = []
        turns = iter(script)
        lock = threading.Lock()

        class Servicer(service.RouteOptimizerServiceServicer):

            def OptimizeBatch(self, request, context):
                with lock:
                    requests.append(request)
                    layers, code, delay = next(turns)
                for index, layer in enumerate(request.layers[:layers]):
                    answer = api.OptimizeBatchResponse()
                    answer.layer.index, answer.layer.id = index, layer.id
                    answer.layer.end.x_mm = layer.id
                    yield answer
                if code is None:
                    yield api.OptimizeBatchResponse(summary=api.JobSummary())
                    return
                if delay is not None:
                    status = status_pb2.Status(code=code.value[0], message="scripted")
                    info = error_details_pb2.RetryInfo()
                    info.retry_delay.FromNanoseconds(int(delay * 1e9))
                    status.details.add().Pack(info)
                    context.set_trailing_metadata((("grpc-status-details-bin", status.SerializeToString()),))
                context.abort(code, "scripted")

        self._server = grpc.server(concurrent.futures.ThreadPoolExecutor(4))
        service.add_RouteOptimizerServiceServicer_to_server(Servicer(), self._server)
        self.address = f"127.0.0.1:{self._server.add_insecure_port('127.0.0.1:0')}"

    def __enter__(self):
        self._server.start()
        return self

    def __exit__(self, *_):
        self._server.stop(None).wait()


class ExampleCases:
    """Mixed into a TestCase that has `command`, the words that start submit_job."""

    command = ()

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.routes = pathlib.Path(self.folder.name) / "routes.jsonl"
        self.job = self.write_job(layers=12, islands=9)

    def tearDown(self):
        self.folder.cleanup()

    def write_job(self, **arguments):
        from traverse.v1 import route_optimizer_service_pb2 as api
        path = pathlib.Path(self.folder.name) / "job.pb"
        path.write_bytes(json_format.ParseDict(jobs.plate(**arguments), api.OptimizeBatchRequest()).SerializeToString())
        return path

    def submit(self, *servers, job=None, deadline=20, flags=()):
        return subprocess.run([*self.command, str(job or self.job), f"--server={','.join(servers)}",
                               f"--deadline={deadline}", f"--routes={self.routes}", *flags],
                              # gRPC's own log would report that the scripted server has no health service.
                              env={**os.environ, "GRPC_VERBOSITY": "NONE"},
                              capture_output=True, text=True, check=False, timeout=120)

    def answered(self):
        return [json.loads(line) for line in self.routes.read_text().splitlines()]

    def assert_done(self, done, layers=12):
        self.assertEqual((0, ""), (done.returncode, done.stderr))
        self.assertIn(f"{layers} layers, travel", done.stdout)
        self.assertEqual(list(range(1, layers + 1)), [int(answer["id"]) for answer in self.answered()])
        self.assertEqual(list(range(layers)), [int(answer.get("index", 0)) for answer in self.answered()])

    def test_a_job_comes_back_in_build_order_with_less_travel(self):
        with support.Server() as server:
            done = self.submit(server.address, flags=["--strategy=greedy"])

        self.assert_done(done)
        given, travel = (float(word) for word in done.stdout.replace("mm", "").split("travel ")[1].split("->"))
        self.assertLess(travel, 0.8 * given)

    def test_a_wrong_job_is_not_tried_again(self):
        with support.Server() as server:
            done = self.submit(server.address, flags=["--strategy=nonsense"])
            attempts = server.sum_of("traverse_jobs_total")

        self.assertEqual(1, done.returncode)
        self.assertIn("INVALID_ARGUMENT: options.strategy.name", done.stderr)
        self.assertEqual(1, attempts)

    def test_a_file_that_is_no_job_is_one_line_and_exit_code_1(self):
        self.job.write_bytes(b"\xff\xff\xff")
        done = self.submit("127.0.0.1:1")

        self.assertEqual((1, 1), (done.returncode, len(done.stderr.splitlines())))

    def test_wrong_flags_are_exit_code_2(self):
        self.assertEqual(2, self.submit("127.0.0.1:1", flags=["--nonsense"]).returncode)

    def test_without_a_server_the_deadline_ends_it(self):
        done = self.submit("127.0.0.1:1", deadline=1)

        self.assertEqual(3, done.returncode)
        self.assertIn("DEADLINE_EXCEEDED", done.stderr)

    def test_a_dead_server_in_the_list_does_no_harm(self):
        with support.Server() as server:
            self.assert_done(self.submit("127.0.0.1:1", server.address))

    def test_a_refusal_is_repeated_after_the_servers_delay(self):
        full = grpc.StatusCode.RESOURCE_EXHAUSTED
        with ScriptedServer((0, full, 0.3), (0, full, None), (99, None, None)) as server:
            done = self.submit(server.address)

        self.assert_done(done)
        self.assertEqual(3, len(server.requests))

    def test_a_delay_beyond_the_deadline_is_not_waited_for(self):
        with ScriptedServer((0, grpc.StatusCode.RESOURCE_EXHAUSTED, 60)) as server:
            done = self.submit(server.address, deadline=5)

        self.assertEqual(3, done.returncode)
        self.assertIn("RESOURCE_EXHAUSTED", done.stderr)

    def test_after_a_break_only_missing_layers_are_asked_for(self):
        gone = grpc.StatusCode.UNAVAILABLE
        with ScriptedServer((5, gone, None), (0, gone, None), (3, gone, None), (99, None, None)) as server:
            done = self.submit(server.address)

        self.assert_done(done)
        self.assertEqual([12, 7, 7, 4], [len(request.layers) for request in server.requests])
        # The rest starts where what was answered ended.
        self.assertEqual([0, 5, 5, 8], [request.options.start.x_mm for request in server.requests])

    def test_a_stream_that_a_proxy_resets_is_asked_for_again(self):
        with ScriptedServer((4, grpc.StatusCode.CANCELLED, None), (99, None, None)) as server:
            done = self.submit(server.address)

        self.assert_done(done)
        self.assertEqual([12, 8], [len(request.layers) for request in server.requests])

    def test_after_a_break_the_rhythm_of_cleaning_goes_on(self):
        gone = grpc.StatusCode.UNAVAILABLE
        options = {"cleaning": {"point": {"x_mm": -7, "y_mm": 0}, "every_layers": 3, "layers_since_cleaning": 1}}
        job = self.write_job(layers=12, islands=4, options=options)
        with ScriptedServer((2, gone, None), (1, gone, None), (99, None, None)) as server:
            done = self.submit(server.address, job=job)

        self.assert_done(done)
        self.assertEqual([1, 0, 1], [request.options.cleaning.layers_since_cleaning for request in server.requests])
        self.assertEqual([0, -7, 3], [request.options.start.x_mm for request in server.requests])

    def locked_servers(self, stack):
        """Two servers that want a certificate and a token; the flags that open them."""
        files = certificates.Certificates(self.folder.name)
        flags = [f"--tls_certificate={files.path('tls.crt')}", f"--tls_key={files.path('tls.key')}",
                 f"--tls_client_ca={files.path('ca.crt')}", f"--token_file={files.path('tokens')}"]
        servers = [stack.enter_context(support.Server(*flags)) for _ in range(2)]
        return servers, {"ca": files.path("ca.crt"), "certificate": files.path("farm.crt"), "key": files.path("farm.key"),
                         "token_file": files.path("token"), "server_name": "traverse"}

    @staticmethod
    def words(keys):
        return [f"--{name}={path}" for name, path in keys.items()]

    def test_a_certificate_and_a_token_open_every_server(self):
        with contextlib.ExitStack() as stack:
            servers, keys = self.locked_servers(stack)
            for first, second in (servers, servers[::-1]):
                self.assert_done(self.submit(first.address, second.address, flags=self.words(keys)))

    def test_who_is_not_let_in_is_told_so(self):
        with contextlib.ExitStack() as stack:
            servers, keys = self.locked_servers(stack)
            wrong = pathlib.Path(self.folder.name) / "wrong"
            wrong.write_text("another token")
            bad_token = self.submit(servers[0].address, flags=self.words({**keys, "token_file": wrong}))
            del keys["certificate"], keys["key"]
            no_certificate = self.submit(servers[0].address, deadline=1, flags=self.words(keys))
            plaintext = self.submit(servers[0].address, deadline=1)

        self.assertEqual([3, 3, 3], [bad_token.returncode, no_certificate.returncode, plaintext.returncode])
        self.assertIn("UNAUTHENTICATED", bad_token.stderr)

    def test_keys_that_are_missing_or_would_be_shown_to_anybody_are_exit_code_2(self):
        for flags in (["--ca=/nowhere/ca.crt"], ["--token_file=/nowhere/token"], ["--ca=x", "--key=y"],
                      ["--server=a:1,b:1", f"--ca={self.job}"]):
            with self.subTest(flags):
                self.assertEqual(2, self.submit("127.0.0.1:1", flags=flags).returncode)
