"""Callers of all methods of a gateway and of a server who leave at any moment: nothing may be held for them.

    leave.py [--seconds=N, 20] [--seed=N, any] [--only=gateway|server]

A dozen callers from five addresses call, cut, reset and leave as attacks/leavers.py says, by dice of the printed seed; the
moments are the machine's. Some keep their connections open and read no more. Then all work must end while those are open,
and what counts connections must come to 0 once they are closed. Last, SIGTERM must end the program while callers come and
go, and its log must be its own. Prints a line for each program, and each fault; exits with 1 if there is one.

The environment names the binaries: TRAVERSE_GATEWAY and TRAVERSE_SERVER. One that it does not name is skipped.
"""
import argparse
import collections
import os
import random
import re
import subprocess
import sys
import threading
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.path.join(os.path.dirname(HERE), "client", "gateway"))
from attacks.attacked_server import DRAIN_SECONDS, Gateway, Server
from attacks.leavers import GatewayLeavers, ServerLeavers

MAX_MEMORY = 1_000_000_000
CALLERS, ADDRESSES, MOST_KEPT = 12, 5, 8  # connections that a caller keeps
# What may still go on is a file of three seconds, then two of silence, then a second in which its result is kept.
SETTLE_SECONDS = 15
CLOSE_SECONDS = 15
END_SECONDS = DRAIN_SECONDS + 10  # HTTP answers that nobody reads have five seconds after all work has ended.
GATEWAY_FLAGS = ["--threads=1", "--idle_timeout=2s", "--header_timeout=2s", "--max_time=3s"]
SERVER_FLAGS = ["--threads=2", "--idle_timeout=2s"]


class Crowd:
    """Callers who come and go, each in a thread of its own, until stop()."""

    def __init__(self, leavers, seed):
        self.leavers, self.stopping, self.kept, self.visits = leavers, threading.Event(), [[] for _ in range(CALLERS)], 0
        self.threads = [threading.Thread(target=self.come_and_go, args=(number, random.Random(f"{seed} {number}")))
                        for number in range(CALLERS)]
        for thread in self.threads:
            thread.start()

    def come_and_go(self, number, dice):
        kept = self.kept[number]
        while not self.stopping.is_set():
            try:
                connection = self.leavers.visit(dice, f"127.0.1.{1 + number % ADDRESSES}")
            except OSError:
                time.sleep(0.02)
                continue
            self.visits += 1
            if connection is not None:
                kept.append(connection)
            if len(kept) > MOST_KEPT:
                kept.pop(dice.randrange(len(kept))).close()

    def stop(self):
        self.stopping.set()
        for thread in self.threads:
            thread.join()

    def close(self):
        for kept in self.kept:
            for connection in kept:
                connection.close()


def answers(program):
    """How many calls and requests ended with each code."""
    codes = collections.Counter()
    for line in program.get("/metrics").splitlines():
        found = re.match(r'traverse_(?:gateway_requests|rpcs)_total\{.*?code="(\w+)".*\} (\d+)$', line)
        if found:
            codes[found[1]] += int(found[2])
    return codes


def run(name, program, leavers, seconds, seed):
    """The faults found."""
    crowd = Crowd(leavers, seed)
    time.sleep(seconds)
    crowd.stop()
    if program.process.poll() is not None:
        return [f"the process ended with {program.process.returncode}"]
    open_at_the_end = sum(len(kept) for kept in crowd.kept)
    begin = time.monotonic()
    faults = [f"{fault}, {SETTLE_SECONDS} s later and with unread connections open"
              for fault in program.still_held(program.work, SETTLE_SECONDS)]
    settled = time.monotonic() - begin
    crowd.close()
    begin = time.monotonic()
    faults += [f"{fault}, {CLOSE_SECONDS} s after the last connection" for fault in program.still_held(None, CLOSE_SECONDS)]
    closed = time.monotonic() - begin
    codes = answers(program)
    if not codes["OK"]:
        faults.append("no call was answered")

    last = Crowd(leavers, f"{seed} at the end")
    time.sleep(1)
    try:
        code, took = program.end()
    finally:
        last.stop()
        last.close()
    if code != 0:
        faults.append(f"exit code {code}")
    if took > END_SECONDS:
        faults.append(f"SIGTERM took {took:.1f} s")
    faults += program.log_faults()
    print(f"{name}: {crowd.visits} connections, {open_at_the_end} kept open, work ended in {settled:.1f} s, "
          f"connections in {closed:.1f} s, the process in {took:.1f} s; {dict(sorted(codes.items()))}",
          flush=True)
    return faults


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--seconds", type=float, default=20)
    arguments.add_argument("--seed", type=int, default=random.randrange(1_000_000))
    arguments.add_argument("--only", choices=["gateway", "server"])
    given = arguments.parse_args()
    print(f"--seed={given.seed}", flush=True)
    programs = {"gateway": (Gateway, GATEWAY_FLAGS, GatewayLeavers), "server": (Server, SERVER_FLAGS, ServerLeavers)}
    found = False
    for name, (start, flags, leavers_of) in programs.items():
        if given.only not in (None, name) or "TRAVERSE_" + name.upper() not in os.environ:
            continue
        program = start(MAX_MEMORY, flags)
        try:
            faults = run(name, program, leavers_of(program, random.Random(given.seed)), given.seconds, given.seed)
        except (OSError, subprocess.TimeoutExpired) as error:
            faults = [str(error)]
        finally:
            program.process.kill()
        for fault in faults:
            print(f"{name}: FAULT: {fault}", flush=True)
            found = True
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
