#!/usr/bin/python3
"""The Kubernetes objects, rendered: they fit the schemas, and each other."""

import pathlib
import re
import shutil
import tempfile
import unittest

import support

yaml = support.module("yaml", "python3-yaml")

KUBERNETES = support.DEPLOY / "kubernetes"
OVERLAYS = sorted(path.name for path in (KUBERNETES / "overlays").iterdir())


def render(overlay):
    return support.run("kubectl", "kustomize", KUBERNETES / "overlays" / overlay).stdout


def objects(overlay):
    return {(item["kind"], item["metadata"]["name"]): item for item in yaml.safe_load_all(render(overlay))}


def seconds(text):
    return float(re.fullmatch(r"([\d.]+)s", text)[1])


class Objects(unittest.TestCase):

    def test_grace_period_covers_the_pre_stop_wait_and_the_drain(self):
        for overlay in OVERLAYS:
            found = objects(overlay)
            pod = found["Deployment", "traverse"]["spec"]["template"]["spec"]
            flags = next(item["data"]["server.flags"] for (kind, name), item in found.items()
                         if kind == "ConfigMap" and name.startswith("traverse-flags-"))
            wait = re.search(r"--sleep=(\S+)", str(pod["containers"][0]["lifecycle"]["preStop"]))[1].rstrip("']}")
            drain = re.search(r"--drain_timeout=(\S+)", flags)[1]

            self.assertGreaterEqual(pod["terminationGracePeriodSeconds"], seconds(wait) + seconds(drain) + 5)

    def test_selectors_find_the_pods(self):
        for overlay in OVERLAYS:
            found = objects(overlay)
            labels = found["Deployment", "traverse"]["spec"]["template"]["metadata"]["labels"].items()
            for key, item in found.items():
                spec = item.get("spec", {})
                for selector in (spec.get("selector"), spec.get("podSelector")):
                    if not selector or key[0] == "ServiceMonitor":
                        continue
                    with self.subTest(overlay=overlay, kind=key):
                        self.assertLessEqual(selector.get("matchLabels", selector).items(), labels)

    def test_the_autoscaler_alone_owns_the_number_of_replicas(self):
        for overlay in OVERLAYS:
            found = objects(overlay)
            self.assertNotIn("replicas", found["Deployment", "traverse"]["spec"])
            target = found["HorizontalPodAutoscaler", "traverse"]["spec"]["scaleTargetRef"]
            self.assertIn((target["kind"], target["name"]), found)

    def test_production_scales_on_the_queue_and_is_watched(self):
        found = objects("production")
        metrics = str(found["HorizontalPodAutoscaler", "traverse"]["spec"]["metrics"])
        self.assertIn("cpu", metrics)
        self.assertIn("traverse_queue_layers", metrics)
        monitor = found["ServiceMonitor", "traverse"]["spec"]
        ports = [port["name"] for port in found["Service", "traverse-headless"]["spec"]["ports"]]
        self.assertIn(monitor["endpoints"][0]["port"], ports)
        self.assertEqual("traverse", found["Service", "traverse-headless"]["metadata"]["labels"][monitor["jobLabel"]])
        self.assertIn(("ConfigMap", "traverse-dashboard"), found)

    def test_the_operators_rules_are_those_of_the_rule_files(self):
        rule = objects("production")["PrometheusRule", "traverse"]["spec"]["groups"]
        files = [support.DEPLOY / "monitoring/rules" / name for name in ("recording.yml", "alerts.yml")]
        groups = [group for file in files for group in yaml.safe_load(file.read_text())["groups"]]

        self.assertEqual(groups, rule, "run deploy/monitoring/prometheus-rule.sh")

    def test_the_image_is_of_this_version(self):
        version = re.search(r"project\(traverse VERSION (\S+)", (support.SOURCE / "CMakeLists.txt").read_text())[1]
        for overlay in OVERLAYS:
            container = objects(overlay)["Deployment", "traverse"]["spec"]["template"]["spec"]["containers"][0]
            self.assertEqual(f"docker.io/library/traverse-server:{version}", container["image"])


class Schemas(unittest.TestCase):

    def test_every_document_fits_its_schema_and_a_wrong_one_does_not(self):
        if not shutil.which("npm"):
            self.skipTest("no npm")
        with tempfile.TemporaryDirectory() as scratch:
            work = pathlib.Path(scratch)
            for path in (support.SOURCE / "tests/deploy/kubernetes").iterdir():
                shutil.copy(path, work)
            support.install_node_packages(work)

            for overlay in OVERLAYS:
                support.run("node", work / "validate.mjs", input=render(overlay), cwd=work)
            for wrong in (("minReplicas", "minReplica"), ("containerPort", "containrPort"), ("cpu: ", "cpu: 1, x: ")):
                text = render("production").replace(*wrong)
                done = support.run("node", work / "validate.mjs", ok=False, input=text, cwd=work)
                self.assertNotEqual(0, done.returncode, wrong)


if __name__ == "__main__":
    support.main("kubectl")
