#!/usr/bin/python3
"""deploy/compose.yaml as it is, but for the ports: three servers, the balancer and Prometheus come up and work.

Grafana is left out: what it would be given is checked here and by the other tests. Where the registry cannot be
reached, HAProxy and Prometheus are Debian's, under the names of the images.
"""

import json
import pathlib
import shutil
import tempfile
import unittest

import support
from support import certificates, containers
import image_test

yaml = support.module("yaml", "python3-yaml")

COMPOSE = support.DEPLOY / "compose.yaml"


class Compose(unittest.TestCase):

    def setUp(self):
        self.store = containers.Store()
        if not self.store.has(image_test.IMAGE):  # image_test builds it anew
            self.store.build_server(image_test.IMAGE)
        self.store.provide("docker.io/library/haproxy:2.6", "haproxy",
                           ["/usr/sbin/haproxy", "-W", "-db", "-f", "/usr/local/etc/haproxy/haproxy.cfg"])
        self.store.provide("docker.io/prom/prometheus:v2.42.0", "prometheus",
                           ["/usr/bin/prometheus", "--config.file=/etc/prometheus/prometheus.yml",
                            "--storage.tsdb.path=/prometheus"])
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        # podman-compose calls one program.
        self.podman = self.folder / "podman"
        options = " ".join(map(str, self.store.options))
        self.podman.write_text(f'#!/bin/sh\nexec podman {options} "$@"\n')
        self.podman.chmod(0o755)

    def changed_file(self):
        """The compose file with free ports, absolute paths and no build: the image is there."""
        self.ports = {port: support.free_port() for port in (50051, 8405, 9090)}
        text = COMPOSE.read_text()
        for port, free in self.ports.items():
            text = text.replace(f"127.0.0.1:{port}:{port}", f"127.0.0.1:{free}:{port}")
        document = yaml.safe_load(text.replace('"./', f'"{support.DEPLOY}/').replace("- ./", f"- {support.DEPLOY}/"))
        document["services"].pop("grafana")
        for service in document["services"].values():
            service.pop("build", None)
        path = self.folder / "compose.yaml"
        path.write_text(yaml.safe_dump(document))
        return path

    def test_comes_up_balances_and_is_watched(self):
        self.up_with(self.changed_file())
        prometheus = f"http://127.0.0.1:{self.ports[9090]}/api/v1/query?query="

        support.wait_for(lambda: self.probe() == 0, "the balancer passes health questions on", 60)
        support.wait_for(lambda: self.up(prometheus) == 4, "Prometheus scrapes three servers and the balancer", 90)
        rules = json.loads(support.http(f"http://127.0.0.1:{self.ports[9090]}/api/v1/rules")[1])["data"]["groups"]
        self.assertEqual(5, len(rules))

    def test_comes_up_with_tls_for_those_with_a_certificate(self):
        files = certificates.Certificates(self.folder)
        shutil.copy(files.path("ca.crt"), self.folder / "clients.pem")
        port = support.free_port()
        self.up_with(self.changed_file(), support.DEPLOY / "compose.tls.yaml", TRAVERSE_CERTIFICATES=str(self.folder),
                     TRAVERSE_ADDRESS="127.0.0.1", TRAVERSE_PORT=str(port))
        known = [f"--tls_ca={files.path('ca.crt')}", f"--tls_cert={files.path('farm.crt')}", f"--tls_key={files.path('farm.key')}",
                 "--tls_server_name=traverse"]

        support.wait_for(lambda: self.probe(*known, port=port) == 0, "the balancer answers over TLS", 60)
        self.assertNotEqual(0, self.probe(known[0], known[3], port=port))
        self.assertNotEqual(0, self.probe(port=port))

    def up_with(self, *paths, **variables):
        """Brings the services up, and down with the test."""
        compose = ["podman-compose", "--podman-path", self.podman, *(word for path in paths for word in ("-f", path))]
        environment = {**self.store.environment, **variables}
        self.addCleanup(support.run, *compose, "down", "-v", "-t", "5", ok=False, env=environment)
        support.run(*compose, "up", "-d", env=environment)

    def probe(self, *flags, port=None):
        address = f"--address=127.0.0.1:{port or self.ports[50051]}"
        return support.run(support.binary("TRAVERSE_PROBE"), address, *flags, ok=False).returncode

    @staticmethod
    def up(prometheus):
        status, text = support.http(prometheus + "sum(up)")
        if status != 200:
            return 0
        result = json.loads(text)["data"]["result"]
        return int(result[0]["value"][1]) if result else 0


class Files(unittest.TestCase):

    def test_every_file_that_compose_mounts_is_there(self):
        services = yaml.safe_load(COMPOSE.read_text())["services"]
        for service in services.values():
            for volume in service.get("volumes", []):
                source = volume.split(":")[0]
                if source.startswith("."):
                    self.assertTrue((support.DEPLOY / source).exists(), source)

    def test_grafana_is_given_the_dashboard_and_its_source(self):
        services = yaml.safe_load(COMPOSE.read_text())["services"]
        mounts = dict(volume.split(":")[:2] for volume in services["grafana"]["volumes"])
        provider = yaml.safe_load((support.DEPLOY / "compose/grafana/dashboards/traverse.yml").read_text())["providers"][0]
        home = services["grafana"]["environment"]["GF_DASHBOARDS_DEFAULT_HOME_DASHBOARD_PATH"]
        self.assertEqual(mounts["./monitoring/dashboard/traverse.json"], home)
        self.assertTrue(home.startswith(provider["options"]["path"]))
        source = yaml.safe_load((support.DEPLOY / "compose/grafana/datasources/prometheus.yml").read_text())["datasources"][0]
        self.assertIn(source["url"].split("//")[1].split(":")[0], services)

    def test_servers_get_longer_to_stop_than_they_drain(self):
        for name, service in yaml.safe_load(COMPOSE.read_text())["services"].items():
            if name.startswith("server-"):
                drain = next(word for word in service["command"] if "drain" in word).split("=")[1]
                self.assertGreaterEqual(int(service["stop_grace_period"].rstrip("s")), int(drain.rstrip("s")) + 10)


if __name__ == "__main__":
    containers.wanted()
    support.main("podman", "buildah", "podman-compose")
