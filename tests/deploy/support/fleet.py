"""Three servers behind HAProxy with the configuration of compose.yaml, on the loopback interface."""

import contextlib
import os
import threading
import time

import support


class Fleet:
    """Use in a `with` statement. Jobs go to `address`."""

    SIZE = 3

    def __init__(self, *flags, bind="proto h2"):
        self.bind = bind
        self.flags = ("--threads=1", "--max_jobs_per_caller=256", *flags)
        self.servers = []
        self._stack = contextlib.ExitStack()

    def __enter__(self):
        with contextlib.ExitStack() as stack:
            self.servers = [stack.enter_context(support.Server(*self.flags)) for _ in range(self.SIZE)]
            port, stats = support.free_port(), support.free_port()
            self.address, self.stats = f"127.0.0.1:{port}", f"127.0.0.1:{stats}"
            environment = {**os.environ, "TRAVERSE_LISTEN": self.address, "TRAVERSE_STATS": self.stats,
                           "TRAVERSE_BIND": self.bind}
            for index, server in enumerate(self.servers, start=1):
                environment[f"TRAVERSE_SERVER_{index}"] = server.address
                environment[f"TRAVERSE_METRICS_{index}"] = str(server.metrics_port)
            self.balancer = stack.enter_context(support.Process(
                "haproxy", "-db", "-f", support.DEPLOY / "compose/haproxy.cfg", env=environment))
            support.wait_for(lambda: self.up() == self.SIZE, "the balancer sees every server")
            self._stack = stack.pop_all()
        return self

    def __exit__(self, *_):
        self._stack.close()

    def up(self):
        """Servers that the balancer calls healthy."""
        lines = support.http(f"http://{self.stats}/metrics")[1].splitlines()
        return sum(line.startswith('haproxy_server_check_status{proxy="servers"') and 'state="L7OK"' in line
                   and line.endswith(" 1") for line in lines)

    def restart(self, index):
        """What a rolling update does with one server: SIGTERM, wait for its end, the same address again."""
        old = self.servers[index]
        code = old.terminate(seconds=60)
        support.wait_for(lambda: self.up() == self.SIZE - 1, "the balancer misses the server")
        self.servers[index] = self._stack.enter_context(
            support.Server(*self.flags, port=old.port, metrics_port=old.metrics_port))
        support.wait_for(lambda: self.up() == self.SIZE, "the balancer sees the server again")
        return code


class Load:
    """Threads that submit jobs one after the other until stopped.

    `submit()` does one job and raises if it failed.
    """

    def __init__(self, submit, threads):
        self.done, self.failures, self.seconds = 0, [], []
        self._stop = threading.Event()
        self._lock = threading.Lock()
        self._threads = [threading.Thread(target=self._run, args=(submit,)) for _ in range(threads)]

    def _run(self, submit):
        while not self._stop.is_set():
            begin = time.monotonic()
            try:
                submit()
                error = None
            except Exception as caught:  # whatever it is, the test reports it
                error = caught
            with self._lock:
                self.done += error is None
                self.seconds.append(time.monotonic() - begin)
                if error is not None:
                    self.failures.append(repr(error))

    def __enter__(self):
        for thread in self._threads:
            thread.start()
        return self

    def __exit__(self, *_):
        self._stop.set()
        for thread in self._threads:
            thread.join()
