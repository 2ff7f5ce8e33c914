"""A gateway before three servers, under load: a server and the gateway itself are killed (SIGKILL).

Each upload is answered with the file that the command makes, or fails with a problem or a broken connection; nothing half
comes back, and nothing is left in the spool. The environment names the binaries: TRAVERSE, TRAVERSE_GATEWAY,
TRAVERSE_SERVER.
"""
import http.client
import os
import subprocess
import sys
import threading
import time
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.path.join(os.path.dirname(HERE), "client", "gateway"))
from gateway_process import Gateway, detail, lines_of_infill, optimised_by_command

PARTS = [lines_of_infill(layers) for layers in (20, 40, 80)]


class Server:
    def __init__(self):
        self.process = subprocess.Popen([os.environ["TRAVERSE_SERVER"], "--listen=127.0.0.1:0", "--metrics_listen=", "--threads=1",
                                         "--log_file=/dev/null", "--max_wait=60s"], stdout=subprocess.PIPE, text=True)
        self.address = "127.0.0.1:" + self.process.stdout.readline().split()[-1]

    def kill(self):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()


class Uploads:
    """Threads that send one file after the other. `answers` has the time, status and body of each; status 0: broken off."""

    def __init__(self, gateway, threads):
        self.answers, self.stopped = [], threading.Event()
        self.threads = [threading.Thread(target=self.run, args=(gateway, number)) for number in range(threads)]
        for thread in self.threads:
            thread.start()

    def run(self, gateway, number):
        while not self.stopped.is_set():
            part = PARTS[number % len(PARTS)]
            try:
                status, _, body = gateway.ask("POST", "/v1/gcode?strategy=ni2opt", part)
            except (OSError, http.client.HTTPException):
                status, body = 0, b""
                time.sleep(0.05)
            self.answers.append((time.time(), status, part, body))

    def stop(self):
        self.stopped.set()
        for thread in self.threads:
            thread.join()


class Killed(unittest.TestCase):
    def setUp(self):
        self.servers = [Server() for _ in range(3)]
        for server in self.servers:
            self.addCleanup(server.kill)
        self.whole = {part: optimised_by_command(part, "--strategy=ni2opt") for part in PARTS}

    def start(self, *flags):
        gateway = Gateway("--server=" + ",".join(server.address for server in self.servers), *flags)
        self.addCleanup(gateway.close)
        return gateway

    def good(self, answers):
        """How many have the whole file; all others fail cleanly."""
        good = 0
        for _, status, part, body in answers:
            if status == 200:
                self.assertEqual(body, self.whole[part])
                good += 1
            elif status != 0:
                self.assertIn(status, (502, 503, 504), body)
                self.assertTrue(detail(body))
        return good

    def wait_for(self, condition, what):
        deadline = time.time() + 20
        while not condition():
            self.assertLess(time.time(), deadline, what)
            time.sleep(0.02)

    def test_one_of_three_servers(self):
        gateway = self.start()
        uploads = Uploads(gateway, 6)
        self.addCleanup(uploads.stop)
        self.wait_for(lambda: len(uploads.answers) >= 6, "answers")
        self.servers[1].process.kill()
        killed = time.time()
        self.wait_for(lambda: sum(at > killed + 0.5 for at, *_ in uploads.answers) >= 6, "answers after the server's end")
        uploads.stop()
        answers = list(uploads.answers)
        after = [answer for answer in answers if answer[0] > killed]
        self.assertEqual(self.good(answers), len(answers), "the two servers that are left do all the work")
        self.assertGreaterEqual(len(after), 6)
        self.assertEqual(os.listdir(gateway.spool.name), [])

    def test_the_gateway(self):
        gateway = self.start()
        uploads = Uploads(gateway, 6)
        self.addCleanup(uploads.stop)
        self.wait_for(lambda: len(uploads.answers) >= 6, "answers")
        self.wait_for(lambda: gateway.metric("traverse_gateway_spool_bytes") > 0, "a file in the spool")
        gateway.process.kill()
        killed = time.time()
        gateway.process.wait()
        uploads.stop()
        self.assertGreaterEqual(self.good(uploads.answers), 6)
        self.assertTrue(any(at > killed and status == 0 for at, status, *_ in uploads.answers))
        self.assertEqual(os.listdir(gateway.spool.name), [])

        again = self.start("--spool_dir=" + gateway.spool.name)
        self.assertEqual(again.metric("traverse_gateway_spool_bytes"), 0)
        status, _, body = again.ask("POST", "/v1/gcode?strategy=ni2opt", PARTS[0])
        self.assertEqual((status, body), (200, self.whole[PARTS[0]]))
        self.assertEqual(os.listdir(gateway.spool.name), [])


if __name__ == "__main__":
    unittest.main()
