#!/usr/bin/python3
"""A real Prometheus scrapes loaded servers and a gateway: every panel and every recorded series has data.

With TRAVERSE_PICTURE=FILE.svg in the environment the picture of the dashboard is kept there, of TRAVERSE_PICTURE_SECONDS of load.
"""

import json
import os
import pathlib
import re
import shutil
import sys
import tempfile
import time
import unittest
import urllib.parse
import xml.etree.ElementTree

import support
from support import fleet, jobs, python_client

sys.path.append(str(support.SOURCE / "tests/client/gateway"))
import gateway_process  # noqa: E402
from printer_stand_in import PrinterStandIn  # noqa: E402

yaml = support.module("yaml", "python3-yaml")

MONITORING = support.DEPLOY / "monitoring"


class Prometheus(support.Process):
    """The configuration of compose.yaml with the fleet's addresses, scraping each second."""

    def __init__(self, folder, servers, stats, gateway):
        config = yaml.safe_load((support.DEPLOY / "compose/prometheus.yml").read_text())
        config["global"] = {"scrape_interval": "1s", "evaluation_interval": "1s"}
        targets = {"traverse": [f"127.0.0.1:{server.metrics_port}" for server in servers], "balancer": [stats],
                   "traverse-gateway": [f"127.0.0.1:{gateway.metrics_port}"]}
        for scrape in config["scrape_configs"]:
            scrape["static_configs"][0]["targets"] = targets[scrape["job_name"]]
        (folder / "rules").mkdir()
        for path in (MONITORING / "rules").glob("*.yml"):
            (folder / "rules" / path.name).write_text(re.sub(r"interval: \w+", "interval: 1s", path.read_text()))
        (folder / "prometheus.yml").write_text(yaml.safe_dump(config))
        support.run("promtool", "check", "config", folder / "prometheus.yml")
        self.url = f"http://127.0.0.1:{support.free_port()}"
        super().__init__("prometheus", f"--config.file={folder}/prometheus.yml", f"--storage.tsdb.path={folder}/data",
                         f"--web.listen-address={self.url.removeprefix('http://')}")

    def ask(self, kind, **parameters):
        status, text = support.http(f"{self.url}/api/v1/{kind}?{urllib.parse.urlencode(parameters)}", timeout=20)
        if status != 200:
            raise AssertionError(f"{parameters}: {status} {text}")
        return json.loads(text)["data"]

    def samples(self, expression):
        """The numbers that an expression gives now, without NaN."""
        result = self.ask("query", query=expression)["result"]
        return [float(one["value"][1]) for one in result if one["value"][1] != "NaN"]


def concrete(expression):
    for name, value in (("$__rate_interval", "15s"), ("$__range", "5m"), ("$job", ".+"), ("$instance", ".+")):
        expression = expression.replace(name, value)
    return expression


