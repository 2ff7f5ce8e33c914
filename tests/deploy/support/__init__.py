"""What the tests of deploy/ share: tools that may be missing, free ports, servers.

A test of a tool that this machine lacks ends with exit code 77, which CTest shows as skipped.
"""

import importlib
import os
import pathlib
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.error
import urllib.request

SOURCE = pathlib.Path(__file__).resolve().parents[3]
sys.path.append(str(SOURCE))
from tests.support import node_packages

DEPLOY = SOURCE / "deploy"
SKIPPED = 77


def leave(reason):
    """Ends the program as skipped."""
    print(f"SKIPPED: {reason}", flush=True)
    sys.exit(SKIPPED)


def main(*tools):
    """Runs the cases of the program; skips them all unless every tool is on the path."""
    missing = [tool for tool in tools if not shutil.which(tool)]
    if missing:
        leave("not installed here: " + ", ".join(missing))
    result = unittest.main(verbosity=2, exit=False).result
    if result.wasSuccessful() and len(result.skipped) >= result.testsRun:
        leave("; ".join(sorted({reason for _, reason in result.skipped})))
    sys.exit(0 if result.wasSuccessful() else 1)


def run(*command, ok=True, **options):
    """Runs a command to its end; returns it with its output, which is printed if it failed."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)
    if ok and done.returncode != 0:
        print(f"$ {' '.join(map(str, command))}\n{done.stdout}{done.stderr}", flush=True)
        raise AssertionError(f"{command[0]} ended with {done.returncode}")
    return done


def binary(name):
    """Path of a program of the build, from the environment that CTest sets; skips without it."""
    path = os.environ.get(name)
    if not path or not os.access(path, os.X_OK):
        raise unittest.SkipTest(f"{name} does not name a built program")
    return path


def free_port():
    """A port of the loopback interface that nobody listens on now, and no client gets for its end of a connection."""
    while True:
        port = random.randrange(10_000, 32_000)
        with socket.socket() as probe:
            try:
                probe.bind(("127.0.0.1", port))
                return port
            except OSError:
                continue  # taken


def http(url, timeout=5):
    """Status and text of a page; status 0 if nobody answers."""
    try:
        with urllib.request.urlopen(url, timeout=timeout) as answer:
            return answer.status, answer.read().decode()
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode(errors="replace")
    except OSError as error:
        return 0, str(error)


def wait_for(condition, what, seconds=20):
    """Waits until `condition()` is true; fails after `seconds`."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.05)
    raise AssertionError(f"not within {seconds} s: {what}")


class Process:
    """A program that is ended with the test. Its output goes to a file of its own."""

    def __init__(self, *command, **options):
        self.log = tempfile.NamedTemporaryFile("w+", prefix="traverse-test-", suffix=".log")
        self.popen = subprocess.Popen([str(word) for word in command], stdout=self.log,
                                      stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, **options)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.kill()

    def output(self):
        return pathlib.Path(self.log.name).read_text(errors="replace")

    def terminate(self, seconds=30):
        """Sends SIGTERM and returns the exit code."""
        self.popen.send_signal(signal.SIGTERM)
        return self.popen.wait(seconds)

    def kill(self):
        if self.popen.poll() is None:
            self.popen.terminate()
            try:
                self.popen.wait(5)
            except subprocess.TimeoutExpired:
                self.popen.kill()
                self.popen.wait()


class Server(Process):
    """A traverse-server on the loopback interface, ready when made."""

    def __init__(self, *flags, port=None, metrics_port=None):
        self.port = port or free_port()
        self.metrics_port = metrics_port or free_port()
        self.address = f"127.0.0.1:{self.port}"
        self.metrics = f"http://127.0.0.1:{self.metrics_port}"
        super().__init__(binary("TRAVERSE_SERVER"), f"--listen={self.address}",
                         f"--metrics_listen=127.0.0.1:{self.metrics_port}", *flags)
        try:
            wait_for(self.ready, f"{self.address} is ready")
        except AssertionError:
            self.kill()
            print(self.output(), flush=True)
            raise

    def ready(self):
        if self.popen.poll() is not None:
            raise AssertionError(f"the server ended with {self.popen.returncode}: {self.output()}")
        return http(f"{self.metrics}/readyz")[0] == 200

    def sum_of(self, metric, **labels):
        """Sum of the samples of a metric whose labels include `labels`."""
        total = 0.0
        for line in http(f"{self.metrics}/metrics")[1].splitlines():
            name, _, rest = line.partition("{") if "{" in line else (line.split(" ")[0], "", line)
            if name == metric and all(f'{key}="{value}"' in rest for key, value in labels.items()):
                total += float(line.rsplit(" ", 1)[1])
        return total


def install_node_packages(folder):
    """`npm ci` in a copy of a folder with a lock file; skips if the packages cannot be had here."""
    missing = node_packages.install(folder)
    if missing:
        raise unittest.SkipTest(missing)


def module(name, package):
    """A module of Debian's Python; skips without it."""
    try:
        return importlib.import_module(name)
    except ImportError:
        return leave(f"no Python module {name} (Debian package {package})")
