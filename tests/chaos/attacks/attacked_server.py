"""The server that is attacked, and what is watched meanwhile: memory, health, and another caller's jobs."""
import multiprocessing
import os
import re
import signal
import subprocess
import tempfile
import threading
import time
import urllib.request

from attacks.requests import layer, options
from http2_client import DATA, END_STREAM, SERVICE, Connection, frame, message

DRAIN_SECONDS = 2

# Control characters, ends of lines, and what turns the direction of text, in UTF-8.
TURNS = re.compile(rb"[\x00-\x09\x0b-\x1f\x7f]|\xc2[\x80-\x9f]|\xd8\x9c|\xe2\x80[\x8e\x8f\xa8-\xae]|\xe2\x81[\xa6-\xa9]")


class Server:
    def __init__(self, max_memory, flags=(), files=None):
        prefix = ["prlimit", f"--nofile={files}:{files}"] if files else []
        self.log = tempfile.TemporaryFile()
        self.process = subprocess.Popen(
            [*prefix, os.environ["TRAVERSE_SERVER"], "--listen=127.0.0.1:0", "--metrics_listen=127.0.0.1:0",
             f"--max_memory={max_memory}", f"--drain_timeout={DRAIN_SECONDS}s", *flags],
            stdout=subprocess.PIPE, stderr=self.log, text=True)
        self.port = int(self.process.stdout.readline().split()[-1])
        self.metrics_port = int(self.process.stdout.readline().split()[-1])

    def get(self, path, timeout=5):
        with urllib.request.urlopen(f"http://127.0.0.1:{self.metrics_port}{path}", timeout=timeout) as answer:
            return answer.read().decode()

    def memory(self):
        with open(f"/proc/{self.process.pid}/statm") as file:
            _, resident, shared = (int(word) for word in file.read().split()[:3])
        return (resident - shared) * os.sysconf("SC_PAGESIZE")

    def end(self):
        begin = time.monotonic()
        self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(timeout=60)
        took = time.monotonic() - begin
        self.process.stdout.close()
        return code, took

    def log_faults(self):
        """Lines of the log that a caller could write, or make read otherwise, and libraries that write into it."""
        self.log.seek(0)
        bad = [line for line in self.log if not (line.startswith(b'{"time":"') and line.endswith(b"}\n")) or TURNS.search(line)]
        self.log.close()
        return [f"{len(bad)} lines of the log are not its own: {bad[0][:100]}"] if bad else []


class Watch:
    """Looks at the server while it is attacked: memory often, health and a victim's jobs now and then. In a process of its own,
    so that it is not the attacks that it waits for, and from an address of its own, as another caller."""

    def __init__(self, server):
        self.server, self.peak, self.health, self.jobs, self.failed = server, 0, [], [], 0
        ours, theirs = multiprocessing.Pipe()
        self.pipe = ours
        self.process = multiprocessing.get_context("fork").Process(target=self.watch, args=(theirs,))
        self.process.start()

    def stop(self):
        self.pipe.send("stop")
        self.peak, self.health, self.jobs, self.failed = self.pipe.recv()
        self.process.join()

    def watch(self, pipe):
        self.stopping = threading.Event()
        threads = [threading.Thread(target=target) for target in (self.watch_memory, self.watch_health, self.be_a_victim)]
        for thread in threads:
            thread.start()
        pipe.recv()
        self.stopping.set()
        for thread in threads:
            thread.join()
        pipe.send((self.peak, self.health, self.jobs, self.failed))

    def watch_memory(self):
        while not self.stopping.wait(0.01):
            try:
                self.peak = max(self.peak, self.server.memory())
            except OSError:
                return

    def watch_health(self):
        while not self.stopping.wait(0.2):
            begin = time.monotonic()
            try:
                self.server.get("/healthz")
                self.health.append(time.monotonic() - begin)
            except OSError as error:
                self.health.append(float("inf"))
                print("    /healthz:", error)

    def be_a_victim(self):
        body = options() + layer(5)
        while not self.stopping.wait(0.1):
            begin = time.monotonic()
            try:
                connection = Connection(self.server.port, source="127.0.0.2")
                stream = connection.call(SERVICE + "OptimizeBatch", [("authorization", "Bearer victim")])
                connection.send(frame(DATA, END_STREAM, stream, message(body)))
                answered = b""
                connection.socket.settimeout(5)
                while b"grpc-status" not in answered and time.monotonic() - begin < 5:
                    more = connection.socket.recv(65536)
                    if not more:
                        break
                    answered += more
                connection.close()
                if b"grpc-status" in answered and len(answered) > 150:
                    self.jobs.append(time.monotonic() - begin)
                else:
                    self.failed += 1
            except OSError:
                self.failed += 1


def still_held(server):
    """What the server holds for callers who have gone, five seconds later."""
    held = [f"traverse_{name} 0" for name in ("queue_layers", "queue_points", "jobs_in_flight", "workers_busy", "connections",
                                              'memory_bytes{kind="receiving"}', 'memory_bytes{kind="jobs"}')]
    end = time.monotonic() + 5
    while held and time.monotonic() < end:
        told = server.get("/metrics").splitlines()
        held = [line for line in held if line not in told]
        time.sleep(0.1)
    return [f"it still holds what {line[:-2]} counts" for line in held]
