"""`traverse reproduce`: every table of both sources, in a form so short that it says nothing but that it works.

The environment variable TRAVERSE names the binary.
"""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

TRAVERSE = os.environ["TRAVERSE"]
TINY = ["--short", "--layers=1", "--seeds=2", "--diversifications=10", "--programme_limit=20ms"]


def reproduce(*arguments):
    return subprocess.run([TRAVERSE, "reproduce", *TINY, *arguments], capture_output=True, text=True, check=False, timeout=300)


class Reproduce(unittest.TestCase):
    def test_prints_every_table_and_goes_on_from_its_results(self):
        with tempfile.TemporaryDirectory() as folder:
            results, page = pathlib.Path(folder, "runs.jsonl"), pathlib.Path(folder, "figures.html")
            first = reproduce(f"--results={results}", f"--report={page}")
            self.assertEqual(first.returncode, 0, first.stderr)
            for table in ("Tabela 3.1", "Tabela 3.2", *(f"Tabela 5.{i}" for i in range(1, 9)), "Figura 5.13",
                          "Método 3 em relação ao Método 1", "Método 3 em relação ao Método 2"):
                self.assertIn(table, first.stdout)
            for word in ("Rota-C", "Rota-CRS", "5711.50", "-3.65"):
                self.assertIn(word, first.stdout)
            html = page.read_text(encoding="utf-8")
            for figure in ("Figura 5.1", "vizinhanças", "sequência preliminar", "polígonos de visibilidade", "Rota-CRS (passo 4)"):
                self.assertIn(figure, html)

            # What was finished is not run again, and comes to the same.
            again = reproduce(f"--results={results}", "--source=paper")
            self.assertEqual(again.returncode, 0, again.stderr)
            self.assertEqual(again.stderr, "")
            self.assertIn(again.stdout.strip(), first.stdout)
            self.assertNotIn("Tabela 5.2", again.stdout)

            results.write_text("{}\n{}\n", encoding="utf-8")
            broken = reproduce(f"--results={results}", "--source=paper")
            self.assertEqual((broken.returncode, broken.stderr.strip()), (1, f"{results}:1: no outcome of a run"))

    def test_a_program_copied_elsewhere_finds_the_parts_of_the_sources_it_is_called_in(self):
        sources = pathlib.Path(__file__).resolve().parents[3]
        with tempfile.TemporaryDirectory() as folder:
            copy = shutil.copy(TRAVERSE, folder)

            def ask(place, *arguments):
                return subprocess.run([copy, "reproduce", *TINY, "--source=paper", "--quiet", *arguments], cwd=place,
                                      capture_output=True, text=True, check=False, timeout=300)
            self.assertEqual(ask(sources / "engine").returncode, 0)
            lost = ask(folder)
            self.assertEqual(lost.returncode, 2)
            self.assertIn("name their folder with --parts=FOLDER (in the source tree tests/bench/instances)", lost.stderr)
            self.assertEqual(ask(folder, f"--parts={sources}/tests/bench/instances").returncode, 0)

    def test_says_what_is_wrong(self):
        self.assertEqual(reproduce("--source=both").returncode, 2)
        self.assertEqual(reproduce("--layers=0").returncode, 2)
        missing = reproduce("--parts=/nowhere", "--source=paper", "--quiet")
        self.assertEqual(missing.returncode, 1)
        self.assertIn("/nowhere/part1.damat", missing.stderr)


if __name__ == "__main__":
    unittest.main()
