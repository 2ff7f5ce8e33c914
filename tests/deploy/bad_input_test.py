#!/usr/bin/python3
"""What an operator gets wrong: the server ends at once and says why in one line; its probes never lie.

The server is the entry point of the container, so what it does here it does there; image_test starts containers.
"""

import os
import pathlib
import re
import shutil
import socket
import subprocess
import tempfile
import threading
import unittest
import unittest.mock

import support
from support import certificates, python_client

yaml = support.module("yaml", "python3-yaml")

FREE = ("--listen=127.0.0.1:0", "--metrics_listen=127.0.0.1:0")
NOBODY = 65532


class Case(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.folder.chmod(0o755)

    def assert_ends_at_once(self, flags, *words, user=None):
        """The server with `flags` does not start; its one line has all of `words`."""
        done = subprocess.run([support.binary("TRAVERSE_SERVER"), *map(str, flags)], capture_output=True, text=True,
                              check=False, timeout=20, user=user, extra_groups=[] if user else None)
        lines = done.stderr.splitlines()
        self.assertNotEqual(0, done.returncode)
        self.assertEqual("", done.stdout)
        self.assertEqual(1, len(lines), lines)
        for word in words:
            self.assertIn(str(word), lines[0])


class Faults(Case):

    def test_flags_that_are_none(self):
        for flag, word in (("--nonsense", "nonsense"), ("--threads=many", "threads"), ("--threads=", "threads"),
                           ("--drain_timeout=60", "drain_timeout"), ("--max_jobs=0", "max_jobs"), ("word", "word"),
                           ("--listen=127.0.0.1:x", "127.0.0.1:x"), ("--listen=nowhere.invalid:1", "nowhere.invalid:1"),
                           ("--flagfile=/nowhere/server.flags", "/nowhere/server.flags"),
                           ("--config=/nowhere/server.conf", "/nowhere/server.conf")):
            with self.subTest(flag):
                self.assert_ends_at_once([*FREE, flag], word)

    def test_plaintext_for_other_machines_is_asked_for(self):
        self.assert_ends_at_once(["--listen=0.0.0.0:0", "--metrics_listen="], "--insecure")

    def test_a_port_in_use(self):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            address = f"127.0.0.1:{taken.getsockname()[1]}"
            self.assert_ends_at_once([f"--listen={address}", "--metrics_listen="], address)
            self.assert_ends_at_once(["--listen=127.0.0.1:0", f"--metrics_listen={address}"], address, "metrics")

    def test_variables_of_the_compose_file(self):
        command = yaml.safe_load((support.DEPLOY / "compose.yaml").read_text())["services"]["server-1"]["command"]
        self.assertIn("--threads=${TRAVERSE_THREADS:-2}", command)
        for value in ("many", "-1", "1.5"):
            with self.subTest(value):
                flags = [re.sub(r"\$\{TRAVERSE_THREADS.*\}", value, flag) for flag in command]
                self.assert_ends_at_once(flags, "threads")


class Secrets(Case):

    def setUp(self):
        super().setUp()
        self.files = certificates.Certificates(self.folder)
        self.junk = self.folder / "junk"
        self.junk.write_text("junk\n")

    def path(self, name):
        return self.files.path(name)

    def tls(self, certificate="tls.crt", key="tls.key"):
        return [*FREE, f"--tls_certificate={self.folder / certificate}", f"--tls_key={self.folder / key}"]

    def test_files_that_are_missing_or_junk(self):
        for flags, word in ((self.tls(certificate="none"), "none"), (self.tls(key="none"), "none"),
                            (self.tls(certificate="junk"), "junk"), (self.tls(key="junk"), "junk"),
                            (self.tls(key="farm.key"), "farm.key"), (self.tls()[:3], "key"),
                            ([*self.tls(), f"--tls_client_ca={self.folder}/none"], "none"),
                            ([*self.tls(), f"--tls_client_ca={self.junk}"], "junk"),
                            ([*FREE, f"--token_file={self.folder}/none"], "none"), ([*FREE, f"--token_file={self.junk}"], "junk")):
            with self.subTest(flags[2:]):
                self.assert_ends_at_once(flags, word)

    def test_files_that_the_servers_user_may_not_read(self):
        if os.geteuid() != 0:
            self.skipTest("not root: cannot become another user")
        program = shutil.copy(support.binary("TRAVERSE_SERVER"), self.folder)
        for name, flags in (("tls.key", self.tls()), ("tokens", [*FREE, f"--token_file={self.path('tokens')}"])):
            self.path(name).chmod(0o600)
            with self.subTest(name), unittest.mock.patch.dict(os.environ, TRAVERSE_SERVER=program):
                self.assert_ends_at_once(flags, self.path(name), user=NOBODY)

    def test_a_balancer_without_its_certificate_ends(self):
        if not shutil.which("haproxy"):
            self.skipTest("no haproxy")
        bind = yaml.safe_load((support.DEPLOY / "compose.tls.yaml").read_text())["services"]["balancer"]["environment"]["TRAVERSE_BIND"]
        numbers = [f"TRAVERSE_{name}_{index}" for name in ("SERVER", "METRICS") for index in (1, 2, 3)]
        environment = {**os.environ, **dict.fromkeys(numbers, "1"),
                       **{name: f"127.0.0.1:{support.free_port()}" for name in ("TRAVERSE_LISTEN", "TRAVERSE_STATS")},
                       "TRAVERSE_BIND": bind.replace("/etc/traverse/tls/server.pem", f"{self.folder}/none")}
        done = support.run("haproxy", "-db", "-f", support.DEPLOY / "compose/haproxy.cfg", ok=False, env=environment, timeout=20)
        self.assertNotEqual(0, done.returncode)
        self.assertIn(f"{self.folder}/none", done.stderr)


class EncryptedPod(Case):
    """The flags and probes of the encrypted Deployment, with its secrets in a folder of the test."""

    def setUp(self):
        super().setUp()
        if not shutil.which("kubectl"):
            self.skipTest("no kubectl")
        rendered = support.run("kubectl", "kustomize", support.DEPLOY / "kubernetes/overlays/encrypted").stdout
        items = {item["kind"]: item for item in yaml.safe_load_all(rendered) if "traverse-dashboard" not in item["metadata"]["name"]}
        self.container = items["Deployment"]["spec"]["template"]["spec"]["containers"][0]
        for name in ("flags", "tls", "tokens"):
            (self.folder / name).mkdir()
        (self.folder / "flags/server.flags").write_text(items["ConfigMap"]["data"]["server.flags"])
        self.port, self.metrics = support.free_port(), support.free_port()

    def words(self, words):
        """Words of the manifest as they are here: other folders and ports, one core."""
        return [word.replace("/etc/traverse", str(self.folder)).replace("$(CPU_LIMIT)", "1").replace(":50051", f":{self.port}")
                for word in words]

    def flags(self):
        return [*self.words(self.container["args"]), f"--listen=127.0.0.1:{self.port}", f"--metrics_listen=127.0.0.1:{self.metrics}"]

    def put_secrets(self):
        files = certificates.Certificates(self.folder / "tls")
        shutil.move(files.path("tokens"), self.folder / "tokens/tokens")
        return files

    def probe(self, name):
        command = self.words(self.container[name]["exec"]["command"])
        return support.run(support.binary("TRAVERSE_PROBE"), *command[1:], ok=False).returncode

    def test_without_its_secrets_it_does_not_start(self):
        files = self.put_secrets()
        for path in (self.folder / "tokens/tokens", files.path("tls.crt"), files.path("tls.key")):
            with self.subTest(path):
                away = path.rename(self.folder / "away")
                self.assert_ends_at_once(self.flags(), path)
                away.rename(path)

    def test_it_speaks_tls_alone_and_its_probes_see_it(self):
        self.put_secrets()
        self.assertNotEqual(0, self.probe("readinessProbe"))
        with support.Process(support.binary("TRAVERSE_SERVER"), *self.flags()) as server:
            support.wait_for(lambda: self.probe("startupProbe") == 0, "started")
            self.assertEqual(0, self.probe("readinessProbe"))
            self.assertEqual(200, support.http(f"http://127.0.0.1:{self.metrics}{self.container['livenessProbe']['httpGet']['path']}")[0])
            plaintext = support.run(support.binary("TRAVERSE_PROBE"), f"--address=127.0.0.1:{self.port}", ok=False)
            self.assertNotEqual(0, plaintext.returncode)
            self.assertEqual(0, server.terminate())


class Draining(Case):

    @classmethod
    def setUpClass(cls):
        python_client.load()

    def test_a_draining_server_is_alive_but_not_ready(self):
        import grpc
        from traverse_client.wire import route_optimizer_service_pb2 as api, route_optimizer_service_pb2_grpc as service
        hold = threading.Event()

        def requests():
            yield api.OptimizeRequest(options={"job_id": "held"})
            hold.wait(30)

        with support.Server("--drain_timeout=30s") as server, grpc.insecure_channel(server.address) as channel:
            answers = service.RouteOptimizerServiceStub(channel).Optimize(requests())
            support.wait_for(lambda: server.sum_of("traverse_jobs_in_flight") == 1, "a job is under way")
            self.assertEqual((True, 200, 0), self.seen(server))

            server.popen.terminate()

            support.wait_for(lambda: support.http(f"{server.metrics}/readyz")[0] == 503, "not ready", 5)
            self.assertEqual((True, 503, 1), self.seen(server))
            hold.set()
            self.assertTrue(list(answers))  # the job under way was finished
            self.assertEqual(0, server.popen.wait(20))
        self.assertEqual((False, 0, 1), self.seen(server))

    @staticmethod
    def seen(server):
        """Alive, ready, and what the health probe says."""
        return (support.http(f"{server.metrics}/healthz")[0] == 200, support.http(f"{server.metrics}/readyz")[0],
                support.run(support.binary("TRAVERSE_PROBE"), f"--address={server.address}", ok=False).returncode)


if __name__ == "__main__":
    support.main()
