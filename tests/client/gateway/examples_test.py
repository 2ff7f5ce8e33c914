"""The examples that send files, in Python and Node, against a gateway.

The environment names the binaries: TRAVERSE and TRAVERSE_GATEWAY.
"""
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
from gateway_process import TESTS, Gateway, lines_of_infill, optimised_by_command

EXAMPLES = os.path.join(os.path.dirname(TESTS), "deploy", "examples")
PART = lines_of_infill(3)


class Examples(unittest.TestCase):
    def setUp(self):
        self.gateway = Gateway()
        self.addCleanup(self.gateway.close)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.part, self.made = (os.path.join(folder.name, name) for name in ("part.gcode", "made.gcode"))

    def try_it(self, command):
        for content, code in [(PART, 0), (b"no file of a slicer\n", 1)]:
            with open(self.part, "wb") as file:
                file.write(content)
            done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
            self.assertEqual(done.returncode, code, done.stderr)
            if code:
                self.assertIn("part.gcode: ", done.stderr)
                continue
            self.assertIn("layers rewritten", done.stdout)
            with open(self.made, "rb") as file:
                self.assertEqual(file.read(), optimised_by_command(PART, "--policy=free"))

    def test_python(self):
        if importlib.util.find_spec("requests") is None:
            self.skipTest("no python3-requests")
        self.try_it([sys.executable, os.path.join(EXAMPLES, "python", "send_file.py"), self.part, "-o", self.made,
                     f"--gateway=http://127.0.0.1:{self.gateway.http_port}", "--policy=free"])

    def test_node(self):
        if not shutil.which("node"):
            self.skipTest("no node")
        self.try_it(["node", os.path.join(EXAMPLES, "node", "send_file.mjs"), self.part, self.made,
                     f"http://127.0.0.1:{self.gateway.http_port}", "free"])


if __name__ == "__main__":
    unittest.main()
