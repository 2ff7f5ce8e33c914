"""A server and its callers on two hosts (network namespaces) whose link is cut, or loses packets.

Needs root and the programs ip and iptables; exits with 77 (skipped) without. The environment names the binaries:
TRAVERSE, TRAVERSE_SERVER, TRAVERSE_LOADGEN.
"""
import json
import os
import shutil
import subprocess
import sys
import time
import unittest

NAMES = [f"trv{os.getpid()}{side}" for side in "ab"]  # of the caller's and the server's host
SERVER = "10.77.0.2"


def run(*command, check=True):
    return subprocess.run(command, check=check, capture_output=True, text=True, timeout=60)


def possible():
    if os.geteuid() != 0 or not shutil.which("ip") or not shutil.which("iptables"):
        return False
    made = run("ip", "netns", "add", NAMES[0] + "x", check=False).returncode == 0
    if made:
        run("ip", "netns", "del", NAMES[0] + "x")
    return made


class Network(unittest.TestCase):
    def setUp(self):
        caller, server = NAMES
        for name in NAMES:
            run("ip", "netns", "add", name)
            self.addCleanup(run, "ip", "netns", "del", name, check=False)
        run("ip", "link", "add", "va", "netns", caller, "type", "veth", "peer", "name", "vb", "netns", server)
        for name, link, address in [(caller, "va", "10.77.0.1"), (server, "vb", SERVER)]:
            run("ip", "-n", name, "addr", "add", address + "/24", "dev", link)
            run("ip", "-n", name, "link", "set", link, "up")
            run("ip", "-n", name, "link", "set", "lo", "up")
        self.server = subprocess.Popen(
            ["ip", "netns", "exec", server, os.environ["TRAVERSE_SERVER"], f"--listen={SERVER}:0", "--insecure",
             f"--metrics_listen={SERVER}:0", "--log_file=/dev/null", "--keepalive_time=1s", "--keepalive_timeout=1s",
             "--max_wait=60s"],
            stdout=subprocess.PIPE, text=True)
        self.addCleanup(self.server.stdout.close)
        self.addCleanup(self.server.wait)
        self.addCleanup(self.server.kill)
        self.port = self.server.stdout.readline().split()[-1]
        self.metrics = self.server.stdout.readline().split()[-1]

    def load(self, *flags):
        return subprocess.Popen(
            ["ip", "netns", "exec", NAMES[0], os.environ["TRAVERSE_LOADGEN"], f"--target={SERVER}:{self.port}", "--json=-",
             "--warm_up=100ms", "--strategy=ni2opt", *flags], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def finish(self, load):
        out, err = load.communicate(timeout=90)
        self.assertEqual((load.returncode, err), (0, ""))
        return json.loads(out)

    def jobs_in_flight(self):
        script = f"import urllib.request as u; print(u.urlopen('http://{SERVER}:{self.metrics}/metrics').read().decode())"
        text = run("ip", "netns", "exec", NAMES[1], sys.executable, "-c", script).stdout
        return float([line for line in text.splitlines() if line.startswith("traverse_jobs_in_flight ")][0].split()[1])

    def test_a_cut_costs_the_calls_of_its_time_alone(self):
        load = self.load("--rate=20", "--duration=9s", "--deadline=3s")
        time.sleep(2.5)
        run("ip", "-n", NAMES[0], "link", "set", "va", "down")
        time.sleep(1.5)
        run("ip", "-n", NAMES[0], "link", "set", "va", "up")
        figures = self.finish(load)
        print({code: figures["codes"][code]["jobs"] for code in figures["codes"]})
        self.assertEqual(figures["sent"], 180)
        self.assertLessEqual(set(figures["codes"]), {"OK", "DEADLINE_EXCEEDED", "UNAVAILABLE"})
        self.assertGreaterEqual(figures["ok"], 80)
        self.assertEqual(self.jobs_in_flight(), 0)

    def test_lost_packets_cost_time_and_no_job(self):
        for name in NAMES:
            run("ip", "netns", "exec", name, "iptables", "-A", "INPUT", "-p", "tcp", "-m", "statistic", "--mode", "random",
                "--probability", "0.05", "-j", "DROP")
        figures = self.finish(self.load("--rate=20", "--duration=5s", "--mix=1:8,20:2"))
        print({code: figures["codes"][code]["jobs"] for code in figures["codes"]}, figures["codes"]["OK"]["latency_ms"])
        self.assertEqual(figures["ok"], figures["sent"])

    def test_callers_behind_a_cut_lose_their_places(self):
        load = self.load("--in_flight=4", "--mix=3000", "--duration=60s")
        end = time.monotonic() + 20
        while self.jobs_in_flight() < 2:
            self.assertLess(time.monotonic(), end)
            time.sleep(0.1)
        run("ip", "-n", NAMES[0], "link", "set", "va", "down")
        cut = time.monotonic()
        while self.jobs_in_flight() > 0:
            self.assertLess(time.monotonic() - cut, 15)
            time.sleep(0.1)
        print(f"places free {time.monotonic() - cut:.1f} s after the cut")
        load.kill()
        load.communicate()


if __name__ == "__main__":
    if not possible():
        print("needs root, ip and iptables")
        sys.exit(77)
    unittest.main()
