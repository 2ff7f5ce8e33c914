"""Weighs what a gateway counts for files of every make against the memory that it then takes.

    weigh.py [--bytes=LENGTH of each file, 6 MB] [--only=KIND,...] [--as=FORM,...] [--calls=PATH,...]

A form is how the file comes: as it is (plain), or packed in gzip, xz, bgcode or a 3mf; its length is what is unpacked.

Each file goes to a gateway of its own, whose metric traverse_gateway_work_bytes is what is counted. What it takes is the most
memory of its own that the process has meanwhile, less what it had before. `<` marks what takes more than is counted, `>` what is
counted at more than double, where the difference is more than the least that a file counts. The environment names the binaries:
TRAVERSE and TRAVERSE_GATEWAY.
"""
import argparse
import gzip
import io
import itertools
import lzma
import os
import subprocess
import sys
import tempfile
import threading
import time
import zipfile

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
import grown_files as grown
from attacks.attacked_server import Gateway

LEAST = 16 << 20  # for any file


def dense(n):
    return grown.one_layer(";TYPE:Internal infill\n" + grown.travel(0, 0) + "G1X1Y1E1\nG1X2Y1E1\n" * n)


def dense_layers(n):
    return grown.HEAD + "".join(grown.LAYER.format(z=z) + ";TYPE:Internal infill\n" + grown.travel(0, 0) + "G1X1Y1E1\nG1X2Y1E1\n" * 500
                               for z in range(1, n // 500 + 2)) + "M107\n"


def short_paths(n):
    return grown.one_layer(";TYPE:Internal infill\n" + "".join(f"G0X{x}Y{y}\nG1X{x + 1}Y{y}E1\n" for x, y in grown.spots(n)))


def short_paths_in_layers(n):
    return grown.HEAD + "".join(grown.LAYER.format(z=z) + ";TYPE:Internal infill\n"
                               + "".join(f"G0X{x}Y{y}\nG1X{x + 1}Y{y}E1\n" for x, y in grown.spots(200)) for z in range(1, n // 200 + 2)) + "M107\n"


def commented(n):
    return grown.one_layer(";TYPE:Internal infill\n" + "".join(grown.line(x, y, x + 2, y).replace("\n", " ; as it is said here, so it is done\n")
                                                             for x, y in grown.spots(n)))


def blank_lines(n):
    return grown.one_layer(";TYPE:Internal infill\n" + "\n" * n * 40 + grown.line(0, 0, 9, 9))


def sample(n):
    """A print by a slicer, layer upon layer again."""
    with open(os.path.join(os.path.dirname(grown.__file__), "..", "..", "deploy", "samples", "clusters13.gcode"), encoding="utf-8") as file:
        text = file.read()
    return text + "".join(f";LAYER_CHANGE\n;Z:{100 + z}\nG1 Z{100 + z}\n" + text[text.index(";LAYER_CHANGE"):text.rindex(";LAYER_CHANGE")]
                          for z in range(n * 60 // len(text)))


def between_two_paths(text):
    """Prints with `text`(i) again and again between two paths of a layer."""
    lines = grown.layers(3).splitlines(keepends=True)
    pulls = [i for i, line in enumerate(lines) if line.startswith("G1 E-1")]
    place = pulls[len(pulls) // 2]
    return lambda n: "".join(lines[:place]) + "".join(text(i) + "\n" for i in range(n)) + "".join(lines[place:])


BETWEEN = {"moves_between": lambda i: f"G1 X{i % 97} Y{i % 89} F9000", "lifts_between": lambda i: f"G1 Z{i % 9}",
           "pulls_between": lambda i: "G1 E-1" if i % 2 else "G1 E1", "arcs_between": lambda i: "G2 X1 Y1 I1 J1",
           "blanks_between": lambda i: "", "remarks_between": lambda i: ";", "labels_between": lambda i: f";MESH:a{i % 7}",
           "numbers_between": lambda i: f"M486 S{i % 5}", "layers_between": lambda i: f";LAYER:{i}",
           "messages_between": lambda i: "M117 a", "progress_between": lambda i: f"M73 P{i % 99}",
           "elapsed_between": lambda i: f";TIME_ELAPSED:{i}", "waits_between": lambda i: "G4 P1",
           "heat_between": lambda i: f"M104 S{200 + i % 2}", "tools_between": lambda i: f"T{i % 2}",
           "modes_between": lambda i: "G91" if i % 2 else "G90", "resets_between": lambda i: "G92 E0",
           "macros_between": lambda i: "A", "odd_lines_between": lambda i: "G1 X(", "fans_between": lambda i: f"M106 S{i % 255}",
           "hosts_between": lambda i: "M118 a", "feeds_between": lambda i: f"G1 F{i}"}


KINDS = {made.__name__: made for made in (dense, dense_layers, short_paths, short_paths_in_layers, commented, blank_lines, sample)}
KINDS.update({name: between_two_paths(text) for name, text in BETWEEN.items()})
KINDS.update({name: made for name, made in grown.DIMENSIONS.items() if name not in grown.SUFFIX})
CALLS = ["/v1/gcode?policy=free", "/v1/gcode?strategy=greedy", "/v1/inspect", "/v1/verify"]


def as_bgcode(content):
    with tempfile.TemporaryDirectory() as folder:
        given, made = os.path.join(folder, "given.gcode"), os.path.join(folder, "made.bgcode")
        with open(given, "wb") as file:
            file.write(content)
        subprocess.run([os.environ["TRAVERSE"], "convert", given, "-o", made], check=True)
        with open(made, "rb") as file:
            return file.read()


def as_3mf(content):
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr("Metadata/plate_1.gcode", content)
    return archive.getvalue()


FORMS = {"plain": bytes, "gzip": gzip.compress, "xz": lzma.compress, "bgcode": as_bgcode, "3mf": as_3mf}


def of_length(kind, length):
    """A file of about `length` bytes."""
    n = 1000
    while True:
        text = KINDS[kind](n)
        if len(text) > length * 0.7:
            return text.encode()
        n = int(n * min(length / len(text), 8)) + 1


class Weight:
    """What is counted and what is taken for one file."""

    def __init__(self, content, path):
        gateway = Gateway(12_000_000_000, ["--log_file=/dev/null", "--max_time=120s"])
        try:
            self.ask(gateway, grown.layers(3).encode(), path)  # starts what is started once
            before = gateway.memory()
            self.counted, self.peak, self.done = 0, 0, False
            watch = threading.Thread(target=self.watch, args=(gateway,))
            watch.start()
            self.status = self.ask(gateway, content, path)
            self.done = True
            watch.join()
            self.taken = self.peak - before
        finally:
            gateway.process.kill()
            gateway.process.wait()

    def watch(self, gateway):
        turn = 0
        while not self.done:
            self.peak = max(self.peak, gateway.memory())
            if turn % 20 == 0:
                told = gateway.get("/metrics")
                line = next(line for line in told.splitlines() if line.startswith("traverse_gateway_work_bytes "))
                self.counted = max(self.counted, int(float(line.split()[1])))
            turn += 1
            time.sleep(0.005)

    @staticmethod
    def ask(gateway, content, path):
        with tempfile.NamedTemporaryFile() as file:
            file.write(content)
            file.flush()
            both = path.startswith("/v1/verify")
            forms = ["-F", f"original=@{file.name}", "-F", f"optimised=@{file.name}"] if both else ["-F", f"file=@{file.name}"]
            done = subprocess.run(["curl", "--silent", "-o", "/dev/null", "-w", "%{http_code}", *forms, f"http://127.0.0.1:{gateway.http_port}{path}"],
                                  check=False, capture_output=True, text=True)
            return done.stdout


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--bytes", type=int, default=6_000_000)
    arguments.add_argument("--only", default=",".join(KINDS))
    arguments.add_argument("--as", dest="forms", default="plain")
    arguments.add_argument("--calls", default=",".join(CALLS))
    given = arguments.parse_args()
    faults = 0
    for kind, form in itertools.product(given.only.split(","), given.forms.split(",")):
        content = of_length(kind, given.bytes)
        row = f"{kind:22} {form:7} {len(content) / 1e6:5.1f} MB "
        content = FORMS[form](content)
        for path in given.calls.split(","):
            weight = Weight(content, path)
            low = weight.taken > weight.counted
            high = weight.counted - LEAST > 2 * weight.taken
            faults += low or high
            row += f" {weight.status} {weight.counted / 1e6:6.0f} / {weight.taken / 1e6:5.0f}{'<' if low else '>' if high else ' '}"
        print(row, flush=True)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
