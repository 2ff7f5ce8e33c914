"""What the Python client promises, against scripted servers and the real programs; run by the environment that package_test.py
makes, with the installed package. TRAVERSE_SERVER and TRAVERSE_GATEWAY name the programs."""

import asyncio
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock

import grpc

import traverse_client
from traverse_client import (AsyncGcodeGateway, AsyncTravelOptimizer, GcodeGateway, JobOptions, OptimizeBatchRequest,
                             RewriteOptions, RewriteProgress, TravelOptimizer, TraverseError, island, layer)
from programs import Gateway, Server, Wire
from traverse_client.file_job import FileJob
from traverse_client.optimizer import _Source
from traverse_client.remaining_job import RemainingJob
from traverse_client.wire import gcode_service_pb2, gcode_service_pb2_grpc, retry_info_pb2
from traverse_client.wire import route_optimizer_service_pb2 as api
from traverse_client.wire import route_optimizer_service_pb2_grpc as service

SQUARES = [[(x, y), (x + 4, y), (x + 4, y + 4), (x, y + 4)] for x in (0, 40, 20) for y in (0, 30)]


def layers(count, first=1):
    return [layer([island(contours=SQUARES)], id=number, z_mm=0.2 * number) for number in range(first, first + count)]


class ScriptedServer:
    """Answers each attempt as its turn says: (layers to answer, status code or None, delay in s or None)."""

    def __init__(self, *script):
        self.asked, self.tokens, self.options = [], [], []
        turns, lock = iter(script), threading.Lock()

        class Servicer(service.RouteOptimizerServiceServicer):
            def OptimizeBatch(_, request, context):
                self.options.append(request.options)
                yield from self.turn(request.layers, context, *take())

            def Optimize(_, requests, context):
                count, code, delay = take()
                sent = (layer for request in requests for layer in request.layers)
                yield from self.turn(sent, context, count, code, delay)

        def take():
            with lock:
                return next(turns)

        self._server = grpc.server(concurrent.futures.ThreadPoolExecutor(4))
        service.add_RouteOptimizerServiceServicer_to_server(Servicer(), self._server)
        self.address = f"127.0.0.1:{self._server.add_insecure_port('127.0.0.1:0')}"

    def turn(self, sent, context, count, code, delay):
        self.asked.append([])
        self.tokens.append(dict(context.invocation_metadata()).get("authorization"))
        for index, one in enumerate(sent):
            self.asked[-1].append(one.id)
            if code is not None and index == count:
                break
            answer = api.OptimizeBatchResponse()
            answer.layer.index, answer.layer.id, answer.layer.end.x_mm = index, one.id, one.id
            yield answer
        if code is None:
            yield api.OptimizeBatchResponse(summary=api.JobSummary())
            return
        if delay is not None:
            status, info = retry_info_pb2.Status(), retry_info_pb2.RetryInfo()
            info.retry_delay.FromNanoseconds(int(delay * 1e9))
            status.details.add(type_url="type.googleapis.com/google.rpc.RetryInfo", value=info.SerializeToString())
            context.set_trailing_metadata((("grpc-status-details-bin", status.SerializeToString()),))
        context.abort(code, "scripted")

    def __enter__(self):
        self._server.start()
        return self

    def __exit__(self, *_):
        self.stop()

    def stop(self):
        self._server.stop(None).wait()


async def collect(answers):
    return [answer async for answer in answers]


