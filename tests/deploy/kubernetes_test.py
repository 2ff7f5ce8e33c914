#!/usr/bin/python3
"""The Kubernetes objects, rendered: they fit the schemas, and each other."""

import functools
import pathlib
import re
import shutil
import tempfile
import unittest

import support

yaml = support.module("yaml", "python3-yaml")

KUBERNETES = support.DEPLOY / "kubernetes"
OVERLAYS = sorted(path.name for path in (KUBERNETES / "overlays").iterdir())


@functools.cache
def render(overlay):
    return support.run("kubectl", "kustomize", KUBERNETES / "overlays" / overlay).stdout


@functools.cache
def render_with_gateway(overlay):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        shutil.copytree(support.DEPLOY / "monitoring", root / "monitoring", ignore=shutil.ignore_patterns("node_modules"))
        shutil.copytree(KUBERNETES, root / "kubernetes")
        path = root / "kubernetes/overlays" / overlay / "kustomization.yaml"
        given = yaml.safe_load(path.read_text())
        given["components"] = [*given.get("components", []), "../../components/gateway"]
        path.write_text(yaml.safe_dump(given))
        return support.run("kubectl", "kustomize", path.parent).stdout


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

    def test_gateways_join_by_their_component(self):
        text = render_with_gateway("trial")
        found = {(item["kind"], item["metadata"]["name"]): item for item in yaml.safe_load_all(text)}
        pod = found["Deployment", "traverse-gateway"]["spec"]["template"]
        labels = pod["metadata"]["labels"].items()
        for kind in ("Service", "PodDisruptionBudget", "NetworkPolicy", "Deployment"):
            spec = found[kind, "traverse-gateway"]["spec"]
            selector = spec.get("selector") or spec["podSelector"]
            self.assertLessEqual(selector.get("matchLabels", selector).items(), labels)
        # The servers let it in, and its flags name a service that there is.
        allowed = found["NetworkPolicy", "traverse"]["spec"]["ingress"][0]["from"][0]["podSelector"]["matchLabels"]
        self.assertLessEqual(allowed.items(), labels)
        arguments = " ".join(pod["spec"]["containers"][0]["args"])
        self.assertIn(("Service", re.search(r"--server=([\w-]+):", arguments)[1]), found)
        drain = seconds(re.search(r"--drain_timeout=(\S+)", arguments)[1])
        self.assertGreaterEqual(pod["spec"]["terminationGracePeriodSeconds"], drain + 10)
        self.assertIn("traverse_gateway_requests_in_flight",
                      str(found["HorizontalPodAutoscaler", "traverse-gateway"]["spec"]["metrics"]))

    def test_gateways_are_watched_and_scaled_by_metrics_that_there_are(self):
        text = render_with_gateway("production")
        found = {(item["kind"], item["metadata"]["name"]): item for item in yaml.safe_load_all(text)}
        monitor = found["ServiceMonitor", "traverse-gateway"]["spec"]
        service = found["Service", "traverse-gateway"]
        self.assertLessEqual(monitor["selector"]["matchLabels"].items(), service["metadata"]["labels"].items())
        self.assertIn(monitor["endpoints"][0]["port"], [port["name"] for port in service["spec"]["ports"]])
        job = service["metadata"]["labels"][monitor["jobLabel"]]
        self.assertIn(f'up{{job="{job}"}}', (support.DEPLOY / "monitoring/rules/alerts.yml").read_text())
        rules = yaml.safe_load((KUBERNETES / "components/queue-metric/prometheus-adapter-rules.yaml").read_text())
        offered = [rule["seriesQuery"].partition("{")[0] for rule in rules["rules"]["custom"]]
        for name in ("traverse", "traverse-gateway"):
            for metric in found["HorizontalPodAutoscaler", name]["spec"]["metrics"]:
                if metric["type"] == "Pods":
                    self.assertIn(metric["pods"]["metric"]["name"], offered)

    def test_callers_of_a_gateway_cannot_keep_its_probes_out(self):
        text = render_with_gateway("trial")
        found = {(item["kind"], item["metadata"]["name"]): item for item in yaml.safe_load_all(text)}
        container = found["Deployment", "traverse-gateway"]["spec"]["template"]["spec"]["containers"][0]
        for probe in ("startupProbe", "readinessProbe", "livenessProbe"):
            self.assertEqual("metrics", container[probe]["httpGet"]["port"])
        self.assertIn("--workers=$(CPU_LIMIT)", container["args"])
        self.assertEqual("limits.cpu", container["env"][0]["valueFrom"]["resourceFieldRef"]["resource"])

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

    def test_the_encrypted_overlay_mounts_what_its_flags_and_probes_name(self):
        found = objects("encrypted")
        pod = found["Deployment", "traverse"]["spec"]["template"]["spec"]
        container = pod["containers"][0]
        folders = {mount["mountPath"]: mount["name"] for mount in container["volumeMounts"]}
        secrets = {volume["name"]: volume["secret"]["secretName"] for volume in pod["volumes"] if "secret" in volume}
        named = re.findall(r"=(/etc/traverse/\w+)/", " ".join(container["args"] + container["readinessProbe"]["exec"]["command"]))

        self.assertEqual({"/etc/traverse/flags", "/etc/traverse/tls", "/etc/traverse/tokens"}, set(named))
        self.assertLessEqual(set(named), set(folders))
        self.assertEqual({"tls": "traverse-tls", "tokens": "traverse-tokens"}, secrets)
        self.assertGreater(container["args"].index("--insecure=false"), container["args"].index("--flagfile=/etc/traverse/flags/server.flags"))
        certificate = found["Certificate", "traverse"]["spec"]
        asked = next(word for word in container["readinessProbe"]["exec"]["command"] if "server_name" in word).split("=")[1]
        self.assertEqual(secrets["tls"], certificate["secretName"])
        self.assertIn(asked, certificate["dnsNames"])
        self.assertIn("client auth", certificate["usages"])
        for service in ("traverse", "traverse-headless"):
            self.assertIn(f"{service}.{found['Deployment', 'traverse']['metadata']['namespace']}.svc", certificate["dnsNames"])

    def test_plaintext_stays_behind_the_network_policy(self):
        for overlay in OVERLAYS:
            found = objects(overlay)
            policy = found["NetworkPolicy", "traverse"]["spec"]
            self.assertEqual({"Ingress", "Egress"}, set(policy["policyTypes"]))
            self.assertEqual([], policy.get("egress") or [])
            jobs = [rule for rule in policy["ingress"] if {"protocol": "TCP", "port": "grpc"} in rule["ports"]]
            self.assertEqual(1, len(jobs))
            self.assertTrue(all(peer["podSelector"]["matchLabels"] for peer in jobs[0]["from"]))

    def test_the_image_is_of_this_version(self):
        version = re.search(r"project\(traverse VERSION (\S+)", (support.SOURCE / "CMakeLists.txt").read_text())[1]
        for overlay in OVERLAYS:
            container = objects(overlay)["Deployment", "traverse"]["spec"]["template"]["spec"]["containers"][0]
            self.assertEqual(f"docker.io/library/traverse-server:{version}", container["image"])


