"""The Python client of client/python, for the tests themselves."""

import pathlib
import shutil
import sys
import tempfile

import support

support.module("grpc", "python3-grpcio")
support.module("setuptools", "python3-setuptools")

_built = tempfile.TemporaryDirectory(prefix="traverse-client-")


def load():
    """Makes the modules of the package and puts them on the path; skips without the tools."""
    for tool in ("protoc", "grpc_python_plugin"):
        if not shutil.which(tool):
            support.leave(f"no {tool}")
    work = pathlib.Path(_built.name)
    if not (work / "lib").exists():
        # In a copy, so that the sources stay as they are.
        shutil.copytree(support.SOURCE / "client/python", work / "client/python")
        shutil.copytree(support.SOURCE / "proto", work / "proto")
        shutil.copy(support.SOURCE / "CMakeLists.txt", work)
        support.run("/usr/bin/python3", "setup.py", "-q", "build", f"--build-lib={work / 'lib'}",
                    cwd=work / "client/python")
        sys.path.insert(0, str(work / "lib"))


def job(plate):
    """The OptimizeBatchRequest of `jobs.plate(...)`."""
    from google.protobuf import json_format
    from traverse_client import OptimizeBatchRequest
    return json_format.ParseDict(plate, OptimizeBatchRequest())


def optimize(client, request, deadline):
    """The results of all of `request`'s layers."""
    return client.optimize(list(request.layers), deadline, options=request.options)
