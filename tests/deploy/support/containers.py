"""Podman and Buildah without a daemon, in a store of their own below the build folder.

Works where there is neither systemd nor a Docker engine: runc, cgroupfs, and file system isolation for builds.
Where no registry can be reached the base images are made of Debian's packages, under the same names.
"""

import json
import os
import pathlib
import shutil
import tempfile
import unittest

import support

CONFIG = """[containers]
default_ulimits = ["nofile=1024:1024", "nproc=1024:1024"]
[engine]
cgroup_manager = "cgroupfs"
runtime = "runc"
events_logger = "file"
"""

BASE = "docker.io/library/debian:bookworm-slim"


def wanted():
    """Skips unless asked for: these tests compile the project once more and load base systems."""
    if os.environ.get("TRAVERSE_TEST_IMAGES") != "1":
        support.leave("takes minutes; run it with TRAVERSE_TEST_IMAGES=1")


class Store:
    """Images and containers of the tests. Reused by later runs, so that a second build is quick."""

    def __init__(self):
        if os.geteuid() != 0:
            raise unittest.SkipTest("not root")
        self.folder = pathlib.Path(os.environ.get("TRAVERSE_BUILD", tempfile.gettempdir())) / "containers"
        self.folder.mkdir(exist_ok=True)
        config = self.folder / "containers.conf"
        config.write_text(CONFIG)
        self.environment = {**os.environ, "CONTAINERS_CONF": str(config)}
        self.options = ["--root", self.folder / "store", "--runroot", self.folder / "run", "--storage-driver", "overlay"]

    def podman(self, *words, **options):
        return support.run("podman", *self.options, *words, env=self.environment, **options)

    def buildah(self, *words, **options):
        return support.run("buildah", *self.options, *words, env=self.environment, **options)

    def has(self, image):
        return self.podman("image", "exists", image, ok=False).returncode == 0

    def provide_base(self):
        """Sees that the base image is there: from its registry, else made of Debian's packages."""
        if self.has(BASE) or self.podman("pull", "-q", BASE, ok=False).returncode == 0:
            return
        if not shutil.which("mmdebstrap"):
            raise unittest.SkipTest(f"{BASE} can be neither pulled nor made (no mmdebstrap)")
        archive = self.folder / "base.tar"
        done = support.run(
            "mmdebstrap", "--variant=minbase", "--include=ca-certificates",
            "--dpkgopt=path-exclude=/usr/share/man/*", "--dpkgopt=path-exclude=/usr/share/doc/*",
            "--dpkgopt=path-include=/usr/share/doc/*/copyright",
            '--customize-hook=rm -rf "$1"/var/lib/apt/lists/*', "bookworm", archive, ok=False)
        if done.returncode != 0:
            raise unittest.SkipTest(f"{BASE} can be neither pulled nor made: {done.stderr[-500:]}")
        self.podman("import", archive, BASE)
        archive.unlink()

    def provide(self, image, package, entrypoint):
        """Sees that an image is there: from its registry, else Debian's package on the base image."""
        if self.has(image) or self.podman("pull", "-q", image, ok=False).returncode == 0:
            return
        self.provide_base()
        recipe = self.folder / "Dockerfile"
        recipe.write_text(f"FROM {BASE}\nRUN apt-get update -qq && apt-get install -y -qq --no-install-recommends {package}\n"
                          f"ENTRYPOINT {json.dumps(entrypoint)}\n")
        self.buildah("bud", "--isolation", "chroot", "--pull-never", "-f", recipe, "-t", image, self.folder / "run")

    def build_server(self, tag):
        """Builds deploy/Dockerfile; returns what Buildah said."""
        self.provide_base()
        return self.buildah("bud", "--isolation", "chroot", "--pull-never", "--layers", "--format", "docker",
                            "--ignorefile", support.DEPLOY / "Dockerfile.dockerignore",
                            "-f", support.DEPLOY / "Dockerfile", "-t", tag, support.SOURCE).stdout
