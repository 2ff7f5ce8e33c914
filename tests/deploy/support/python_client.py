"""The Python client of client/python, for the tests themselves."""

import pathlib
import shutil
import sys
import tempfile

import support

support.module("grpc", "python3-grpcio")
support.module("setuptools", "python3-setuptools")
support.module("wheel", "python3-wheel")

_built = tempfile.TemporaryDirectory(prefix="traverse-client-")


def load():
    """Builds the package and puts it on the path of modules; skips without the tools."""
    for tool in ("protoc", "grpc_python_plugin"):
        if not shutil.which(tool):
            support.leave(f"no {tool}")
    wheels = list(pathlib.Path(_built.name).glob("*.whl"))
    if not wheels:
        support.run(support.SOURCE / "client/python/build.sh", _built.name)
        wheels = list(pathlib.Path(_built.name).glob("*.whl"))
        sys.path.insert(0, str(wheels[0]))


def job(plate):
    """The OptimizeBatchRequest of `jobs.plate(...)`."""
    from google.protobuf import json_format
    from traverse_client import OptimizeBatchRequest
    return json_format.ParseDict(plate, OptimizeBatchRequest())


def optimize(client, request, deadline):
    """The results of all of `request`'s layers."""
    return client.optimize(list(request.layers), deadline, options=request.options)
