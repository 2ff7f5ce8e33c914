#!/usr/bin/python3
"""The upload hook: the upload is optimised or untouched, the original is kept, OctoPrint gets a file."""

import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import types
import unittest

import support

HOOK = support.DEPLOY / "examples/upload_hook/traverse_upload.py"

# Stands for the command line: says what is asked for by the first line of the file.
STAND_IN = """#!/bin/sh
# optimize INPUT -o OUTPUT --quiet ...
case "$(head -1 "$2")" in
  ";good") sed 's/^;good/;optimised/' "$2" >"$4" ;;
  ";refused") echo "refused.gcode:2: not what it says" >&2; exit 1 ;;
  ";unreachable") echo "server unreachable" >&2; exit 3 ;;
  ";slow") sleep 30 ;;
esac
"""


class UploadHook(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        (self.folder / "bin").mkdir()
        (self.folder / "uploads").mkdir()
        self.program = self.folder / "bin/traverse"
        self.program.write_text(STAND_IN)
        self.program.chmod(0o755)
        self.originals = self.folder / "originals"

    def upload(self, first_line, name="part.gcode"):
        path = self.folder / "uploads" / name
        path.write_text(f"{first_line}\nG1 X1 Y1 E1\n")
        return path

    def run_hook(self, *words):
        return subprocess.run([sys.executable, "-B", HOOK, *map(str, words), "--originals", self.originals,
                               "--program", self.program], capture_output=True, text=True, check=False, timeout=60)

    def kept(self):
        return sorted(path.name for path in self.originals.glob("*")) if self.originals.exists() else []

    def test_the_upload_is_replaced_and_the_original_kept(self):
        path = self.upload(";good")
        path.chmod(0o640)

        self.assertEqual(0, self.run_hook(path).returncode)

        self.assertEqual(";optimised\nG1 X1 Y1 E1\n", path.read_text())
        self.assertEqual(0o640, path.stat().st_mode & 0o777)
        self.assertEqual(";good\nG1 X1 Y1 E1\n", (self.originals / "part.gcode").read_text())
        self.assertEqual(["part.gcode", "part.gcode.json"], self.kept())
        self.assertEqual(["part.gcode"], [entry.name for entry in path.parent.iterdir()])

    def test_a_result_is_not_optimised_again(self):
        path = self.upload(";good")
        self.run_hook(path)

        self.assertEqual(1, self.run_hook(path).returncode)

        self.assertEqual(";good\nG1 X1 Y1 E1\n", (self.originals / "part.gcode").read_text())

    def test_the_upload_stays_untouched_and_the_reason_is_logged(self):
        for first_line, reason in ((";refused", "not what it says"), (";unreachable", "server unreachable"),
                                   (";slow", "not done within")):
            with self.subTest(first_line):
                path = self.upload(first_line)
                before = (path.read_bytes(), path.stat().st_mtime_ns)

                done = self.run_hook(path, "--timeout=1")

                self.assertEqual(1, done.returncode)
                self.assertEqual(before, (path.read_bytes(), path.stat().st_mtime_ns))
                self.assertIn("part.gcode stays as uploaded: ", done.stderr)
                self.assertIn(reason, done.stderr)
                self.assertEqual([], self.kept())

    def test_without_the_program_the_upload_stays(self):
        path = self.upload(";good")
        self.program.unlink()

        self.assertEqual(1, self.run_hook(path).returncode)
        self.assertTrue(path.read_text().startswith(";good"))

    def test_a_watched_folder_is_served_and_what_was_there_is_left_alone(self):
        old = self.upload(";good", "old.gcode")
        uploads = old.parent
        command = [sys.executable, "-B", HOOK, f"--watch={uploads}", f"--originals={self.originals}",
                   f"--program={self.program}", "--interval=0.1"]
        with support.Process(*command) as watcher:
            support.wait_for(lambda: "watching" in watcher.output(), "the folder is watched", 60)
            new = self.upload(";good", "new.gcode")
            other = self.upload(";good", "notes.txt")
            support.wait_for(lambda: new.read_text().startswith(";optimised"), "the new file is optimised", 60)
            time.sleep(0.5)
        self.assertTrue(old.read_text().startswith(";good"))
        self.assertTrue(other.read_text().startswith(";good"))
        self.assertEqual(["new.gcode", "new.gcode.json"], self.kept())

    def test_containers_of_gcode_are_served_and_projects_are_not(self):
        specification = importlib.util.spec_from_file_location("traverse_upload", HOOK)
        hook = importlib.util.module_from_spec(specification)
        specification.loader.exec_module(hook)
        for name in ("part.bgcode", "plates.gcode.3mf", "part.ufp", "PART.GCODE"):
            self.assertEqual([self.upload(";good", name)], hook.candidates(self.folder / "uploads"))
            self.assertTrue(hook.process(self.upload(";good", name), self.originals, program=str(self.program)))
            self.assertTrue((self.folder / "uploads" / name).read_text().startswith(";optimised"), name)
            (self.folder / "uploads" / name).unlink()
        self.upload(";good", "project.3mf")
        self.assertEqual([], hook.candidates(self.folder / "uploads"))

    def test_originals_below_the_watched_folder_are_refused(self):
        done = self.run_hook(f"--watch={self.folder}")
        self.assertEqual(2, done.returncode)

    def test_the_plugin_of_octoprint_returns_a_file_in_any_case(self):
        wrapper = self.octoprint_wrapper()
        specification = importlib.util.spec_from_file_location("traverse_upload", HOOK)
        hook = importlib.util.module_from_spec(specification)
        specification.loader.exec_module(hook)
        self.addCleanup(os.environ.__setitem__, "PATH", os.environ["PATH"])
        os.environ.update(PATH=f"{self.program.parent}:{os.environ['PATH']}", TRAVERSE_ORIGINALS=str(self.originals))
        preprocess = hook.__plugin_hooks__["octoprint.filemanager.preprocessor"]
        for first_line, expected in ((";good", ";optimised"), (";refused", ";refused")):
            upload = self.upload(first_line)
            result = preprocess("part.gcode", wrapper("part.gcode", str(upload)), links=None, printer_profile=None)
            self.assertEqual("part.gcode", result.filename)
            self.assertTrue(pathlib.Path(result.path).read_text().startswith(expected))
            os.unlink(result.path)
        self.assertEqual(["part.gcode", "part.gcode.json"], self.kept())
        other = wrapper("picture.png", str(self.upload(";good")))
        self.assertIs(other, preprocess("picture.png", other))

    def octoprint_wrapper(self):
        """A stand-in for the class of OctoPrint that the plugin meets."""
        class DiskFileWrapper:
            def __init__(self, filename, path, move=True):
                self.filename, self.path, self.move = filename, path, move

            def stream(self):
                return open(self.path, "rb")

        for name in ("octoprint", "octoprint.filemanager", "octoprint.filemanager.util"):
            sys.modules[name] = types.ModuleType(name)
        sys.modules["octoprint"].filemanager = sys.modules["octoprint.filemanager"]
        sys.modules["octoprint.filemanager"].util = sys.modules["octoprint.filemanager.util"]
        sys.modules["octoprint.filemanager.util"].DiskFileWrapper = DiskFileWrapper
        return DiskFileWrapper


if __name__ == "__main__":
    support.main()
