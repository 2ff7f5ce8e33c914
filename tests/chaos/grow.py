"""Reports what grows faster than n log n in time or memory, in which dimension of a file or a job.

    grow.py [--seconds=S, 2] [--only=DIMENSION,...] [--calls=NAME,...] [--short]

Each row is a dimension (grown_files.py: paths, tools, labels, ...), each column a command of `traverse`, or a call of a
gateway or a server by HTTP or gRPC (grown_calls.py). A cell makes the dimension four times as large until a run takes
about S seconds or the file has 24 MB, and shows the last run and by what time and memory grew from the one before:
n log n is a factor of about 5. `*` marks time, and `!` memory, that grew by more than 7, time of processors in each of
three pairs. Of a call they are those of the program that is asked. `--short` looks at sizes of half a second, in few
commands. The environment names the binaries: TRAVERSE, and optionally TRAVERSE_GATEWAY and TRAVERSE_SERVER, whose calls
are then asked too.
"""
import argparse
import os
import random
import sys
import tempfile

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
from grown_calls import ALL, SHORT, end_programs
from grown_files import DIMENSIONS, MOST, SUFFIX

FIRST = 60
MOST_BYTES = 24 << 20
FASTER = 7
# Less is mostly what a process takes to start.
LEAST_SECONDS = 0.2
LEAST_MEMORY = 48 << 20


def shuffled(text):
    """The same with its paths in another order: what a verifier is given that was not made by this program."""
    begin = "G1 E-1 F2100\n"
    if isinstance(text, bytes) or begin not in text:
        return text
    parts = text.split(begin)
    middle = parts[1:-1]
    random.Random(5).shuffle(middle)
    return begin.join(parts[:1] + middle + parts[-1:])


class Cell:
    """A dimension in a call."""

    def __init__(self, dimension, call, folder):
        self.dimension, self.call = dimension, call
        suffix = SUFFIX.get(dimension, ".gcode")
        self.files = [os.path.join(folder, name + suffix) for name in ("given", "other", "made")]

    def run(self, n):
        """What n of it take: seconds and bytes of memory. A process counts what its parent had, so another one writes."""
        writer = os.fork()
        if writer == 0:
            self.write(n)
            os._exit(0)
        os.waitpid(writer, 0)
        return self.call.run(*self.files)

    def write(self, n):
        content = DIMENSIONS[self.dimension](n)
        for path, text in zip(self.files, (content, shuffled(content))):
            with open(path, "wb") as file:
                file.write(text.encode() if isinstance(text, str) else text)

    def grow(self, seconds):
        """What the last step took and grew by, and whether that is too much."""
        n, before, now = FIRST, None, self.run(FIRST)
        # The next one takes about as many seconds, or fewer than four times as many.
        most = MOST.get(self.dimension, 1 << 30) // 4
        while now[0] < seconds / 3 and n <= most and os.path.getsize(self.files[0]) < MOST_BYTES / 4:
            n *= 4
            before, now = now, self.run(n)
        text = f"{now[0]:5.2f}s {now[1] >> 20:5}M"
        if before is None:
            return text, False
        growth = self.growth(before, now)
        for _ in range(2):
            if growth <= FASTER:
                break
            growth = min(growth, self.growth(self.run(n // 4), self.run(n)))
        slow = growth > FASTER
        large = now[1] > LEAST_MEMORY and now[1] > FASTER * before[1]
        return text + f" x{growth:.1f} x{now[1] / before[1]:.1f}" + "*" * slow + "!" * large, slow or large

    @staticmethod
    def growth(before, now):
        return now[0] / max(before[0], 1e-3) if now[0] > LEAST_SECONDS else 0


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--seconds", type=float)
    arguments.add_argument("--only", default=",".join(DIMENSIONS))
    calls = {name: call for name, call in ALL.items() if call.can_be_asked()}
    arguments.add_argument("--calls")
    arguments.add_argument("--short", action="store_true")
    given = arguments.parse_args()
    names = (given.calls or ",".join(SHORT if given.short else calls)).split(",")
    seconds = given.seconds or (0.5 if given.short else 2)
    print(f"{'':22}" + "".join(f"{name:28}" for name in names))
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        for dimension in given.only.split(","):
            row = f"{dimension:22}"
            for name in names:
                if calls[name].of_layers != (SUFFIX.get(dimension) in (".json", ".gtsp")):
                    row += f"{'-':28}"
                    continue
                text, bad = Cell(dimension, calls[name], folder).grow(seconds)
                row += f"{text:28}"
                if bad:
                    faults.append(f"{dimension} in {name}")
            print(row, flush=True)
    end_programs()
    for fault in faults:
        print("grows faster than n log n:", fault)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