# An overlay, what stands in it, and what makes its document a wrong one.
WRONG = (("production", "minReplicas", "minReplica"), ("production", "containerPort", "containrPort"),
         ("production", "cpu: ", "cpu: [1] #"), ("encrypted", "renewBefore", "renewBeforehand"),
         ("encrypted", "secretName: traverse-tls\n    ", "secretNam: traverse-tls\n    "))


class Schemas(unittest.TestCase):

    def test_every_document_fits_its_schema_and_a_wrong_one_does_not(self):
        with tempfile.TemporaryDirectory() as scratch:
            work = pathlib.Path(scratch)
            for path in (support.SOURCE / "tests/deploy/kubernetes").iterdir():
                shutil.copy(path, work)
            support.install_node_packages(work)

            texts = {overlay: render(overlay) for overlay in OVERLAYS}
            texts["gateway"] = render_with_gateway("production")
            for index, (overlay, *wrong) in enumerate(WRONG):
                texts[f"wrong-{index}"] = render(overlay).replace(*wrong)
                self.assertNotEqual(render(overlay), texts[f"wrong-{index}"], wrong)
            for name, text in texts.items():
                (work / f"{name}.yaml").write_text(text)
            done = support.run("node", work / "validate.mjs", *(f"{name}.yaml" for name in texts), ok=False, cwd=work)

            faults = {match[1]: int(match[2]) for match in re.finditer(r"^(.+)\.yaml: [1-9]\d* documents, (\d+) faults$", done.stdout, re.M)}
            self.assertEqual(set(texts), set(faults), done.stdout + done.stderr)
            for name, count in faults.items():
                with self.subTest(name=name):
                    self.assertEqual(name.startswith("wrong-"), count > 0, done.stdout)
            self.assertNotEqual(0, done.returncode)


if __name__ == "__main__":
    support.main("kubectl")