class Scripted(unittest.TestCase):
    """Each case runs with a list and with an iterable, sync and asyncio."""

    def each_form(self, *script):
        def sync(address, given):
            with TravelOptimizer([address]) as optimizer:
                return list(optimizer.optimize(given, 20))

        def asynchronous(address, given):
            async def run():
                async with AsyncTravelOptimizer([address]) as optimizer:
                    return await collect(optimizer.optimize(given, 20))

            return asyncio.run(run())

        for run in (sync, asynchronous):
            for form in (list, iter):
                with self.subTest(run=run.__name__, form=form.__name__), ScriptedServer(*script) as server:
                    yield server, lambda run=run, form=form, server=server: run(server.address, form(layers(5)))

    def test_layers_that_were_answered_are_not_asked_again(self):
        for server, run in self.each_form((2, grpc.StatusCode.UNAVAILABLE, 0.01), (1, grpc.StatusCode.UNAVAILABLE, 0.01),
                                          (9, None, None)):
            results = run()

            self.assertEqual([(result.index, result.id) for result in results], [(i, i + 1) for i in range(5)])
            self.assertEqual([asked[0] for asked in server.asked], [1, 3, 4])

    def test_a_fault_of_the_job_is_not_tried_again(self):
        for server, run in self.each_form((0, grpc.StatusCode.INVALID_ARGUMENT, None)):
            with self.assertRaises(TraverseError) as raised:
                run()

            self.assertEqual(raised.exception.code, grpc.StatusCode.INVALID_ARGUMENT)
            self.assertEqual(len(server.asked), 1)

    def test_what_the_iterable_raises_comes_out(self):
        def broken():
            yield from layers(2)
            raise KeyError("no third layer")

        async def run():
            with ScriptedServer((9, None, None)) as server:
                async with AsyncTravelOptimizer([server.address]) as optimizer:
                    await collect(optimizer.optimize(broken(), 20))

        with ScriptedServer((9, None, None)) as server, TravelOptimizer([server.address]) as optimizer:
            with self.assertRaisesRegex(KeyError, "no third layer"):
                list(optimizer.optimize(broken(), 20))
        with self.assertRaisesRegex(KeyError, "no third layer"):
            asyncio.run(run())

    def test_a_layer_that_two_attempts_wait_for_is_sent_once(self):
        async def run(server):
            async def slow():
                for one in layers(5):
                    yield one
                    while len(server.asked) < 2:
                        await asyncio.sleep(0.01)

            async with AsyncTravelOptimizer([server.address]) as optimizer:
                return await collect(optimizer.optimize(slow(), 20))

        gone = grpc.StatusCode.UNAVAILABLE
        with ScriptedServer((0, gone, 0.01), (2, gone, 0.01), (9, None, None)) as server:
            results = asyncio.run(run(server))

        self.assertEqual([(result.index, result.id) for result in results], [(i, i + 1) for i in range(5)])
        self.assertEqual([asked[0] for asked in server.asked], [1, 1, 3])

    def test_a_job_that_is_over_waits_for_no_layer(self):
        async def run(server, end):
            waits, over = asyncio.Event(), asyncio.Event()

            async def stalled():
                yield layers(1)[0]
                try:
                    waits.set()
                    await asyncio.Event().wait()
                finally:
                    over.set()

            async with AsyncTravelOptimizer([server.address]) as optimizer:
                answers = optimizer.optimize(stalled(), 0.5)
                await answers.__anext__()
                await waits.wait()
                await end(answers)
                await asyncio.wait_for(over.wait(), 20)

        async def deadline(answers):
            with self.assertRaises(TraverseError):
                await answers.__anext__()

        async def cancel(answers):
            task = asyncio.ensure_future(answers.__anext__())
            await asyncio.sleep(0)
            task.cancel()
            await asyncio.wait([task])

        async def leave(answers):
            await answers.aclose()

        for end in (deadline, cancel, leave):
            with self.subTest(end=end.__name__), ScriptedServer((9, None, None)) as server:
                asyncio.run(run(server, end))

    def test_the_deadline_holds_while_the_iterable_waits(self):
        over = threading.Event()
        with ScriptedServer((9, None, None)) as server, TravelOptimizer([server.address]) as optimizer:
            def stalled():
                yield layers(1)[0]
                server.stop()
                over.wait(20)

            begun = time.monotonic()
            with self.assertRaises(TraverseError):
                list(optimizer.optimize(stalled(), 1))
            seconds = time.monotonic() - begun
            over.set()

        self.assertLess(seconds, 10)

    def test_a_stream_that_a_proxy_resets_is_asked_for_again(self):
        for server, run in self.each_form((4, grpc.StatusCode.CANCELLED, None), (9, None, None)):
            self.assertEqual(len(run()), 5)
            self.assertEqual([asked[0] for asked in server.asked], [1, 5])

    def test_after_a_break_the_rhythm_of_cleaning_goes_on(self):
        options = JobOptions(cleaning={"point": {"x_mm": -7}, "every_layers": 3, "layers_since_cleaning": 1})
        gone = grpc.StatusCode.UNAVAILABLE
        with ScriptedServer((2, gone, 0.01), (1, gone, 0.01), (9, None, None)) as server:
            with TravelOptimizer([server.address]) as optimizer:
                results = list(optimizer.optimize(layers(5), 20, options=options))

        self.assertEqual([result.id for result in results], [1, 2, 3, 4, 5])
        self.assertEqual([one.cleaning.layers_since_cleaning for one in server.options], [1, 0, 1])
        self.assertEqual([one.start.x_mm for one in server.options], [0, -7, 3])

    def test_a_token_is_asked_for_each_attempt(self):
        tokens = iter(["old", "new"])
        with ScriptedServer((0, grpc.StatusCode.UNAVAILABLE, 0.01), (9, None, None)) as server:
            with TravelOptimizer([server.address], token=lambda: next(tokens)) as optimizer:
                list(optimizer.optimize(layers(1), 20))

        self.assertEqual(server.tokens, ["Bearer old", "Bearer new"])

    def test_a_server_that_asks_to_wait_beyond_the_deadline_ends_the_job(self):
        with ScriptedServer((0, grpc.StatusCode.RESOURCE_EXHAUSTED, 100)) as server:
            with TravelOptimizer([server.address]) as optimizer, self.assertRaises(TraverseError) as raised:
                list(optimizer.optimize(layers(1), 5))

        self.assertEqual(raised.exception.code, grpc.StatusCode.RESOURCE_EXHAUSTED)

    def test_one_string_is_no_list_of_addresses(self):
        with self.assertRaises(TypeError):
            TravelOptimizer("127.0.0.1:50051")


