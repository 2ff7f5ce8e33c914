#!/usr/bin/python3
"""The health probe tells the truth about a server that serves, drains, hangs or is not there."""

import signal
import socket
import time
import unittest

import support


def probe(address, *flags):
    return support.run(support.binary("TRAVERSE_PROBE"), f"--address={address}", *flags, ok=False)


class Probe(unittest.TestCase):

    def test_a_serving_server_is_healthy_as_a_whole_and_by_service(self):
        with support.Server() as server:
            for flags in ((), ("--service=",)):
                self.assertEqual((0, ""), (probe(server.address, *flags).returncode, probe(server.address, *flags).stderr))

    def test_an_unknown_service_is_not_healthy(self):
        with support.Server() as server:
            self.assertEqual(1, probe(server.address, "--service=traverse.v1.Other").returncode)

    def test_nobody_there_is_not_healthy(self):
        done = probe(f"127.0.0.1:{support.free_port()}")

        self.assertEqual(1, done.returncode)
        self.assertEqual(1, len(done.stderr.splitlines()))

    def test_a_server_that_does_not_answer_is_not_healthy_in_time(self):
        with socket.create_server(("127.0.0.1", 0)) as silent:
            begin = time.monotonic()
            done = probe(f"127.0.0.1:{silent.getsockname()[1]}", "--timeout=300ms")

            self.assertEqual(1, done.returncode)
            self.assertLess(time.monotonic() - begin, 3)

    def test_a_stopped_process_is_not_healthy(self):
        with support.Server() as server:
            server.popen.send_signal(signal.SIGSTOP)
            try:
                self.assertEqual(1, probe(server.address, "--timeout=300ms").returncode)
            finally:
                server.popen.send_signal(signal.SIGCONT)

    def test_sleep_only_waits(self):
        begin = time.monotonic()
        self.assertEqual(0, probe("127.0.0.1:1", "--sleep=200ms").returncode)
        self.assertGreaterEqual(time.monotonic() - begin, 0.2)

    def test_wrong_flags_and_unreadable_files_are_exit_codes_of_their_own(self):
        self.assertNotEqual(0, probe("127.0.0.1:1", "--nonsense").returncode)
        self.assertEqual(2, probe("127.0.0.1:1", "word").returncode)
        done = probe("127.0.0.1:1", "--tls_ca=/nowhere/ca.crt")
        self.assertEqual((2, "traverse-health-probe: cannot read /nowhere/ca.crt\n"), (done.returncode, done.stderr))


if __name__ == "__main__":
    support.main()
