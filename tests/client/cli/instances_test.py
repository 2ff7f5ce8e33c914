"""Every bundled part with the strategies of the sources: legal routes of the lengths that reference.json has.

The environment variable TRAVERSE names the binary.
"""
import json
import os
import statistics
import subprocess
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
TESTS = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(TESTS, "support"))
import check_routes  # noqa: E402

TRAVERSE = os.environ["TRAVERSE"]
BENCH = os.path.join(TESTS, "bench")

LABELS = {"none": "none", "greedy": "greedy", "ni2opt_without_release": "ni2opt:point_release=false",
          "ni2opt": "ni2opt"}


def instance(name):
    plain = os.path.join(BENCH, "instances", f"{name}.damat")
    return plain if os.path.exists(plain) else plain + ".xz"


class Instances(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with open(os.path.join(BENCH, "reference.json"), encoding="utf-8") as file:
            cls.reference = json.load(file)
        cls.documents = {name: cls.compare(name, values["layers"]) for name, values in cls.reference.items()}

    @staticmethod
    def compare(name, layers):
        ran = subprocess.run([TRAVERSE, "compare", instance(name), f"--layers={layers}", "--json=-", "--quiet",
                              "--strategies=" + ",".join(LABELS.values())], stdout=subprocess.PIPE,
                             stderr=subprocess.DEVNULL, check=True, timeout=300)
        return {run["label"]: run["routes"] for run in json.loads(ran.stdout)["runs"]}

    def test_a_table_of_all_strategies_ends_soon(self):
        # Of the hundreds of contours here no strategy proves a route optimal for hours.
        ran = subprocess.run([TRAVERSE, "compare", instance("st200"), "--layers=1", "--quiet"], stdout=subprocess.PIPE,
                             check=True, timeout=120, text=True)
        self.assertIn("ni2opt", ran.stdout)

    def test_auto_by_default_is_within_a_percent_of_the_best_known(self):
        # With a quarter of the patience it ended 3.4 and 4.0 % above with seeds 1 and 2.
        best = self.reference["s4_grille"]["best_known_by_layer"][0]
        for seed in (1, 2, 3):
            ran = subprocess.run([TRAVERSE, "optimize", instance("s4_grille"), "--layers=1", f"--seed={seed}", "--quiet",
                                  "--json=-"], stdout=subprocess.PIPE, check=True, timeout=120)
            with self.subTest(seed=seed):
                self.assertLessEqual(json.loads(ran.stdout)["total"]["travel_mm"], 1.01 * best)

    def travel(self, name, strategy):
        return self.documents[name][LABELS[strategy]]["total"]["travel_mm"]

    def test_every_route_is_legal_and_of_the_length_stated(self):
        for name, documents in self.documents.items():
            part = check_routes.read_part(check_routes.read_text(instance(name)))
            for label, document in documents.items():
                with self.subTest(name=name, strategy=label):
                    checker = check_routes.Checker(part)
                    checker.check(document)
                    self.assertEqual(checker.faults, [])

    def test_lengths_are_those_of_the_reference(self):
        # How ties are broken moves greedy a little; how ni2opt inserts, a few percent.
        tolerances = {"none": 1e-9, "greedy": 0.005, "ni2opt_without_release": 0.03}
        for name, values in self.reference.items():
            for strategy, tolerance in tolerances.items():
                with self.subTest(name=name, strategy=strategy):
                    wanted = values[strategy]
                    self.assertLessEqual(abs(self.travel(name, strategy) - wanted), tolerance * wanted + 1e-6)

    def test_point_release_saves_two_percent_in_the_mean(self):
        gains = [1 - self.travel(name, "ni2opt") / self.travel(name, "ni2opt_without_release")
                 for name in self.reference]
        self.assertGreaterEqual(statistics.mean(gains), 0.02)
        self.assertGreaterEqual(min(gains), 0)


if __name__ == "__main__":
    unittest.main()