class Real(unittest.TestCase):
    def start(self, program):
        started = program()
        self.addCleanup(started.kill)
        return started

    def test_routes_come_for_lists_and_iterables(self):
        server = self.start(Server)
        with TravelOptimizer([server.address]) as optimizer:
            for form in (list, iter):
                results = list(optimizer.optimize(form(layers(20)), 30, strategy="ni2opt"))

                self.assertEqual([result.id for result in results], list(range(1, 21)))
                self.assertTrue(all(len(result.visits) == len(SQUARES) for result in results))
                self.assertLess(sum(result.travel.total_mm for result in results),
                                sum(result.given.total_mm for result in results))
            strategies = optimizer.strategies()
            self.assertIn("auto", [strategy.name for strategy in strategies])
            self.assertEqual(strategies.default_strategy, "auto")
            self.assertIn("partial_answers", strategies.capabilities)
            self.assertRegex(strategies.server_version, r"^\d+\.\d+\.\d+$")

    def test_a_known_route_is_where_the_search_begins(self):
        server = self.start(Server)
        islands = [island(contours=SQUARES, rasters=[[(1, 1), (3, 3)], [(41, 1), (43, 3)]])]
        plan = traverse_client.Layer(plan={"paths": [{"contour": {"points": [0, 0, 4, 0]}},
                                                     {"open_path": {"points": [9, 9, 8, 8]}}],
                                           "nodes": [{"any_order": {"children": [1, 2]}}, {"path": 0}, {"path": 1}]})
        with TravelOptimizer([server.address]) as optimizer:
            self.assertIn("initial_route", optimizer.strategies().capabilities)
            found = list(optimizer.optimize([layer(islands), plan], 30))
            known = traverse_client.Layer()
            known.CopyFrom(plan)
            known.initial_route.extend(found[1].visits)
            again = list(optimizer.optimize([layer(islands, initial_route=found[0].visits), known], 30, strategy="none"))

            self.assertEqual([list(one.visits) for one in again], [list(one.visits) for one in found])
            wrong = layer(islands, initial_route=[traverse_client.Visit(island=0, contour=9, vertex=0)])
            with self.assertRaises(TraverseError) as raised:
                list(optimizer.optimize([layer(islands), wrong], 30))
        self.assertEqual(raised.exception.code, grpc.StatusCode.INVALID_ARGUMENT)
        self.assertIn("layers[1].initial_route[0].contour: 9, but there are 6", str(raised.exception))

    def test_thousands_of_layers_wait_for_a_slow_reader(self):
        server = self.start(Server)
        taken = 0

        def endless():
            nonlocal taken
            for one in layers(3_000):
                taken += 1
                yield one

        def narrow(target, options, real=grpc.insecure_channel):
            # gRPC widens its window up to some MB, many times what these answers are.
            return real(target, [*options, ("grpc.http2.bdp_probe", 0)])

        with unittest.mock.patch("grpc.insecure_channel", narrow), TravelOptimizer([server.address]) as optimizer:
            answers = optimizer.optimize(endless(), 120, strategy="greedy")
            next(answers)
            before, unread = -1, taken
            while unread > before:
                time.sleep(0.5)
                before, unread = unread, taken
            rest = sum(1 for _ in answers)

        self.assertLess(unread, 2_000)
        self.assertEqual((rest, taken), (2_999, 3_000))

    def test_killing_one_of_three_servers_loses_no_layer(self):
        servers = [self.start(Server) for _ in range(3)]
        with TravelOptimizer([server.address for server in servers]) as optimizer:
            def job(number):
                got = [result.id for result in optimizer.optimize(iter(layers(40, 1000 * number)), 60)]
                return got == list(range(1000 * number, 1000 * number + 40))

            with concurrent.futures.ThreadPoolExecutor(6) as pool:
                jobs = [pool.submit(job, number) for number in range(1, 13)]
                concurrent.futures.wait(jobs, return_when=concurrent.futures.FIRST_COMPLETED)
                servers[0].kill()

                self.assertTrue(all(one.result() for one in jobs))

    def test_the_field_at_fault_is_named(self):
        server = self.start(Server)
        wrong = layer([island(contours=[[(0, 0), (float("nan"), 0), (1, 1)]])])
        with TravelOptimizer([server.address]) as optimizer, self.assertRaisesRegex(TraverseError, "points"):
            list(optimizer.optimize([wrong], 10))

    def test_a_file_comes_back_with_progress(self):
        gateway = self.start(Gateway)
        part = pathlib.Path(os.environ["TRAVERSE_SHORT"])
        seen = []
        with GcodeGateway([gateway.address]) as client:
            made = client.rewrite(part, options=RewriteOptions(report=True), on_progress=seen.append)

        self.assertTrue(made.summary.verified)
        self.assertEqual(len(made.data), made.summary.bytes)
        self.assertIn(b"<html", made.report)
        self.assertTrue(seen)

        async def run():
            async with AsyncGcodeGateway([gateway.address]) as client:
                return await client.rewrite(part.read_bytes())

        self.assertEqual(asyncio.run(run()).data, made.data)

    def test_an_empty_file_is_refused_with_a_reason(self):
        gateway = self.start(Gateway)
        with GcodeGateway([gateway.address]) as client, self.assertRaises(TraverseError):
            client.rewrite(b"")


