#!/usr/bin/python3
"""The Debian packages: made, installed on a clean root, run as their own user there, removed."""

import os
import pathlib
import shutil
import tempfile
import unittest

import support

UNIT = support.DEPLOY / "systemd/traverse-server.service"


class Unit(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.unit = pathlib.Path(self.folder.name) / UNIT.name
        # The check wants the program at its place.
        self.unit.write_text(UNIT.read_text().replace("/usr/bin/traverse-server", support.binary("TRAVERSE_SERVER")))

    def tearDown(self):
        self.folder.cleanup()

    def test_systemd_accepts_the_unit_and_notices_a_wrong_one(self):
        if not shutil.which("systemd-analyze"):
            self.skipTest("no systemd-analyze")
        done = support.run("systemd-analyze", "verify", self.unit)
        self.assertEqual("", done.stderr)
        self.unit.write_text(self.unit.read_text().replace("NoNewPrivileges=yes", "NoNewPriviledges=yes"))
        self.assertIn("NoNewPriviledges", support.run("systemd-analyze", "verify", self.unit, ok=False).stderr)

    def test_the_unit_is_hardened(self):
        if not shutil.which("systemd-analyze"):
            self.skipTest("no systemd-analyze")
        done = support.run("systemd-analyze", "security", "--offline=yes", "--threshold=20", self.unit)
        self.assertIn("OK", done.stdout)

    def test_the_unit_waits_longer_than_the_server_drains(self):
        flags = (support.DEPLOY / "systemd/server.flags").read_text()
        drain = int(flags.split("--drain_timeout=")[1].split("s")[0])
        stop = int(UNIT.read_text().split("TimeoutStopSec=")[1].split("\n")[0])
        self.assertGreaterEqual(stop, drain + 10)

    def test_the_server_takes_the_flags_of_the_unit(self):
        # Flags after the file win, so that the test needs no fixed port.
        port, metrics = support.free_port(), support.free_port()
        with support.Process(support.binary("TRAVERSE_SERVER"), f"--flagfile={support.DEPLOY / 'systemd/server.flags'}",
                             f"--listen=127.0.0.1:{port}", f"--metrics_listen=127.0.0.1:{metrics}") as server:
            support.wait_for(lambda: support.http(f"http://127.0.0.1:{metrics}/readyz")[0] == 200, "ready")
            self.assertEqual(0, server.terminate())


class Packages(unittest.TestCase):
    """One clean root for all cases, made by mmdebstrap from Debian's archive."""

    @classmethod
    def setUpClass(cls):
        for tool in ("mmdebstrap", "cpack", "dpkg-deb"):
            if not shutil.which(tool):
                raise unittest.SkipTest(f"no {tool}")
        if os.environ.get("TRAVERSE_TEST_IMAGES") != "1":
            raise unittest.SkipTest("a clean root takes minutes; run it with TRAVERSE_TEST_IMAGES=1")
        if os.geteuid() != 0:
            raise unittest.SkipTest("not root")
        config = pathlib.Path(os.environ.get("TRAVERSE_BUILD", "")) / "CPackConfig.cmake"
        if not config.exists():
            raise unittest.SkipTest("TRAVERSE_BUILD does not name a build")
        cls.scratch = tempfile.TemporaryDirectory(prefix="traverse-package-")
        cls.folder = pathlib.Path(cls.scratch.name)
        support.run("cpack", "--config", config, "-B", cls.folder / "packages")
        cls.packages = sorted((cls.folder / "packages").glob("*.deb"))
        cls.root = cls.folder / "root"
        done = support.run("mmdebstrap", "--variant=minbase", "bookworm", cls.root, ok=False)
        if done.returncode != 0:
            print(done.stderr[-2000:])
            raise unittest.SkipTest("mmdebstrap could not make a root here")
        for package in cls.packages:
            shutil.copy(package, cls.root / "tmp")

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def inside(self, *command, ok=True):
        environment = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "DEBIAN_FRONTEND": "noninteractive", "HOME": "/root"}
        return support.run("chroot", self.root, *command, ok=ok, env=environment)

    def test_install_run_remove(self):
        names = [f"/tmp/{package.name}" for package in self.packages]
        self.assertEqual(2, len(names))
        self.inside("apt-get", "update", "-qq")
        self.inside("apt-get", "install", "-y", "-qq", "--no-install-recommends", *names)

        self.assertIn("traverse-server ", self.inside("traverse-server", "--version").stdout)
        self.serve_as_its_user()
        enabled = self.root / "etc/systemd/system/multi-user.target.wants/traverse-server.service"
        self.assertTrue(enabled.is_symlink(), "not started at boot")

        # What the operator changed stays; a purge leaves no file behind.
        flags = self.root / "etc/traverse/server.flags"
        flags.write_text(flags.read_text() + "# changed\n")
        self.inside("apt-get", "remove", "-y", "-qq", "traverse-server")
        self.assertTrue(flags.exists())
        self.assertFalse((self.root / "usr/bin/traverse-server").exists())
        self.inside("apt-get", "purge", "-y", "-qq", "traverse-server", "traverse")
        self.assertFalse(flags.exists())
        self.assertFalse(enabled.is_symlink())

    def serve_as_its_user(self):
        port, metrics = support.free_port(), support.free_port()
        command = ["chroot", "--userspec=traverse:traverse", self.root, "/usr/bin/traverse-server",
                   "--flagfile=/etc/traverse/server.flags", f"--listen=127.0.0.1:{port}",
                   f"--metrics_listen=127.0.0.1:{metrics}"]
        with support.Process(*command) as server:
            support.wait_for(lambda: support.http(f"http://127.0.0.1:{metrics}/readyz")[0] == 200, "ready in the root")
            self.inside("traverse-health-probe", f"--address=127.0.0.1:{port}")
            self.assertEqual(0, server.terminate())


if __name__ == "__main__":
    support.main()
