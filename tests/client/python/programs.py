"""The real programs on free ports, and a wire to one that can be cut. TRAVERSE_SERVER and TRAVERSE_GATEWAY name the programs."""

import os
import re
import socket
import subprocess
import threading
import urllib.request


class Program:
    """A real program on free ports, which it says once it is up; `address` speaks gRPC."""

    def __init__(self, *command):
        self._process = subprocess.Popen([*command, "--listen=127.0.0.1:0", "--metrics_listen=127.0.0.1:0"],
                                         stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        said = [self._process.stdout.readline()]
        while not said[-1].startswith("metrics"):
            if not said[-1]:
                raise OSError(f"{command[0]} has ended")
            said.append(self._process.stdout.readline())
        port, self._metrics = (int(line.split()[-1]) for line in said[-2:])
        self.address = f"127.0.0.1:{port}"

    def kill(self):
        self._process.kill()
        self._process.wait()
        self._process.stdout.close()


def Server():
    return Program(os.environ["TRAVERSE_SERVER"])


class Gateway(Program):
    def __init__(self, *flags):
        super().__init__(os.environ["TRAVERSE_GATEWAY"], "--listen_http=127.0.0.1:0", *flags)

    def _told(self):
        with urllib.request.urlopen(f"http://127.0.0.1:{self._metrics}/metrics", timeout=10) as answer:
            return answer.read().decode()

    def metric(self, name):
        return float(re.search(f"^{name} (.+)$", self._told(), re.M).group(1))

    def files_worked_on(self):
        return sum(float(count) for count in re.findall(r"^traverse_gateway_files_total\{.*\} (.+)$", self._told(), re.M))


class Wire:
    """A wire to a program, which can be cut; new connections then go through again."""

    def __init__(self, address):
        host, port = address.split(":")
        self._to = host, int(port)
        self._ends = []
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.address = "127.0.0.1:%d" % self._listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self):
        while True:
            try:
                near, _ = self._listener.accept()
            except OSError:
                return
            try:
                far = socket.create_connection(self._to)
            except OSError:  # the program is not up yet: who calls tries again
                near.close()
                continue
            self._ends += [near, far]
            for a, b in ((near, far), (far, near)):
                threading.Thread(target=self._carry, args=(a, b), daemon=True).start()

    @staticmethod
    def _carry(a, b):
        try:
            while True:
                piece = a.recv(65536)
                if not piece:
                    break
                b.sendall(piece)
        except OSError:
            pass
        for end in (a, b):
            end.close()

    def cut(self):
        ends, self._ends = self._ends, []
        for end in ends:
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass

    def close(self):
        self._listener.close()
        self.cut()
