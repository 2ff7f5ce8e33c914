#!/usr/bin/python3
"""buf on the API: it is well-formed, breaks nothing, generates code, and answers a client that is not ours."""

import json
import os
import pathlib
import shutil
import tempfile
import unittest

import support

PROTO = support.SOURCE / "proto"


class Api(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        cls.program, missing = support.node_packages.install_buf(cls.folder)
        if missing:
            raise unittest.SkipTest(missing)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def buf(self, *words, **options):
        environment = {**os.environ, "BUF_CACHE_DIR": str(self.folder / "cache")}
        return support.run(self.program, *words, env=environment, **options)

    def copy_with(self, old, new):
        """The API with a change, in a folder of its own."""
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        shutil.copytree(PROTO, folder / "proto")
        options = folder / "proto/traverse/v1/options.proto"
        self.assertIn(old, options.read_text())
        options.write_text(options.read_text().replace(old, new))
        return folder / "proto"

    def test_follows_the_default_rules(self):
        self.buf("lint", PROTO)

        wrong = self.copy_with("message Cleaning {", "message cleaning_rule {")
        self.assertNotEqual(0, self.buf("lint", wrong, ok=False).returncode)

    def test_breaks_nothing_since_the_last_release(self):
        released = support.run("git", "-C", support.SOURCE, "describe", "--tags", "--abbrev=0", ok=False)
        if released.returncode != 0:
            self.skipTest("no release yet")
        old = self.folder / "released"
        old.mkdir()
        support.run("sh", "-c", f"git -C {support.SOURCE} archive {released.stdout.strip()} proto | tar -x -C {old}")
        self.buf("breaking", PROTO, "--against", old / "proto")

    def test_a_removed_or_retyped_field_is_noticed_and_a_new_one_is_fine(self):
        for old, new, code in (("  ResultOrder result_order = 11;\n", "", 100),
                               ("string job_id = 1;", "bytes job_id = 1;", 100),
                               ("  bool look_ahead = 12;\n", "  bool look_ahead = 12;\n  string note = 99;\n", 0)):
            done = self.buf("breaking", self.copy_with(old, new), "--against", PROTO, ok=False)
            self.assertEqual(code, done.returncode, done.stdout + done.stderr)

    def test_calls_a_server_that_it_knows_by_reflection_alone(self):
        job = {"layers": [{"id": 1, "islands": [{"contours": [{"points": [40, 40, 60, 40, 60, 60, 40, 60]}],
                                                 "rasters": [{"points": [45, 45, 55, 45]}]}]}]}
        with support.Server() as server:
            done = self.buf("curl", "--protocol", "grpc", "--http2-prior-knowledge", "-d", json.dumps(job),
                            f"http://{server.address}/traverse.v1.RouteOptimizerService/OptimizeBatch")
        self.assertIn('"visits"', done.stdout)
        self.assertIn('"summary"', done.stdout)


if __name__ == "__main__":
    support.main("node", "npm")
