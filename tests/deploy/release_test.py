#!/usr/bin/python3
"""What deploy/release.sh makes: all of it, twice the same, from what is really linked; one number everywhere."""

import datetime
import hashlib
import io
import json
import os
import pathlib
import re
import subprocess
import tarfile
import tempfile
import unittest

import support

VERSION = re.search(r"project\(traverse VERSION (\S+)", (support.SOURCE / "CMakeLists.txt").read_text())[1]
PROGRAMS = ["client/traverse", "client/loadgen/traverse-loadgen", "server/traverse-server", "client/gateway/traverse-gateway",
            "deploy/traverse-health-probe"]


def text(name):
    return (support.SOURCE / name).read_text(encoding="utf-8")


class Numbers(unittest.TestCase):

    def test_one_release_has_one_number(self):
        for name, pattern in (("CITATION.cff", r"(?m)^version: (\S+)"), ("client/node/package.json", r'"version": "([^"]+)"'),
                              ("deploy/Dockerfile", r"ARG VERSION=(\S+)"), ("deploy/Dockerfile", r"traverse-\w+:(\d[\d.]+)"),
                              ("deploy/compose.yaml", r"traverse-\w+:(\d[\d.]+)"),
                              ("deploy/kubernetes/base/kustomization.yaml", r"newTag: (\S+)"),
                              ("deploy/kubernetes/components/gateway/kustomization.yaml", r"newTag: (\S+)"),
                              ("deploy/examples/upload_hook/traverse_upload.py", r'__plugin_version__ = "([^"]+)"'),
                              ("deploy/debian/changelog", r"\Atraverse \(([^)]+)\)")):
            with self.subTest(name):
                self.assertEqual({VERSION}, set(re.findall(pattern, text(name))))

    def test_the_changelogs_have_the_release_under_one_date(self):
        sections = re.findall(r"(?m)^## (.*)$", text("CHANGELOG.md"))
        if sections[0] == "Unreleased":
            sections.pop(0)
        number, date = sections[0].split(" - ")
        self.assertEqual(VERSION, number)
        debian = re.search(r"(?m)^ -- .*>  (.*)$", text("deploy/debian/changelog"))[1]
        self.assertEqual(datetime.date.fromisoformat(date),
                         datetime.datetime.strptime(debian, "%a, %d %b %Y %H:%M:%S %z").date())


