#!/usr/bin/python3
"""The commands of deploy/README.md do what the guide says, word for word, in a copy of the source.

Here those that need neither images nor root; image_test, compose_test and package_test run the others.
"""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import support

README = (support.DEPLOY / "README.md").read_text()


def block(word):
    """The commands of the one code block that has `word`."""
    found = [text for text in re.findall(r"(?ms)^```\n(.*?)^```", README) if word in text]
    if len(found) != 1:
        raise AssertionError(f"{len(found)} blocks with {word}")
    return found[0]


class Readme(unittest.TestCase):

    def setUp(self):
        build = pathlib.Path(os.environ.get("TRAVERSE_BUILD", ""))
        if not (build / "client/traverse").exists():
            self.skipTest("TRAVERSE_BUILD does not name a build")
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        shutil.copytree(support.DEPLOY / "examples", self.folder / "deploy/examples",
                        ignore=shutil.ignore_patterns("node_modules", "generated", "__pycache__"))
        (self.folder / "build").mkdir()
        (self.folder / "build/release").symlink_to(build)
        self.path = f"{build / 'client'}:/usr/bin:{os.environ['PATH']}"

    def run_block(self, text, **variables):
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=self.folder, capture_output=True, text=True,
                              check=False, timeout=300, env={**os.environ, "PATH": self.path, **variables})
        self.assertEqual(0, done.returncode, f"{text}\n{done.stdout}{done.stderr}")
        return done.stdout

    def test_what_the_guide_names_is_there(self):
        names = set(re.findall(r"(?<![\w/-])(?:deploy|tests|server)/[\w/.-]*\w", README)) | {
            f"deploy/{name}" for name in re.findall(r"[`(](monitoring/[\w/.-]*\w|examples/[\w/.-]*\w|\w+\.md)", README)}
        self.assertGreater(len(names), 20)
        for name in sorted(names):
            with self.subTest(name):
                self.assertTrue((support.SOURCE / name).exists())
        programs = [name for name in names if re.search(r"\.(sh|py)$", name)]
        for name in programs:
            if (support.SOURCE / name).read_text().startswith("#!"):
                self.assertTrue(os.access(support.SOURCE / name, os.X_OK), f"{name} is not executable")

    def test_upload_hook(self):
        sample = support.DEPLOY / "samples/clusters13.gcode"
        shutil.copy(sample, self.folder / "part.gcode")
        self.run_block(block("--originals kept"))

        kept = [path for path in (self.folder / "kept").rglob("*") if path.is_file()]
        self.assertTrue(any(path.read_bytes() == sample.read_bytes() for path in kept))
        self.assertNotEqual(sample.read_bytes(), (self.folder / "part.gcode").read_bytes())
        support.run(self.folder / "build/release/client/traverse", "verify", sample, self.folder / "part.gcode")

    def test_quickstart_compares_on_a_machine_that_is_busy(self):
        # Stopped for longer than the comparison grants to a strategy, as if others had the processor.
        program = self.folder / "build/release/client/traverse"
        with support.Process(program, "compare", support.DEPLOY / "samples/part2.damat") as compare:
            time.sleep(0.5)
            compare.popen.send_signal(signal.SIGSTOP)
            time.sleep(6)
            compare.popen.send_signal(signal.SIGCONT)
            self.assertEqual(0, compare.popen.wait(200), compare.output())

    def test_install(self):
        root = self.folder / "root"
        self.run_block(block("cmake --install"), DESTDIR=str(root))

        for name in ("traverse", "traverse-server", "traverse-health-probe", "traverse-loadgen"):
            support.run(root / "usr/bin" / name, "--version")
        documented = re.search(r"Documentation=file://(\S+)", (root / "lib/systemd/system/traverse-server.service").read_text())[1]
        self.assertTrue((root / documented.lstrip("/")).exists())
        self.assertTrue((root / "etc/traverse/server.flags").exists())
        support.run(root / "usr/share/traverse-server/monitoring/render_dashboard.py", "--help")


if __name__ == "__main__":
    support.main()
