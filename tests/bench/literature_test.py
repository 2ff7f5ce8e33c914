"""literature.py on instances of no content, with a command that answers what it is told to."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
NAMES = ("11eil51", "16pr76")

# Writes a route of the length that it is told, 1 % above its bound; twice as long at effort 16.
COMMAND = """#!{python}
import json, os, sys
if sys.argv[1] == "--version":
    sys.exit(print("traverse 9.9.9"))
flags = dict(flag.lstrip("-").split("=", 1) for flag in sys.argv[3:] if "=" in flag)
length = float(os.environ["LENGTH"]) * (2 if flags.get("option") == "effort=16" else 1)
layer = {{"travel_mm": length, "lower_bound_mm": 0.99 * length}}
with open(flags["json"], "w", encoding="utf-8") as out:
    json.dump({{"layers": [layer], "tour": {{"rounded_length": length}}}}, out)
"""


class Literature(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name in NAMES:
            (self.folder / f"{name}.gtsp").touch()
        self.command = self.folder / "traverse"
        self.command.write_text(COMMAND.format(python=sys.executable), encoding="utf-8")
        self.command.chmod(0o755)

    def run_script(self, length, *flags):
        return subprocess.run(
            [sys.executable, HERE / "literature.py", f"--traverse={self.command}", "--seeds=1", *flags, self.folder],
            env=os.environ | {"LENGTH": str(length)}, capture_output=True, text=True, check=False, timeout=120)

    def page(self, length, *flags):
        ran = self.run_script(length, *flags)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        return ran.stdout

    @staticmethod
    def rows(page):
        cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in page.splitlines()]
        return {row[0]: row for row in cells if row[0] in (*NAMES, "mean")}

    def test_a_page_has_percentages_above_the_published_values(self):
        row = self.rows(self.page(174 * 1.1, "--seconds=0"))["11eil51"]
        lengths = row[2:10:2]
        self.assertEqual(row[1], "174")
        self.assertEqual(lengths, ["10.00", "10.00", "10.00", "120.00"])
        self.assertEqual(row[10], "1.0")
        self.assertEqual(row[11:], ["-", "-", "-"])

    def test_only_what_is_measured_anew_changes(self):
        page = self.folder / "page.md"
        page.write_text(self.page(174 * 1.1, "--seconds=0"), encoding="utf-8")
        before = self.rows(page.read_text(encoding="utf-8"))
        after = self.rows(self.page(174, f"--page={page}", "--anew=1", "--only=11eil51", "--seconds=0"))
        changed = {(name, i) for name in NAMES for i, cell in enumerate(after[name]) if cell != before[name][i]}
        self.assertIn(("11eil51", 4), changed)
        self.assertEqual(after["11eil51"][4], "0.00")
        self.assertLessEqual(changed, {("11eil51", 4), ("11eil51", 5), ("11eil51", 10)})
        self.assertNotEqual(after["mean"][4], before["mean"][4])
        # A page has two places, and the mean is that of what it has.
        self.assertAlmostEqual(float(after["mean"][8]), float(before["mean"][8]), delta=0.02)

    def test_proofs_can_be_measured_anew_alone(self):
        page = self.folder / "page.md"
        page.write_text(self.page(200, "--seconds=0"), encoding="utf-8")
        before = self.rows(page.read_text(encoding="utf-8"))
        after = self.rows(self.page(200, f"--page={page}", "--anew=proof", "--seconds=0.001"))
        for name in NAMES:
            self.assertEqual(after[name][:-1], before[name][:-1])
            self.assertEqual(after[name][-1], "open 1.0 %")

    def test_flags_that_make_no_sense_are_refused(self):
        page = self.folder / "page.md"
        page.write_text("| 11eil51 | 174 |\n", encoding="utf-8")
        self.assertIn("go together", self.run_script(1, "--anew=1").stderr)
        self.assertIn("go together", self.run_script(1, f"--page={page}").stderr)
        self.assertIn("no such column", self.run_script(1, f"--page={page}", "--anew=3").stderr)
        other = self.folder / "other.md"
        other.write_text("| 99d493 |\n", encoding="utf-8")
        self.assertIn("no row of 11eil51", self.run_script(1, f"--page={other}", "--anew=1").stderr)


if __name__ == "__main__":
    unittest.main()