class Release(unittest.TestCase):
    """Of the build that is there: packed twice. That compiling gives the same twice is GCC's and the linker's promise."""

    @classmethod
    def setUpClass(cls):
        if os.environ.get("TRAVERSE_TEST_IMAGES") != "1":
            raise unittest.SkipTest("packing twice takes minutes; run it with TRAVERSE_TEST_IMAGES=1")
        cls.build = pathlib.Path(os.environ.get("TRAVERSE_BUILD", ""))
        if not all((cls.build / f"{program}.map").exists() for program in PROGRAMS):
            raise unittest.SkipTest("TRAVERSE_BUILD does not name a build with its linker's maps")
        cls.scratch = tempfile.TemporaryDirectory(prefix="traverse-release-")
        folder = pathlib.Path(cls.scratch.name)
        cls.first, cls.second = folder / "first", folder / "second"
        cls.pack(cls.first)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @classmethod
    def pack(cls, out):
        # Without git, as in an archive of the sources, the date comes from outside.
        more = dict(os.environ, SOURCE_DATE_EPOCH="1700000000", CCACHE_DISABLE="1")
        return support.run(support.DEPLOY / "release.sh", out, cls.build, env=more).stdout

    def rows(self):
        lines = (self.first / "linked.tsv").read_text().splitlines()
        return [dict(zip(lines[0].split("\t"), line.split("\t"))) for line in lines[1:]]

    def test_all_of_it_is_there_with_its_sums(self):
        sums = dict(reversed(line.split("  ")) for line in (self.first / "SHA256SUMS").read_text().splitlines())
        self.assertEqual({path.name for path in self.first.iterdir()} - {"SHA256SUMS"}, set(sums))
        for name, digest in sums.items():
            self.assertEqual(hashlib.sha256((self.first / name).read_bytes()).hexdigest(), digest, name)
        for pattern in ("traverse_*_*.deb", "traverse-server_*_*.deb", "traverse_client-*.whl", "traverse-client-*.tar.gz",
                        "traverse-client-*.tgz", "traverse-server_*.image.tar.gz", "traverse-gateway_*.image.tar.gz",
                        "linked.tsv", "revision.txt"):
            self.assertEqual(1, len(list(self.first.glob(pattern))), pattern)

    def test_twice_in_a_row_the_same_bytes(self):
        self.pack(self.second)
        self.assertEqual((self.first / "SHA256SUMS").read_text(), (self.second / "SHA256SUMS").read_text())

    def test_the_list_has_what_the_loader_loads_and_the_linker_took(self):
        rows = self.rows()
        for row in rows:
            self.assertTrue(row["version"] and row["licence"] and row["programs"], row)
        of = {(how, program.rsplit("/", 1)[1]): {row["package"] for row in rows
                                                 if row["how"] == how and program.rsplit("/", 1)[1] in row["programs"].split()}
              for how in ("library", "archive") for program in PROGRAMS}
        for program in PROGRAMS:
            name = program.rsplit("/", 1)[1]
            self.assertTrue({"libc6", "libstdc++6", "libssl3"} <= of["library", name], name)
            loaded = len(re.findall(r"(?m)=> /|^\t/", support.run("ldd", self.build / program).stdout))
            self.assertLessEqual(len(of["library", name]), loaded)
        self.assertIn("libcurl4", of["library", "traverse-gateway"])
        self.assertNotIn("libcurl4", of["library", "traverse-server"])
        if of["archive", "traverse-server"]:  # there were archives
            self.assertIn("coinor-libcbc-dev", of["archive", "traverse-server"])
            self.assertNotIn("coinor-libcbc-dev", of["archive", "traverse-health-probe"])
        self.assertIn("libboost1.74-dev", {row["package"] for row in rows if row["how"] == "headers"})

    def test_no_program_names_the_folder_in_which_it_was_made(self):
        for program in PROGRAMS:
            self.assertNotIn(f"{support.SOURCE}/".encode(), (self.build / program).read_bytes(), program)

    def test_the_images_are_whole_and_their_programs_run(self):
        for program, port in (("traverse-server", "50051/tcp"), ("traverse-gateway", "8080/tcp")):
            path, = self.first.glob(f"{program}_*.image.tar.gz")
            with tarfile.open(path) as outer:
                manifest, = json.load(outer.extractfile("manifest.json"))
                config = outer.extractfile(manifest["Config"]).read()
                layer = outer.extractfile(manifest["Layers"][0]).read()
            self.assertEqual([f"docker.io/library/{program}:{VERSION}"], manifest["RepoTags"])
            self.assertEqual(hashlib.sha256(config).hexdigest() + ".json", manifest["Config"])
            image = json.loads(config)
            self.assertEqual([f"sha256:{hashlib.sha256(layer).hexdigest()}"], image["rootfs"]["diff_ids"])
            about = image["config"]
            self.assertEqual(("65532:65532", [f"/usr/bin/{program}"]), (about["User"], about["Entrypoint"]))
            self.assertIn(port, about["ExposedPorts"])
            self.assertEqual("/usr/bin/traverse-health-probe", about["Healthcheck"]["Test"][1])
            self.assertEqual(VERSION, about["Labels"]["org.opencontainers.image.version"])
            self.runs_alone(program, layer)

    def runs_alone(self, program, layer):
        """By the image's own loader, with nothing but the image's libraries."""
        with tempfile.TemporaryDirectory() as root:
            with tarfile.open(fileobj=io.BytesIO(layer)) as tar:
                self.assertEqual({(0, 0)}, {(member.uid, member.gid) for member in tar})
                self.assertFalse([name for name in tar.getnames() if name.endswith(("/sh", "/bash", "/dpkg"))])
                tar.extractall(root)
            packages = pathlib.Path(root, "usr/share/doc/traverse-server/packages.txt").read_text()
            self.assertRegex(packages, r"(?m)^libgrpc")
            loader, = pathlib.Path(root).glob("lib64/ld-linux-*")
            folders = ":".join(sorted({str(path.parent) for path in pathlib.Path(root).rglob("*.so*")}))
            done = subprocess.run([loader, "--inhibit-cache", "--library-path", folders, f"{root}/usr/bin/{program}", "--version"],
                                  capture_output=True, text=True, check=False)
            self.assertIn(VERSION, done.stdout, done.stderr)


if __name__ == "__main__":
    support.main()
