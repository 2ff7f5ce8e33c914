"""The commands of README.md and of the guides of client, gateway and server do what the guides say, word for word but for the ports.

Runs every block marked `sh` in a folder of its own, where `build/release` is the build under test. TRAVERSE_BUILD names it.
"""
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import unittest
import zipfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE))

from tests.support import short_part  # noqa: E402

BUILD = pathlib.Path(os.environ["TRAVERSE_BUILD"])

# These build and test the whole project; whoever runs this test has done so.
ELSEWHERE = ("deploy/quickstart.sh", "tests/run.sh")


def blocks(guide):
    """The blocks of commands of a guide."""
    return re.findall(r"(?ms)^```sh\n(.*?)^```", (SOURCE / guide).read_text(encoding="utf-8"))


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return str(probe.getsockname()[1])


class Commands(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        (self.folder / "build").mkdir()
        (self.folder / "build/release").symlink_to(BUILD)
        (self.folder / "deploy").symlink_to(SOURCE / "deploy")
        shutil.copy(SOURCE / "tests/bench/instances/part1.damat", self.folder / "part.damat")
        short_part.write(self.folder / "part.gcode")
        with zipfile.ZipFile(self.folder / "plates.gcode.3mf", "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("[Content_Types].xml", "<Types/>")
            for plate in (1, 2):
                archive.write(self.folder / "part.gcode", f"Metadata/plate_{plate}.gcode")

    def run_block(self, block):
        """Runs it, and ends what it left in the background."""
        for port in ("50051", "9464", "8080"):
            block = block.replace(port, free_port())
        # A reader types more slowly than a busy machine starts a server; a script does not.
        wait = r"\g<0>\ntimeout 60 bash -c 'until (: </dev/tcp/127.0.0.1/\1) 2>/dev/null; do sleep 0.05; done'"
        block = re.sub(r"(?m)^.*--listen=127\.0\.0\.1:(\d+).*&$", wait, block)
        # Only the block's own jobs, by their numbers.
        script = "trap 'code=$?; kill $(jobs -p) 2>/dev/null || true; wait; exit $code' EXIT\n" + block
        path = f"{BUILD / 'client'}:{BUILD / 'server'}:{os.environ['PATH']}"
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=self.folder, capture_output=True, text=True,
                              check=False, timeout=300, env={**os.environ, "PATH": path, "NO_COLOR": "1"})
        self.assertEqual(done.returncode, 0, f"{block}\n{done.stdout}{done.stderr}")
        return done.stdout

    def test_of_the_readme(self):
        run = [block for block in blocks("README.md") if not block.startswith(ELSEWHERE)]
        self.assertEqual(len(run), 4)
        for block in run:
            with self.subTest(block):
                self.run_block(block)
        for made in ("routes.json", "optimised.gcode", "report.html", "strategies.html"):
            self.assertGreater((self.folder / made).stat().st_size, 1000, made)

    def test_of_the_clients_guide(self):
        run = blocks("client/README.md")
        self.assertGreaterEqual(len(run), 2)
        for block in run:
            with self.subTest(block):
                self.run_block(block)
        for made in ("routes.json", "shorter.gcode", "part.json"):
            self.assertTrue((self.folder / made).exists(), made)

    def test_of_the_servers_guide(self):
        run = blocks("server/README.md")
        self.assertEqual(len(run), 2)
        for block in run:
            with self.subTest(block):
                self.assertIn("listening on port", self.run_block(block))

    def test_of_the_gateways_guide(self):
        for block in blocks("client/gateway/README.md"):
            self.run_block(block)
        self.assertGreater((self.folder / "shorter.gcode").stat().st_size, 1000)

    def test_no_command_is_left_out(self):
        for guide in ("README.md", "client/README.md", "client/gateway/README.md", "server/README.md"):
            text = (SOURCE / guide).read_text(encoding="utf-8")
            for block in re.findall(r"(?ms)^```\n(.*?)^```", text):
                self.assertIsNone(re.search(r"(?m)^(build/release/|traverse |traverse-)", block), block)

    def test_of_the_pictures(self):
        subprocess.run([SOURCE / "client/pictures/draw.sh", self.folder, "--strategy=none"], check=True, timeout=300,
                       env={**os.environ, "TRAVERSE": str(BUILD / "client/traverse")})
        for picture in (SOURCE / "client/pictures").glob("*.svg"):
            self.assertTrue((self.folder / picture.name).exists(), picture.name)
            self.assertLess(picture.stat().st_size, 200_000)


if __name__ == "__main__":
    unittest.main()