class Observability(unittest.TestCase):

    def setUp(self):
        python_client.load()
        from traverse_client import TravelOptimizer, TraverseError
        self.failed = TraverseError
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="traverse-prometheus-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.make_client = TravelOptimizer

    def request(self, islands=20, **options):
        return python_client.job(jobs.plate(layers=8, islands=islands, options=options))

    def load(self, address):
        """Jobs of every strategy, some with little time, some that are wrong."""
        client = self.make_client([address])
        self.addCleanup(client.close)
        infos = client.strategies()
        requests = [self.request(strategy={"name": info.name}, layer_time_limit="0.02s") for info in infos]
        # Small enough for bounds that are worth something.
        requests += [self.request(islands=4, strategy={"name": info.name}, layer_time_limit="2s") for info in infos if info.lower_bound]
        requests.append(self.request(strategy={"name": "nonsense"}))
        turn = iter(range(10 ** 9))

        def submit():
            try:
                for _ in python_client.optimize(client, requests[next(turn) % len(requests)], 30):
                    pass
            except self.failed:
                pass
            time.sleep(0.02)
        return submit, any(info.lower_bound for info in infos)

    def gateway(self, servers):
        """A gateway before the servers, and a printer behind it."""
        support.binary("TRAVERSE_GATEWAY")
        printer = PrinterStandIn()
        self.addCleanup(printer.close)
        config = self.folder / "printers.json"
        config.write_text(json.dumps({"default": "octo", "printers": [{"name": "octo", "url": printer.url}]}))
        addresses = ",".join(server.address for server in servers)
        gateway = gateway_process.Gateway(f"--server={addresses}", f"--printers={config}")
        self.addCleanup(gateway.close)
        return gateway

    def files(self, gateway):
        """One file after the other, to whoever sent it and to the printer."""
        part = gateway_process.lines_of_infill(3)
        form, headers = gateway_process.form([("print", "false"), ("file", "part.gcode", part)])

        def submit():
            if gateway.ask("POST", "/v1/gcode?strategy=greedy", part)[0] != 200:
                raise AssertionError("a file was refused")
            if gateway.ask("POST", "/api/files/local", form, {**headers, "X-Api-Key": "secret"})[0] != 201:
                raise AssertionError("an upload was refused")
            time.sleep(0.1)
        return submit

    def test_every_panel_and_every_recorded_series_has_data(self):
        dashboard = json.loads((MONITORING / "dashboard/traverse.json").read_text())
        recorded = re.findall(r"record: (\S+)", (MONITORING / "rules/recording.yml").read_text())
        panels = [(panel["title"], concrete(target["expr"])) for panel in dashboard["panels"] if panel["type"] != "row"
                  for target in panel["targets"]]
        with fleet.Fleet() as servers:
            gateway = self.gateway(servers.servers)
            prometheus = self.enterContext(Prometheus(self.folder, servers.servers, servers.stats, gateway))
            submit, bounds = self.load(servers.address)
            with fleet.Load(submit, threads=2), fleet.Load(self.files(gateway), threads=1):
                missing = list(recorded) + panels
                end = time.monotonic() + 40
                while missing and time.monotonic() < end:
                    time.sleep(2)
                    missing = [one for one in missing if not self.has_data(prometheus, one, bounds)]
                self.assertEqual([], missing)
                self.draw(prometheus, dashboard)
                firing = prometheus.ask("query", query='ALERTS{alertstate="firing", severity="page"}')["result"]
                active = {one["labels"]["instance"]: one["health"] for one in prometheus.ask("targets")["activeTargets"]}

        self.assertEqual([], firing)
        self.assertEqual({"up"}, set(active.values()))
        self.assertEqual(5, len(active))
        print(f"{len(panels)} queries of the dashboard and {len(recorded)} recorded series have data")

    def has_data(self, prometheus, one, bounds):
        title, expression = (one, one) if isinstance(one, str) else one
        if title == "Gap to the optimum" and not bounds:
            return True  # no strategy of this server gives bounds
        return bool(prometheus.samples(expression))

    def draw(self, prometheus, dashboard):
        """render_dashboard.py draws each panel with its data."""
        kept = os.environ.get("TRAVERSE_PICTURE")
        seconds = float(os.environ.get("TRAVERSE_PICTURE_SECONDS", "120" if kept else "20"))
        if kept:
            time.sleep(seconds)
        path = pathlib.Path(kept or self.folder / "dashboard.svg")
        words = ("/usr/bin/python3", MONITORING / "render_dashboard.py", "-o", path, f"--minutes={seconds / 60}",
                 "--rate_interval=15s")
        support.run(*words, f"--prometheus={prometheus.url}")
        picture = path.read_text()
        xml.etree.ElementTree.fromstring(picture)
        for panel in dashboard["panels"]:
            self.assertIn(f">{panel['title']}<", picture)
        self.assertNotIn(">no data<", picture)
        self.assertGreater(picture.count("<polyline"), 20)
        self.assertGreater(picture.count("<rect"), len(dashboard["panels"]) + 10)  # cells of the heat maps

        nobody = support.run(*words, f"--prometheus=http://127.0.0.1:{support.free_port()}", ok=False)
        self.assertEqual((1, 1), (nobody.returncode, len(nobody.stderr.splitlines())))

    def test_the_servers_metrics_follow_prometheus_rules(self):
        with support.Server() as server:
            text = support.http(f"{server.metrics}/metrics")[1]
        done = support.run("promtool", "check", "metrics", input=text, ok=False)
        self.assertEqual((0, ""), (done.returncode, done.stdout + done.stderr))


if __name__ == "__main__":
    support.main("prometheus", "promtool", "haproxy", "protoc", "grpc_python_plugin")
