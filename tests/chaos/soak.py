#!/usr/bin/env python3
"""Load on one server for a long time: nothing may fail, and its memory stays as it is.

    tests/chaos/soak.py [--minutes=30] [--build=build/release] [--rate=20]

Jobs of 1, 10 and 400 layers at a low rate; beside them, again and again, a caller that is killed in the middle of its
jobs. Prints the server's memory every minute: all of it, what of it is allocated, and what the allocator keeps. Fails if
a job fails, or if the memory at the end is more than a tenth above that after a third of the time.
"""
import argparse
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import urllib.request


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--minutes", type=float, default=30)
    parser.add_argument("--rate", type=float, default=20, help="jobs a second")
    parser.add_argument("--build", default="build/release")
    return parser.parse_args()


def resident_mb(pid):
    with open(f"/proc/{pid}/status", encoding="utf-8") as file:
        return int(re.search(r"VmRSS:\s+(\d+)", file.read()).group(1)) / 1024


def metric(port, name):
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/metrics", timeout=10) as answer:
        return float(re.search(rf"^{name} (\S+)$", answer.read().decode(), re.MULTILINE).group(1))


def main():
    arguments = parse()
    server = subprocess.Popen([arguments.build + "/server/traverse-server", "--listen=127.0.0.1:0",
                               "--metrics_listen=127.0.0.1:0", "--log_file=/dev/null"],
                              stdout=subprocess.PIPE, text=True)
    port, metrics = (server.stdout.readline().split()[-1] for _ in range(2))
    loadgen = [arguments.build + "/client/loadgen/traverse-loadgen", f"--target=127.0.0.1:{port}"]
    seconds = arguments.minutes * 60
    samples = []
    with tempfile.TemporaryDirectory() as folder:
        figures = os.path.join(folder, "load.json")
        load = subprocess.Popen(loadgen + [f"--rate={arguments.rate}", f"--duration={seconds:.0f}s", "--arrivals=poisson",
                                           "--mix=1:70,10:25,400:5", f"--json={figures}"],
                                stdout=subprocess.DEVNULL)
        try:
            began = time.monotonic()
            while load.poll() is None:
                victim = subprocess.Popen(loadgen + ["--in_flight=2", "--mix=50", "--duration=60s"],
                                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                time.sleep(2)
                victim.send_signal(signal.SIGKILL)
                victim.wait()
                time.sleep(8)
                samples.append((time.monotonic() - began, resident_mb(server.pid)))
                if len(samples) % 6 == 1:
                    heap = [metric(metrics, f"process_heap_{part}_bytes") / 2**20 for part in ("used", "free")]
                    print(f"{samples[-1][0]:6.0f} s  {samples[-1][1]:6.1f} MB, heap {heap[0]:.1f} and {heap[1]:.1f} free", flush=True)
            with open(figures, encoding="utf-8") as file:
                document = json.load(file)
            left = metric(metrics, "traverse_jobs_in_flight"), metric(metrics, "traverse_queue_points")
        finally:
            load.kill()
            server.terminate()
            server.wait()
    settled = max(mb for at, mb in samples if at <= max(seconds / 3, samples[0][0]))
    print(f"{document['sent']} jobs, {document['ok']} ok, memory {settled:.1f} MB after a third of the time, "
          f"{samples[-1][1]:.1f} MB at the end; in flight and queued then: {left}")
    flat = samples[-1][1] <= 1.1 * settled
    return 0 if flat and document["ok"] == document["sent"] and left == (0, 0) else 1


if __name__ == "__main__":
    os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
    sys.exit(main())
