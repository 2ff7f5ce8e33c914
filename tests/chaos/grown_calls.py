"""What grow.py asks: commands of `traverse`, calls of traverse-gateway and traverse-server, each with what it took."""
import importlib.util
import json
import os
import resource
import subprocess

from attacks.attacked_server import Gateway, Server
from http2_client import GCODE_SERVICE, field

PATIENCE = 40  # seconds


class Command:
    """A command in a process of its own: its seconds of CPU and its peak of memory."""

    def __init__(self, *arguments, of_layers=False):
        self.arguments, self.of_layers = arguments, of_layers

    @staticmethod
    def can_be_asked():
        return True

    def run(self, given, other, made):
        files = {"GIVEN": given, "OTHER": other, "MADE": made}
        command = [os.environ["TRAVERSE"]] + [files.get(word, word) for word in self.arguments]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (30, 30)))
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = status
        return used.ru_utime + used.ru_stime, used.ru_maxrss * 1024


_running = {}


def end_programs():
    for program in _running.values():
        program.process.kill()
        program.process.wait()


class Call:
    """A call of a program that goes on running: what its process took meanwhile. A subclass asks."""
    of_layers = False
    binary = "TRAVERSE_GATEWAY"

    def can_be_asked(self):
        return self.binary in os.environ

    def program(self):
        if self.binary not in _running:
            start, flags = (Gateway, ["--max_time=30s"]) if self.binary == "TRAVERSE_GATEWAY" else (Server, [])
            _running[self.binary] = start(2_000_000_000, ["--log_file=/dev/null", *flags])
        return _running[self.binary]

    def run(self, given, other, made):
        pid = self.program().process.pid
        with open(f"/proc/{pid}/clear_refs", "w", encoding="ascii") as file:
            file.write("5")
        before = self.ticks(pid)
        self.ask(given, other, made)
        with open(f"/proc/{pid}/status", encoding="ascii") as file:
            peak = next(int(line.split()[1]) * 1024 for line in file if line.startswith("VmHWM"))
        return self.ticks(pid) - before, peak

    @staticmethod
    def ticks(pid):
        with open(f"/proc/{pid}/stat", encoding="ascii") as file:
            words = file.read().rpartition(")")[2].split()
        return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


class Http(Call):
    def __init__(self, path, both=False, of_layers=False):
        self.path, self.both, self.of_layers = path, both, of_layers

    def url(self, path):
        return f"http://127.0.0.1:{self.program().http_port}{path}"

    def ask(self, given, other, made):
        forms = ["-F", f"original=@{given}", "-F", f"optimised=@{other}"] if self.both else ["-F", f"file=@{given}"]
        if self.of_layers:
            forms = ["-H", "Content-Type: application/json", "--data-binary", f"@{given}"]
        self.curl(self.path, "-o", made, *forms)

    def curl(self, path, *flags):
        subprocess.run(["curl", "--silent", "--max-time", str(PATIENCE), *flags, self.url(path)], check=False,
                       stdout=subprocess.DEVNULL)


class HttpJob(Http):
    """A file as a job: sent, watched, fetched and forgotten."""

    def ask(self, given, other, made):
        super().ask(given, other, made)
        with open(made, encoding="utf-8") as file:
            name = json.load(file).get("id")
        if name is None:
            return  # refused
        self.curl("/v1/jobs/" + name, "-H", "Accept: text/event-stream")
        self.curl(f"/v1/jobs/{name}/file", "-o", made)
        self.curl("/v1/jobs/" + name, "-X", "DELETE")


class Grpc(Call):
    """A call to which `options` and a file, or two, are sent in pieces; answers are read to their end."""

    def __init__(self, method, options=b"", fields=(2,)):
        self.method, self.options, self.fields = method, options, fields

    def can_be_asked(self):
        return super().can_be_asked() and importlib.util.find_spec("grpc") is not None

    def messages(self, files):
        if self.options:
            yield self.options
        for number, name in zip(self.fields, files):
            with open(name, "rb") as file:
                while piece := file.read(1 << 18):
                    yield field(number, piece)

    def ask(self, given, other, made):
        import grpc
        address = f"127.0.0.1:{self.program().port}"
        with grpc.insecure_channel(address, [("grpc.max_receive_message_length", -1)]) as channel:
            try:
                self.send(channel, self.messages([given, other]))
            except grpc.RpcError:
                pass  # refused; what that took counts too

    def send(self, channel, messages):
        self.read(channel, self.method, messages)

    @staticmethod
    def read(channel, method, messages):
        """The first message of the answer, whose others are read, too."""
        return list(channel.stream_stream(GCODE_SERVICE + method)(iter(messages), timeout=PATIENCE))[0]


