#!/usr/bin/python3
"""Three servers behind the load balancer: jobs are shared evenly, and a rollout fails none."""

import sys
import tempfile
import threading
import time
import unittest

import support
from support import certificates, fleet, jobs, python_client

yaml = support.module("yaml", "python3-yaml")


class FleetCases(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        python_client.load()
        sys.path.insert(0, str(support.DEPLOY.parent / "tests/chaos"))
        cls.job = python_client.job(jobs.plate(layers=30, islands=25, vertices=24, options={"strategy": {"name": "greedy"}}))

    def client(self, address):
        from traverse_client import TravelOptimizer
        client = TravelOptimizer([address])
        self.addCleanup(client.close)
        return client

    def submit(self, client, deadline=30):
        indices = [result.index for result in python_client.optimize(client, self.job, deadline)]
        self.assertEqual(list(range(len(self.job.layers))), indices)

    def test_jobs_are_balanced_within_ten_percent(self):
        with fleet.Fleet() as servers:
            clients = [self.client(servers.address) for _ in range(2)]
            for client in clients:
                for _ in range(60):
                    self.submit(client)
            counts = [server.sum_of("traverse_jobs_total", code="OK") for server in servers.servers]

        print(f"jobs by server: {counts}")
        self.assertEqual(120, sum(counts))
        for count in counts:
            self.assertAlmostEqual(40, count, delta=4)

    def test_the_balancer_lets_in_over_tls_who_has_a_certificate(self):
        import grpc
        from traverse_client import TravelOptimizer, TraverseError
        with tempfile.TemporaryDirectory() as folder:
            files = certificates.Certificates(folder)
            bind = yaml.safe_load((support.DEPLOY / "compose.tls.yaml").read_text())["services"]["balancer"]["environment"]["TRAVERSE_BIND"]
            bind = bind.replace("/etc/traverse/tls/server.pem", str(files.path("server.pem")))
            bind = bind.replace("/etc/traverse/tls/clients.pem", str(files.path("ca.crt")))
            authority, key, certificate = (files.path(name).read_bytes() for name in ("ca.crt", "farm.key", "farm.crt"))
            with fleet.Fleet(bind=bind) as servers:
                known = TravelOptimizer([servers.address], grpc.ssl_channel_credentials(authority, key, certificate))
                self.addCleanup(known.close)
                for _ in range(6):
                    self.submit(known)
                counts = [server.sum_of("traverse_jobs_total", code="OK") for server in servers.servers]
                for credentials in (None, grpc.ssl_channel_credentials(authority)):
                    unknown = TravelOptimizer([servers.address], credentials)
                    self.addCleanup(unknown.close)
                    with self.assertRaises(TraverseError):
                        self.submit(unknown, deadline=2)

        self.assertEqual([2, 2, 2], counts)

    def test_a_rolling_restart_under_load_fails_no_job(self):
        with fleet.Fleet("--drain_timeout=20s") as servers:
            local = threading.local()

            def submit():
                if not hasattr(local, "client"):
                    local.client = self.client(servers.address)
                self.submit(local.client)

            with fleet.Load(submit, threads=4) as load:
                time.sleep(1)
                codes = [servers.restart(index) for index in range(3)]
                time.sleep(1)

        print(f"{load.done} jobs during the rollout, {len(load.failures)} failed, "
              f"longest {max(load.seconds):.2f} s; exit codes {codes}")
        self.assertEqual([], load.failures)
        self.assertEqual([0, 0, 0], codes)
        self.assertGreater(load.done, 20)

    def test_the_balancer_keeps_floods_of_one_address_from_others(self):
        from http2_client import END_HEADERS, HEADERS, RST_STREAM, SERVICE, Connection, frame
        with fleet.Fleet() as servers:
            port = int(servers.address.rsplit(":", 1)[1])
            client = self.client(servers.address)
            # More connections than an address may have: those beyond are closed at once.
            held, closed = [], 0
            for number in range(560):
                try:
                    held.append(Connection(port, source="127.0.0.3"))
                    closed += number >= 500 and held[-1].drain(0.02) == b""
                except OSError:
                    closed += 1
            # Calls that are reset at once, as many as fit into four seconds.
            flood = Connection(port, source="127.0.0.4")
            with fleet.Load(lambda: self.submit(client), threads=1) as load:
                end, calls = time.monotonic() + 4, 0
                while time.monotonic() < end:
                    block = b""
                    for _ in range(100):
                        stream = flood.next_stream
                        flood.next_stream += 2
                        block += frame(HEADERS, END_HEADERS, stream, flood.headers(SERVICE + "Optimize"))
                        block += frame(RST_STREAM, 0, stream, (8).to_bytes(4, "big"))
                    calls += 100
                    if not flood.send(block):
                        flood = Connection(port, source="127.0.0.4")
            begun = sum(server.sum_of("traverse_rpcs_total") for server in servers.servers)
            for connection in [*held, flood]:
                connection.close()

        print(f"{closed} of 60 connections closed; {calls} calls reset, {begun:.0f} reached servers; "
              f"{load.done} jobs beside, longest {max(load.seconds):.2f} s")
        self.assertGreaterEqual(closed, 55)
        self.assertEqual([], load.failures)
        self.assertGreater(load.done, 0)
        self.assertLess(begun, min(calls, 5000), "what is beyond the rate of an address never reaches a server")

    def test_a_killed_server_fails_no_job(self):
        with fleet.Fleet() as servers:
            client = self.client(servers.address)
            with fleet.Load(lambda: self.submit(client), threads=4) as load:
                time.sleep(1)
                servers.servers[1].popen.kill()
                time.sleep(3)

        print(f"{load.done} jobs, {len(load.failures)} failed, longest {max(load.seconds):.2f} s")
        self.assertEqual([], load.failures)
        self.assertGreater(load.done, 20)


if __name__ == "__main__":
    support.main("haproxy", "protoc", "grpc_python_plugin")