class Threads(unittest.TestCase):
    """gRPC reads each attempt on a thread of its own, which may be late."""

    def test_an_attempt_that_is_over_before_it_is_read_changes_nothing(self):
        job, source = RemainingJob(None, None), _Source(iter(layers(2)))
        late = source.requests(job)
        source.leave()
        now = source.requests(job)
        next(now)
        next(now)
        job.answered(api.LayerResult(index=0))

        self.assertEqual([len(request.layers) for request in late], [0])
        self.assertEqual([request.layers[0].id for request in now], [2])
        self.assertEqual(job.answered(api.LayerResult(index=1)).index, 1)

    def test_what_is_being_fetched_when_an_attempt_ends_goes_to_the_next_one(self):
        def fails():
            raise KeyError("no layer")

        for last in (lambda: layers(1)[0], fails):
            asked, goes_on = threading.Event(), threading.Event()

            def slow():
                asked.set()
                goes_on.wait(5)
                yield last()

            job, source = RemainingJob(None, None), _Source(slow())
            with concurrent.futures.ThreadPoolExecutor() as pool:
                first = pool.submit(list, source.requests(job))
                self.assertTrue(asked.wait(20))
                source.leave()
                second = pool.submit(list, source.requests(job))
                goes_on.set()

                self.assertEqual(len(first.result()), 1)
                if last is fails:
                    self.assertRaisesRegex(KeyError, "no layer", second.result)
                else:
                    self.assertEqual([request.layers[0].id for request in second.result()[1:]], [1])


