"""A server of its own and loads on it, for the measurements of this folder."""
import json
import os
import re
import subprocess
import sys
import tempfile
import urllib.request

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..")


def median(values):
    return sorted(values)[len(values) // 2]


class Server:
    """traverse-server with `flags`, on ports that it chose; ends with the block."""

    def __init__(self, build, flags=()):
        self.build = build
        self.process = subprocess.Popen(
            [f"{build}/server/traverse-server", "--listen=127.0.0.1:0", "--metrics_listen=127.0.0.1:0",
             "--log_file=/dev/null", *flags], stdout=subprocess.PIPE, text=True)
        ports = [self.process.stdout.readline() for _ in range(2)]
        if not all(ports):
            sys.exit("the server did not start")
        self.port, self.metrics_port = (int(line.split()[-1]) for line in ports)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        if self.process.wait() != 0:
            sys.exit(f"the server ended with {self.process.returncode}")

    def resident_mb(self):
        with open(f"/proc/{self.process.pid}/status", encoding="utf-8") as file:
            return int(re.search(r"VmRSS:\s+(\d+)", file.read()).group(1)) / 1024

    def metric(self, name):
        with urllib.request.urlopen(f"http://127.0.0.1:{self.metrics_port}/metrics", timeout=10) as answer:
            text = answer.read().decode()
        return float(re.search(rf"^{re.escape(name)} (\S+)$", text, re.MULTILINE).group(1))

    def start_load(self, *flags):
        """A traverse-loadgen under way."""
        return Load(self, flags)

    def load(self, *flags):
        """What a traverse-loadgen with `flags` found, as its --json says."""
        return self.start_load(*flags).wait()


class Load:
    def __init__(self, server, flags):
        self.folder = tempfile.TemporaryDirectory()
        self.file = os.path.join(self.folder.name, "load.json")
        self.process = subprocess.Popen(
            [f"{server.build}/client/loadgen/traverse-loadgen", f"--target=127.0.0.1:{server.port}",
             f"--json={self.file}", *flags], stdout=subprocess.DEVNULL)

    def running(self):
        return self.process.poll() is None

    def kill(self):
        self.process.kill()
        self.process.wait()
        self.folder.cleanup()

    def wait(self):
        self.process.wait()
        with self.folder, open(self.file, encoding="utf-8") as file:
            return json.load(file)
