#!/usr/bin/python3
"""The Python example against a real server, and against one that refuses and breaks off."""

import pathlib
import shutil
import tempfile
import unittest

import support
from support import example_cases


class PythonExample(example_cases.ExampleCases, unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.work = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.work.name)
        for name in ("submit_job.py", "traverse_client.py"):
            shutil.copy(support.DEPLOY / "examples/python" / name, folder)
        example_cases.generate()
        (folder / "generated").symlink_to(example_cases.generated.name)
        cls.command = ("/usr/bin/python3", "-B", folder / "submit_job.py")

    @classmethod
    def tearDownClass(cls):
        cls.work.cleanup()


if __name__ == "__main__":
    support.main("protoc", "grpc_python_plugin")