class LastCall(unittest.TestCase):
    def test_a_file_that_is_here_waits_for_no_gateway(self):
        job = FileJob(b"G1 X1 E1", None, None, None, 600, 1)
        self.assertEqual(job.call_settings("ReadJob")[1], True, "the only gateway may come back")
        seconds, waits = job.call_settings("CancelJob")
        self.assertLessEqual(seconds, 10)
        self.assertFalse(waits)


class DroppedCalls(unittest.TestCase):
    """Files survive what happens to their calls and to gateways."""

    def gateway(self, *flags):
        started = Gateway(*flags)
        self.addCleanup(started.kill)
        return started

    def forms(self):
        def sync(addresses, file, **more):
            with GcodeGateway(addresses) as client:
                return client.rewrite(file, 120, **more)

        def asynchronous(addresses, file, **more):
            async def run():
                async with AsyncGcodeGateway(addresses) as client:
                    return await client.rewrite(file, 120, **more)

            return asyncio.run(run())

        for run in (sync, asynchronous):
            with self.subTest(run=run.__name__):
                yield run

    def test_a_cut_wire_costs_no_work(self):
        part = pathlib.Path(os.environ["TRAVERSE_SAMPLE"]).read_bytes()
        for run in self.forms():
            gateway = self.gateway()
            wire = Wire(gateway.address)
            self.addCleanup(wire.close)
            cuts = []

            def cut(progress):
                if len(cuts) < 3 and progress.stage not in cuts:
                    cuts.append(progress.stage)
                    wire.cut()

            made = run([wire.address], part, on_progress=cut)

            self.assertGreaterEqual(len(cuts), 2)
            self.assertEqual(len(made.data), made.summary.bytes)
            self.assertEqual(gateway.files_worked_on(), 1)
            self.assertEqual(gateway.metric("traverse_gateway_jobs"), 0, "deleted when it was fetched")

    def test_another_gateway_takes_the_file_of_one_that_was_killed(self):
        part = pathlib.Path(os.environ["TRAVERSE_SAMPLE"]).read_bytes()
        for run in self.forms():
            gateways = [self.gateway("--gateway_name=" + name) for name in ("one", "two")]
            killed = []

            def kill(progress):
                if progress.stage == RewriteProgress.STAGE_SEARCHING and not killed:
                    killed.extend(one for one in gateways if one.metric("traverse_gateway_jobs") == 1)
                    killed[0].kill()

            made = run([one.address for one in gateways], part, on_progress=kill)

            self.assertEqual(len(killed), 1)
            self.assertEqual(len(made.data), made.summary.bytes)

    def test_who_does_not_wait_leaves_no_work_behind(self):
        for run in self.forms():
            gateway = self.gateway()

            def leave(progress):
                raise KeyError("enough")

            with self.assertRaisesRegex(KeyError, "enough"):
                run([gateway.address], pathlib.Path(os.environ["TRAVERSE_SAMPLE"]), on_progress=leave)
            end = time.monotonic() + 20
            while gateway.metric("traverse_gateway_jobs") and time.monotonic() < end:
                time.sleep(0.05)

            self.assertEqual(gateway.metric("traverse_gateway_jobs"), 0)

    def test_who_does_not_wait_is_not_kept_by_a_gateway_that_hangs(self):
        seconds = []

        class Servicer(gcode_service_pb2_grpc.GcodeServiceServicer):
            def CreateJob(self, requests, context):
                return gcode_service_pb2.CreateJobResponse(job={"id": "one"})

            def CancelJob(self, request, context):
                seconds.append(context.time_remaining())
                return gcode_service_pb2.CancelJobResponse()

        server = grpc.server(concurrent.futures.ThreadPoolExecutor(4))
        gcode_service_pb2_grpc.add_GcodeServiceServicer_to_server(Servicer(), server)
        address = f"127.0.0.1:{server.add_insecure_port('127.0.0.1:0')}"
        server.start()
        self.addCleanup(server.stop, None)

        def leave(progress):
            raise KeyError("enough")

        for run in self.forms():
            with self.assertRaisesRegex(KeyError, "enough"):
                run([address], b"G1", on_progress=leave)

            self.assertLess(seconds.pop(), 2)

    def test_the_same_key_with_another_file_is_refused(self):
        gateway = self.gateway()
        with GcodeGateway([gateway.address]) as client:
            with self.assertRaises(TraverseError) as raised:
                def again(_):
                    client.rewrite(b"; another\n", 10, idempotency_key="k")

                client.rewrite(pathlib.Path(os.environ["TRAVERSE_SAMPLE"]), idempotency_key="k", on_progress=again)

        self.assertEqual(raised.exception.code, grpc.StatusCode.ALREADY_EXISTS)


