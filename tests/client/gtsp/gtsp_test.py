"""GTSPLIB's files on the command line: optimal tours of random instances by brute force, and faults.

The environment variable TRAVERSE names the binary.
"""
import itertools
import json
import math
import os
import random
import subprocess
import tempfile
import unittest

TRAVERSE = os.environ["TRAVERSE"]
HERE = os.path.dirname(os.path.abspath(__file__))
SMALL = os.path.join(HERE, "..", "..", "data", "gtsp", "4small10.gtsp")


def text_of(points, sets):
    lines = ["NAME: random", "TYPE: GTSP", f"DIMENSION: {len(points)}", f"GTSP_SETS: {len(sets)}",
             "EDGE_WEIGHT_TYPE: EUC_2D", "NODE_COORD_SECTION"]
    lines += [f"{i + 1} {x} {y}" for i, (x, y) in enumerate(points)]
    lines += ["GTSP_SET_SECTION"] + [" ".join(map(str, [k + 1, *[i + 1 for i in s], -1])) for k, s in enumerate(sets)]
    return "\n".join(lines + ["EOF", ""])


def rounded(a, b):
    return int(math.hypot(a[0] - b[0], a[1] - b[1]) + 0.5)


def length(points, tour, distance):
    return sum(distance(points[tour[i - 1]], points[tour[i]]) for i in range(len(tour)))


def shortest(points, sets):
    """The length of the shortest closed tour, of all that there are."""
    orders = ([sets[0], *rest] for rest in itertools.permutations(sets[1:]))
    return min(length(points, tour, math.dist) for order in orders for tour in itertools.product(*order))


class Gtsp(unittest.TestCase):
    def run_traverse(self, *arguments, stdin=b""):
        ran = subprocess.run([TRAVERSE, *arguments], input=stdin, capture_output=True, timeout=120, check=False)
        return ran.returncode, ran.stdout.decode(), ran.stderr.decode()

    def document(self, text, *arguments):
        code, out, err = self.run_traverse("optimize", "-", "--quiet", "--json=-", *arguments, stdin=text.encode())
        self.assertEqual((code, err), (0, ""))
        return json.loads(out)

    def test_tours_are_optimal_legal_and_stated_in_the_files_numbers(self):
        draw = random.Random(19)
        for instance in range(8):
            points = [(draw.uniform(0, 1000), draw.uniform(0, 1000)) for _ in range(12)]
            ids = draw.sample(range(12), 12)
            sets = [ids[0:2], ids[2:5], ids[5:7], ids[7:9], ids[9:12]]
            draw.shuffle(sets)
            with self.subTest(instance=instance):
                made = self.document(text_of(points, sets), "--strategy=" + draw.choice(["auto", "exact"]))
                least = min(layer["travel_mm"] for layer in made["layers"])
                self.assertAlmostEqual(least, shortest(points, sets), places=6)
                self.assertLessEqual(min(layer["lower_bound_mm"] for layer in made["layers"]), least + 1e-6)
                tour = [i - 1 for i in made["tour"]["points"]]
                self.assertEqual(sorted(len(set(tour) & set(s)) for s in sets), [1] * 5)
                self.assertEqual(length(points, tour, rounded), made["tour"]["rounded_length"])

    def test_the_summary_has_the_tour(self):
        code, out, err = self.run_traverse("optimize", SMALL)
        self.assertEqual((code, err), (0, ""))
        self.assertRegex(out, r"(?m)^tour +\d+ by rounded distances \(EUC_2D\)$")

    def test_inspect_and_compare_read_it(self):
        code, out, _ = self.run_traverse("inspect", SMALL)
        self.assertEqual(code, 0)
        self.assertIn("4small10.gtsp: GTSPLIB\n", out)
        self.assertIn("4, of 10 points", out)
        code, out, err = self.run_traverse("compare", SMALL, "--strategies=greedy,exact", "--quiet")
        self.assertEqual((code, err), (0, ""))
        self.assertRegex(out, r"(?m)^exact ")

    def test_a_fault_is_one_line_with_its_place_and_code_1(self):
        with tempfile.TemporaryDirectory() as folder:
            name = os.path.join(folder, "a.gtsp")
            with open(SMALL, encoding="utf-8") as file:
                text = file.read()
            for wrong, fault in [
                    (text.replace("3 6 7 -1", "3 6 7 1 -1"), f"{name}:22: point 1 is in set 1 and in set 3"),
                    (text.replace("TYPE: GTSP", "TYPE: TSP"), f'{name}:2: TYPE is "TSP", but only GTSP is supported'),
                    (text[:text.index("4 8 9")], f"{name}:22: GTSP_SETS is 4, but there are 3 sets: is the file cut short?"),
                    ("", f"{name}: the file is empty")]:
                with open(name, "w", encoding="utf-8") as file:
                    file.write(wrong)
                self.assertEqual(self.run_traverse("optimize", name, "--json=-"), (1, "", fault + "\n"))

    def test_it_is_read_and_not_written(self):
        code, _, err = self.run_traverse("convert", SMALL, "-o", "x.gtsp")
        self.assertEqual(code, 2)
        self.assertIn("-o writes .damat, .json or .pb", err)
        code, _, err = self.run_traverse("optimize", SMALL, "-o", "x.gtsp")
        self.assertEqual((code, err), (2, "traverse optimize: -o is for G-code; the routes of GTSPLIB go to --json=FILE\n"))


if __name__ == "__main__":
    unittest.main()
