"""Generates the message classes from the project's .proto files; pyproject.toml has everything else."""

import pathlib
import re
import shutil
import subprocess

from setuptools import setup
from setuptools.command.build_py import build_py
from setuptools.command.sdist import sdist

HERE = pathlib.Path(__file__).resolve().parent
PROTOS = ("options", "plan", "route_optimizer_service", "gcode_service")


def api_folder():
    """Where traverse/v1/*.proto are: beside this file in an sdist, else in the source tree."""
    return HERE / "proto" if (HERE / "proto").is_dir() else HERE.parents[1] / "proto"


def version():
    """The server's version: one release has one number."""
    lists = HERE.parents[1] / "CMakeLists.txt"
    if (HERE / "PKG-INFO").exists():
        return re.search(r"^Version: (.+)$", (HERE / "PKG-INFO").read_text(), re.M).group(1)
    return re.search(r"project\(traverse VERSION ([\d.]+)", lists.read_text()).group(1)


def protoc():
    """The compiler's command with its plugin: Debian's, or the one of grpcio-tools."""
    plugin = shutil.which("grpc_python_plugin")
    if shutil.which("protoc") and plugin:
        return ["protoc", f"--plugin=protoc-gen-grpc={plugin}"], "grpc_out"
    import sys
    return [sys.executable, "-m", "grpc_tools.protoc"], "grpc_python_out"


def generate(target):
    """Writes the modules of the messages into the folder `target`, as parts of traverse_client.wire."""
    command, grpc_out = protoc()
    target.mkdir(parents=True, exist_ok=True)
    folders = (api_folder(), HERE / "src/traverse_client")
    names = [f"traverse/v1/{name}.proto" for name in PROTOS] + ["retry_info.proto"]
    subprocess.run(command + [f"-I{folder}" for folder in folders] +
                   [f"--python_out={target}", f"--pyi_out={target}", f"--{grpc_out}={target}"] + names, check=True)
    # The modules lie flat in the package, so that they meet no other package named `traverse`.
    for module in list(target.glob("traverse/v1/*")):
        module.rename(target / module.name)
    shutil.rmtree(target / "traverse")
    for module in target.glob("*.py*"):
        text = re.sub(r"^from traverse\.v1 import", "from traverse_client.wire import", module.read_text(), flags=re.M)
        module.write_text(text)
    (target / "__init__.py").write_text('"""Message classes, generated from the .proto files."""\n')


class BuildWithMessages(build_py):
    def run(self):
        generate(pathlib.Path(self.build_lib) / "traverse_client/wire")
        super().run()

    def find_package_modules(self, package, package_dir):
        return [] if package.endswith(".wire") else super().find_package_modules(package, package_dir)

    def get_package_dir(self, package):
        # The generated package has no folder in the sources.
        return super().get_package_dir("traverse_client" if package.endswith(".wire") else package)


class SourceWithProtos(sdist):
    def make_release_tree(self, base_dir, files):
        super().make_release_tree(base_dir, files)
        target = pathlib.Path(base_dir) / "proto/traverse/v1"
        target.mkdir(parents=True, exist_ok=True)
        for name in PROTOS:
            shutil.copy(api_folder() / f"traverse/v1/{name}.proto", target)


setup(version=version(), cmdclass={"build_py": BuildWithMessages, "sdist": SourceWithProtos})