class Package(unittest.TestCase):
    def test_the_version_is_the_server_s(self):
        said = subprocess.run([os.environ["TRAVERSE_SERVER"], "--version"], capture_output=True, text=True).stdout

        self.assertIn(traverse_client.__version__, said)

    def test_it_says_that_it_is_typed(self):
        folder = pathlib.Path(traverse_client.__file__).parent

        self.assertTrue((folder / "py.typed").exists())
        self.assertTrue((folder / "wire/plan_pb2.pyi").exists())

    def test_the_examples_of_its_guide_run(self):
        text = pathlib.Path(os.environ["TRAVERSE_GUIDE"]).read_text()
        blocks = re.findall(r"```python\n(.*?)```", text, re.S)
        server, gateway = Server(), Gateway()
        self.addCleanup(server.kill)
        self.addCleanup(gateway.kill)
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "part.gcode").write_bytes(pathlib.Path(os.environ["TRAVERSE_SHORT"]).read_bytes())
            for block in blocks:
                block = block.replace("127.0.0.1:50051", server.address).replace("127.0.0.1:50061", gateway.address)
                done = subprocess.run([sys.executable, "-c", block], cwd=folder, capture_output=True, text=True, timeout=120)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertTrue(done.stdout.strip())
        self.assertEqual(len(blocks), 2)

    def test_the_examples_of_deploy_run(self):
        servers, gateway = [Server(), Server()], Gateway()
        for program in (*servers, gateway):
            self.addCleanup(program.kill)
        examples = pathlib.Path(os.environ["TRAVERSE_EXAMPLES"])

        def run(name, *arguments):
            command = [sys.executable, "-B", examples / name, *arguments]
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=120)
            self.assertEqual(done.returncode, 0, done.stderr)
            return done.stdout

        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "job.pb").write_bytes(OptimizeBatchRequest(layers=layers(3)).SerializeToString())
            said = run("submit_job.py", "job.pb", *(server.address for server in servers))
            self.assertEqual(len(re.findall(r"layer \d: travel .* mm -> .* mm", said)), 3)
            run("send_file.py", os.environ["TRAVERSE_SHORT"], "shorter.gcode", gateway.address)
            self.assertIn(b"; optimised by Traverse", pathlib.Path(folder, "shorter.gcode").read_bytes()[:1000])


if __name__ == "__main__":
    unittest.main()
