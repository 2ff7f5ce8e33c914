"""The guides' figures that a seed decides are those of this build: `tests/docs/figures.py --write` writes them anew."""
import os
import pathlib
import subprocess
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
os.environ["TRAVERSE"] = os.path.join(os.environ["TRAVERSE_BUILD"], "client", "traverse")


class Figures(unittest.TestCase):
    def test_guides_have_the_figures_of_this_build(self):
        ran = subprocess.run([sys.executable, HERE / "figures.py"], capture_output=True, text=True, check=False, timeout=900)
        self.assertEqual((ran.returncode, ran.stdout), (0, ""), ran.stderr)

    def test_a_figure_that_differs_is_told(self):
        sys.path.insert(0, str(HERE))
        import figures
        figures.BLOCKS = {"methods": lambda: "| a |\n| 2 |"}
        text = "<!-- figures methods -->\n| a |\n| 1 |\n<!-- end of figures -->\n"
        self.assertIn("| 2 |", figures.renewed(text))
        self.assertNotIn("| 1 |", figures.renewed(text))


if __name__ == "__main__":
    unittest.main()
