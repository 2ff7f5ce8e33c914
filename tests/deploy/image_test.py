#!/usr/bin/python3
"""The container image: small, without rights, healthy when it serves, gone at once when it cannot."""

import json
import re
import subprocess
import time
import unittest

import support
from support import containers

yaml = support.module("yaml", "python3-yaml")

VERSION = re.search(r"project\(traverse VERSION (\S+)", (support.SOURCE / "CMakeLists.txt").read_text())[1]
IMAGE = f"docker.io/library/traverse-server:{VERSION}"
LOCKED = ["--read-only", "--cap-drop=all", "--security-opt", "no-new-privileges", "--memory", "256m", "--pids-limit", "64"]


class Image(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.store = containers.Store()
        begin = time.monotonic()
        cls.store.build_server(IMAGE)
        cls.about = json.loads(cls.store.podman("inspect", IMAGE).stdout)[0]
        print(f"built in {time.monotonic() - begin:.0f} s, {cls.about['Size'] / 1e6:.1f} MB")

    def run_server(self, *flags, name="traverse-test"):
        """A container in the foreground, without a network of its own, and its process."""
        self.store.podman("rm", "-f", name, ok=False)
        self.addCleanup(self.store.podman, "rm", "-f", name, ok=False)
        words = ["podman", *self.store.options, "run", "--name", name, "--network", "host", "--log-driver", "none",
                 "--no-healthcheck", *LOCKED, IMAGE, *flags]
        return support.Process(*words, env=self.store.environment)

    def test_is_small_labelled_and_without_rights(self):
        config = self.about["Config"]
        self.assertLess(self.about["Size"], 50e6)  # a third of it the solver that exact uses
        self.assertEqual("65532:65532", config["User"])
        self.assertEqual(VERSION, config["Labels"]["org.opencontainers.image.version"])
        self.assertEqual("traverse-server", config["Labels"]["org.opencontainers.image.title"])
        self.assertIn("/usr/bin/traverse-health-probe", self.about["Healthcheck"]["Test"])

    def test_lists_the_packages_it_is_made_of(self):
        mount = self.store.podman("image", "mount", IMAGE).stdout.strip()
        self.addCleanup(self.store.podman, "image", "umount", IMAGE)
        with open(f"{mount}/usr/share/doc/traverse-server/packages.txt", encoding="utf-8") as file:
            packages = file.read().splitlines()
        self.assertEqual(sorted(packages), packages)
        self.assertTrue(any(line.startswith("libgrpc++1.51 ") for line in packages))
        self.assertFalse(any(f"{mount}/bin/{shell}" for shell in ("sh", "bash") if self.there(f"{mount}/bin/{shell}")))

    @staticmethod
    def there(path):
        return subprocess.run(["test", "-e", path], check=False).returncode == 0

    def test_runs_locked_in_serves_and_drains(self):
        port, metrics = support.free_port(), support.free_port()
        with self.run_server(f"--listen=127.0.0.1:{port}", f"--metrics_listen=127.0.0.1:{metrics}"):
            support.wait_for(lambda: support.http(f"http://127.0.0.1:{metrics}/readyz")[0] == 200, "the container is ready")
            probe = ("exec", "traverse-test", "/usr/bin/traverse-health-probe")
            self.assertEqual(0, self.store.podman(*probe, f"--address=127.0.0.1:{port}").returncode)
            # A probe of a port where nobody is does not lie.
            self.assertNotEqual(0, self.store.podman(*probe, "--address=127.0.0.1:1", ok=False).returncode)
            self.store.podman("stop", "-t", "20", "traverse-test")
            code = self.store.podman("inspect", "traverse-test", "--format", "{{.State.ExitCode}}").stdout.strip()
        self.assertEqual("0", code)

    def test_says_in_one_line_why_it_cannot_start(self):
        with support.Server() as other:
            for flags, words in ((["--listen=127.0.0.1:x"], "127.0.0.1:x"),
                                 (["--threads=many"], "threads"),
                                 (["--nonsense"], "nonsense"),
                                 ([f"--listen={other.address}"], other.address),
                                 (["--flagfile=/etc/traverse/none.flags"], "/etc/traverse/none.flags")):
                with self.subTest(flags), self.run_server(*flags) as process:
                    begin = time.monotonic()
                    code = process.popen.wait(30)
                    lines = [line for line in process.output().splitlines() if "level=" not in line]
                    self.assertNotEqual(0, code)
                    self.assertEqual(1, len(lines), lines)
                    self.assertIn(words, lines[0])
                    self.assertLess(time.monotonic() - begin, 20)

    def test_the_kubernetes_deployment_starts(self):
        rendered = support.run("kubectl", "kustomize", support.DEPLOY / "kubernetes/overlays/trial").stdout
        documents = {item["kind"]: item for item in yaml.safe_load_all(rendered)}
        port, metrics = support.free_port(), support.free_port()
        flags = documents["ConfigMap"]["data"]["server.flags"]
        documents["ConfigMap"]["data"]["server.flags"] = flags.replace("0.0.0.0:50051", f"127.0.0.1:{port}").replace(
            "0.0.0.0:9464", f"127.0.0.1:{metrics}")
        deployment = documents["Deployment"]
        deployment["spec"]["replicas"] = 1
        pod = deployment["spec"]["template"]["spec"]
        pod["hostNetwork"] = True
        # What one machine without a cluster does not know.
        for key in ("topologySpreadConstraints", "serviceAccountName"):
            pod.pop(key)
        container = pod["containers"][0]
        for key in ("startupProbe", "readinessProbe", "livenessProbe", "lifecycle", "ports"):
            container.pop(key)
        # Podman fills in no variables.
        container.pop("env")
        container["args"] = [word.replace("$(CPU_LIMIT)", "1") for word in container["args"]]
        path = self.store.folder / "deployment.yaml"
        path.write_text(yaml.safe_dump_all([documents["ConfigMap"], deployment]))
        done = self.store.podman("play", "kube", path, ok=False)
        self.addCleanup(self.store.podman, "play", "kube", "--down", path, ok=False)
        self.assertEqual(0, done.returncode, done.stderr)
        support.wait_for(lambda: support.http(f"http://127.0.0.1:{metrics}/readyz")[0] == 200, "the pod is ready")
        self.assertIn("traverse_workers 1", support.http(f"http://127.0.0.1:{metrics}/metrics")[1])


if __name__ == "__main__":
    containers.wanted()
    support.main("podman", "buildah", "kubectl")