class GrpcJob(Grpc):
    """A file as a job: sent, watched, fetched and forgotten."""

    def send(self, channel, messages):
        answer = self.read(channel, "CreateJob", messages)
        # A job, whose first field is its id; both have at most three bytes for their length.
        at = answer.index(b"\x0a", 1) + 1
        question = field(1, answer[at + 1:at + 1 + answer[at]])
        for method in ("WatchJob", "ReadJob", "CancelJob"):
            self.read(channel, method, [question])


class OfServer(Call):
    """A job of layers that a server works on."""
    of_layers, binary = True, "TRAVERSE_SERVER"

    def __init__(self, *flags):
        self.flags = flags

    def ask(self, given, other, made):
        server = f"--server=127.0.0.1:{self.program().port}"
        subprocess.run([os.environ["TRAVERSE"], "optimize", given, server, f"--json={made}", "--quiet", *self.flags],
                       check=False, stderr=subprocess.DEVNULL)


# Of the options of Rewrite: the policy `free`, and the strategy by its name.
FREE_AND_GREEDY = field(1, b"\x10\x03" + field(3, field(1, b"greedy")))

ALL = {
    "inspect": Command("inspect", "GIVEN"),
    "greedy": Command("optimize", "GIVEN", "--policy=free", "--strategy=greedy", "-o", "MADE", "--quiet"),
    "timed": Command("optimize", "GIVEN", "--policy=balanced", "--deadline=1s", "-o", "MADE", "--quiet"),
    "safe": Command("optimize", "GIVEN", "--policy=safe", "-o", "MADE", "--quiet"),
    "fast": Command("optimize", "GIVEN", "--policy=fast", "-o", "MADE", "--quiet"),
    "safe_ni2opt": Command("optimize", "GIVEN", "--policy=safe", "--strategy=ni2opt", "-o", "MADE", "--quiet"),
    "fast_ni2opt": Command("optimize", "GIVEN", "--policy=fast", "--strategy=ni2opt", "-o", "MADE", "--quiet"),
    "verify": Command("verify", "GIVEN", "OTHER"),
    "same": Command("verify", "GIVEN", "GIVEN"),
    "free": Command("verify", "--policy=free", "--allow=infill_order,wall_order,fan_order,wipes", "GIVEN", "OTHER"),
    "compare": Command("compare", "GIVEN", "--strategies=none,greedy"),
    "convert": Command("convert", "GIVEN", "-o", "MADE"),
    "/v1/gcode": Http("/v1/gcode?strategy=greedy&policy=free"),
    "/v1/inspect": Http("/v1/inspect"),
    "/v1/verify": Http("/v1/verify", both=True),
    "/v1/jobs": HttpJob("/v1/jobs?strategy=greedy&policy=free"),
    "grpc/Rewrite": Grpc("Rewrite", FREE_AND_GREEDY),
    "grpc/Inspect": Grpc("Inspect"),
    "grpc/Verify": Grpc("Verify", fields=(1, 2)),
    "grpc/CreateJob": GrpcJob("CreateJob", field(1, FREE_AND_GREEDY)),
    "job": Command("optimize", "GIVEN", "--strategy=greedy", "--json", "MADE", "--quiet", of_layers=True),
    "job_auto": Command("optimize", "GIVEN", "--deadline=1s", "--json", "MADE", "--quiet", of_layers=True),
    "/v1/optimize": Http("/v1/optimize?deadline=30s", of_layers=True),
    "server": OfServer("--strategy=greedy"),
}

SHORT = ("inspect", "fast_ni2opt", "verify", "job")
