#!/usr/bin/python3
"""The Node example against a real server, and against one that refuses and breaks off."""

import pathlib
import shutil
import tempfile
import unittest

import support
from support import example_cases


class NodeExample(example_cases.ExampleCases, unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.work = tempfile.TemporaryDirectory()
        # The same depth below the root as in the source, for the example finds the .proto files so.
        folder = pathlib.Path(cls.work.name) / "deploy/examples/node"
        shutil.copytree(support.DEPLOY / "examples/node", folder, ignore=shutil.ignore_patterns("node_modules"))
        for name in ("proto", "server"):
            (pathlib.Path(cls.work.name) / name).symlink_to(support.SOURCE / name)
        support.install_node_packages(folder)
        example_cases.generate()
        cls.command = ("node", folder / "submit_job.mjs")

    @classmethod
    def tearDownClass(cls):
        cls.work.cleanup()


if __name__ == "__main__":
    support.main("node", "npm", "protoc", "grpc_python_plugin")
