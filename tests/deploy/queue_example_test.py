#!/usr/bin/python3
"""The queue example against the real broker, which is killed and started again: every file is done once."""

import os
import pathlib
import shutil
import signal
import sys
import tempfile
import unittest

import support

sys.path.append(str(support.SOURCE / "tests/client/gateway"))
from gateway_process import lines_of_infill

ORDERS = 8


def broker_program():
    """nats-server, which Debian puts where only root looks."""
    return shutil.which("nats-server") or shutil.which("nats-server", path="/usr/sbin")


class QueueExample(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        if broker_program() is None:
            raise unittest.SkipTest("no nats-server")
        cls.work = tempfile.TemporaryDirectory()
        cls.example = pathlib.Path(cls.work.name) / "queue"
        shutil.copytree(support.DEPLOY / "examples/queue", cls.example, ignore=shutil.ignore_patterns("node_modules"))
        support.install_node_packages(cls.example)
        packed = support.run("npm", "pack", "--silent", "--pack-destination", cls.work.name, support.SOURCE / "client/node").stdout
        support.run("npm", "install", "--no-save", "--silent", pathlib.Path(cls.work.name) / packed.split()[-1], cwd=cls.example)

    @classmethod
    def tearDownClass(cls):
        cls.work.cleanup()

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.queue = f"127.0.0.1:{support.free_port()}"
        self.inbox, self.outbox = self.folder / "inbox", self.folder / "outbox"
        self.inbox.mkdir()
        self.outbox.mkdir()
        self.gateway = f"127.0.0.1:{support.free_port()}"
        self.metrics = f"127.0.0.1:{support.free_port()}"
        self.start(support.binary("TRAVERSE_GATEWAY"), f"--listen={self.gateway}", "--listen_http=127.0.0.1:0",
                   f"--metrics_listen={self.metrics}")
        self.broker = self.start_broker()

    def start(self, *command):
        process = support.Process(*command)
        self.addCleanup(process.kill)
        return process

    def start_broker(self):
        return self.start(broker_program(), "-js", "-sd", self.folder / "store", "-a", "127.0.0.1", "-p", self.queue.split(":")[1])

    def worker(self):
        return self.start("node", self.example / "worker.mjs", self.queue, self.inbox, self.outbox, self.gateway)

    def order(self, *names):
        support.run("node", self.example / "submit.mjs", self.queue, *names, timeout=60)

    def done(self):
        return sorted(path.name for path in self.outbox.iterdir() if not path.name.endswith(".part"))

    def files_worked_on(self):
        text = support.http(f"http://{self.metrics}/metrics")[1]
        return sum(float(line.rsplit(" ", 1)[1]) for line in text.splitlines() if line.startswith("traverse_gateway_files_total"))

    def test_every_file_is_done_once_though_broker_and_worker_are_killed(self):
        names = [f"part{number}.gcode" for number in range(ORDERS)]
        for number, name in enumerate(names):
            (self.inbox / name).write_bytes(lines_of_infill(20 + number))
        workers = [self.worker() for _ in range(2)]
        self.order(*names, *names)

        support.wait_for(lambda: len(self.done()) >= 2, "the first files are done", 60)
        self.broker.popen.send_signal(signal.SIGKILL)
        self.broker.popen.wait()
        workers[0].popen.send_signal(signal.SIGKILL)
        self.broker = self.start_broker()
        self.order(*names)  # their sender does not know what was lost

        support.wait_for(lambda: self.done() == names, "all files are done", 120)
        for name in names:
            self.assertIn(b"; optimised by Traverse", (self.outbox / name).read_bytes())
        self.assertEqual(ORDERS, self.files_worked_on())

    def test_a_file_that_cannot_be_done_says_why(self):
        (self.inbox / "bad.gcode").write_bytes(b"no file of a slicer\n")
        self.worker()
        self.order("bad.gcode", "missing.gcode")

        support.wait_for(lambda: self.done() == ["bad.gcode.error", "missing.gcode.error"], "both are refused", 60)
        self.assertIn("INVALID_ARGUMENT", (self.outbox / "bad.gcode.error").read_text())

    def test_a_gateway_that_comes_later_is_waited_for(self):
        (self.inbox / "part.gcode").write_bytes(lines_of_infill(5))
        late = f"127.0.0.1:{support.free_port()}"
        self.start("node", self.example / "worker.mjs", self.queue, self.inbox, self.outbox, late)
        self.order("part.gcode")
        self.start(support.binary("TRAVERSE_GATEWAY"), f"--listen={late}", "--listen_http=127.0.0.1:0", "--metrics_listen=")

        support.wait_for(lambda: self.done() == ["part.gcode"], "the file is done", 60)


if __name__ == "__main__":
    support.main("node", "npm")
