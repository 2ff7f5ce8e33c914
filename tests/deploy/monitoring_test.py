#!/usr/bin/python3
"""Rules and dashboard as text: promtool accepts them, and they agree with each other."""

import json
import pathlib
import re
import tempfile
import unittest

import support

MONITORING = support.DEPLOY / "monitoring"
DASHBOARD = MONITORING / "dashboard" / "traverse.json"

# The names that the server promises, and those that it adds to them.
METRICS = """jobs_total layers_total layer_solve_seconds job_seconds queue_layers jobs_in_flight workers_busy
workers ready travel_given_mm_total travel_mm_total idle_seconds_saved_total optimality_gap_ratio rejected_total
invalid_routes_total build_info workers_silent memory_bytes memory_max_bytes connections connections_cut_total
certificate_expiry_seconds reload_failures_total log_lines_lost_total
gateway_uploads_total gateway_requests_total gateway_request_seconds gateway_files_total
gateway_requests_in_flight gateway_requests_waiting gateway_spool_bytes gateway_print_seconds_saved_total""".split()


def panels():
    return [panel for panel in json.loads(DASHBOARD.read_text())["panels"] if panel["type"] != "row"]


def concrete(expression, window="1m"):
    """The expression as Grafana sends it, for all servers."""
    for name in ("$__rate_interval", "$__range"):
        expression = expression.replace(name, window)
    return expression.replace("$job", ".+").replace("$instance", ".+")


def expressions():
    return [target["expr"] for panel in panels() for target in panel["targets"]]


def rules():
    return "".join(path.read_text() for path in sorted((MONITORING / "rules").glob("*.yml")))


class Rules(unittest.TestCase):

    def test_promtool_accepts_every_rule_and_every_query_of_the_dashboard(self):
        support.run("promtool", "check", "rules", *sorted((MONITORING / "rules").glob("*.yml")))
        lines = ["groups:", "- name: dashboard", "  rules:"]
        for index, expression in enumerate(expressions()):
            lines += [f"  - record: panel_{index}", f"    expr: {json.dumps(concrete(expression))}"]
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "dashboard.yml"
            path.write_text("\n".join(lines))
            support.run("promtool", "check", "rules", path)

    def test_the_rules_give_what_the_cases_say(self):
        cases = sorted((support.SOURCE / "tests/deploy/monitoring").glob("*_test.yml"))
        self.assertEqual(2, len(cases))
        support.run("promtool", "test", "rules", *cases)

    def test_every_alert_has_cases_and_a_section_in_the_runbook(self):
        alerts = re.findall(r"alert: (\w+)", rules())
        cases = (support.SOURCE / "tests/deploy/monitoring/alerts_test.yml").read_text()
        runbook = (support.DEPLOY / "RUNBOOK.md").read_text()
        self.assertGreaterEqual(len(alerts), 10)
        for alert in alerts:
            self.assertIn(f'alertname="{alert}"', cases)
            self.assertRegex(runbook, rf"(?m)^### {alert}$")
        self.assertEqual(len(alerts), rules().count("runbook: "))

    def test_only_known_metrics_are_asked_for(self):
        asked = set(re.findall(r"(?<![\w:])traverse_[a-z_]+", rules() + "\n".join(expressions())))
        known = {f"traverse_{name}{suffix}" for name in METRICS for suffix in ("", "_bucket")}
        self.assertEqual(set(), asked - known)

    def test_only_recorded_series_are_asked_for(self):
        recorded = set(re.findall(r"record: (\S+)", rules()))
        asked = set(re.findall(r"\w+:traverse_[a-z_]+:\w+", "\n".join(expressions()) + rules()))
        self.assertEqual(set(), asked - recorded)


class Dashboard(unittest.TestCase):

    def test_panels_have_queries_units_and_descriptions(self):
        for panel in panels():
            with self.subTest(panel["title"]):
                self.assertTrue(panel["targets"])
                self.assertTrue(panel["description"].endswith("."))
                letters = [target["refId"] for target in panel["targets"]]
                self.assertEqual(sorted(set(letters)), letters)
                self.assertEqual("${datasource}", panel["datasource"]["uid"])

    def test_panels_have_names_and_places_of_their_own(self):
        titles = [panel["title"] for panel in panels()]
        places = [(panel["gridPos"]["x"], panel["gridPos"]["y"]) for panel in panels()]
        ids = [panel["id"] for panel in panels()]
        for values in (titles, places, ids):
            self.assertEqual(len(values), len(set(values)))


if __name__ == "__main__":
    support.main("promtool")
