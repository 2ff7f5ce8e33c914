"""Files as they are traded, through the built command: .bgcode, .gcode.3mf, .ufp.

What the command writes is read by means of its own: zipfile, and a decoder of binary G-code in a few lines (bgcode.py).
"""
import functools
import hashlib
import json
import lzma
import os
import re
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import warnings
import zipfile
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))
TESTS = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, HERE)
import bgcode  # noqa: E402

TRAVERSE = os.environ["TRAVERSE"]
SLICED = os.path.join(TESTS, "data", "gcode", "ps_hooks_support_bridge.gcode.xz")
DONE, INPUT, USAGE = 0, 1, 2
with open(TRAVERSE, "rb") as binary:
    SANITIZED = b"__asan_init" in binary.read()  # takes all addresses there are

METADATA = {
    "file": "Producer=PrusaSlicer 2.8.1\nProduced on=2024-10-21 at 06:38:01 UTC\n",
    "printer": "printer_model=MK4\nestimated printing time (normal mode)=1h 0m 0s\n",
    "print": "filament used [mm]=252.22\nestimated printing time (normal mode)=1h 0m 0s\n"
             "estimated first layer printing time (normal mode)=1m 40s\n",
    "slicer": "layer_height=0.2\nend_gcode=G4 ; wait\\nM107\n",
}

SLICE_INFO = """<?xml version="1.0" encoding="UTF-8"?>
<config>
  <plate>
    <metadata key="index" value="1"/>
    <metadata key="prediction" value="3600"/>
  </plate>
  <plate>
    <metadata key="index" value="2"/>
    <metadata key="prediction" value="3600"/>
  </plate>
</config>
"""


def read(name):
    with open(name, "rb") as file:
        return file.read()


@functools.cache
def sliced(layers=3):
    """A few layers of the bundled plate, with progress."""
    text = lzma.decompress(read(SLICED)).decode()
    marks = [match.start() for match in re.finditer("(?m)^;LAYER_CHANGE", text)]
    foot = text[text.rindex(";TYPE:Custom"):] if text.count(";TYPE:Custom") > 1 else "M107\n"
    lines = text[:marks[layers]].splitlines(keepends=True)
    return "".join(lines) + "M73 P50 R30\n" + foot


def commands(text):
    """What a printer reads: no comments, no spaces in moves."""
    out = []
    for line in text.splitlines():
        line = line.split(";")[0].strip()
        if line:
            out.append(line.replace(" ", "") if re.match(r"G\d", line) else line)
    return out


def little_memory():
    resource.setrlimit(resource.RLIMIT_DATA, (1 << 30, 1 << 30))


class Containers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def put(self, name, content):
        with open(self.path(name), "wb") as file:
            file.write(content.encode() if isinstance(content, str) else content)
        return self.path(name)

    def run_traverse(self, *arguments, **kw):
        done = subprocess.run([TRAVERSE, *arguments], capture_output=True, timeout=300, check=False,
                              stdin=kw.pop("stdin", subprocess.DEVNULL), **kw)
        return done.returncode, done.stdout, done.stderr.decode()

    def succeed(self, *arguments, **kw):
        code, out, err = self.run_traverse(*arguments, **kw)
        self.assertEqual(DONE, code, err)
        return out.decode()

    def optimize(self, *arguments):
        """By a quick strategy: this is about files."""
        return self.succeed("optimize", *arguments, "--strategy=ni2opt")

    def fail_with(self, code, *arguments, **kw):
        got, out, err = self.run_traverse(*arguments, **kw)
        self.assertEqual((code, b""), (got, out), err)
        self.assertEqual(1, err.count("\n"), err)
        return err.rstrip("\n")

    def put_bgcode(self, name="part.bgcode", **kw):
        return self.put(name, bgcode.encode(sliced(), METADATA, [(2, 16, 16, b"qoif picture")], **kw))

    def put_3mf(self, name="plates.gcode.3mf", md5=str.upper, end="", plates=(1, 2), **kw):
        path = self.path(name)
        text = sliced()
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("[Content_Types].xml", "<Types/>")
            for plate in plates:
                archive.writestr(f"Metadata/plate_{plate}.gcode", text)
                archive.writestr(f"Metadata/plate_{plate}.gcode.md5",
                                 md5(hashlib.md5(text.encode()).hexdigest()) + end, zipfile.ZIP_STORED)
                archive.writestr(f"Metadata/plate_{plate}.png", b"picture %d" % plate, zipfile.ZIP_STORED)
            archive.writestr("Metadata/slice_info.config", kw.get("info", SLICE_INFO))
        return path


class Bgcode(Containers):
    def test_it_is_optimised_in_place_and_all_else_stays(self):
        for shape in ({}, {"checksum": 0}, {"compression": 0, "encoding": 0}, {"compression": 1, "encoding": 1},
                      {"compression": 2, "encoding": 1}):
            with self.subTest(shape):
                path = self.put_bgcode(**shape)
                before = bgcode.parse(read(path))
                shutil.copy(path, self.path("original.bgcode"))

                summary = self.optimize(path)

                self.assertRegex(summary, r"layers rewritten: travel")
                after = bgcode.parse(read(path))
                self.assertEqual(before.checksum, after.checksum)
                self.assertEqual([block.raw for block in before.blocks if block.kind != bgcode.GCODE],
                                 [block.raw for block in after.blocks if block.kind != bgcode.GCODE])
                shapes = {(block.compression, block.parameters) for block in after.blocks if block.kind == bgcode.GCODE}
                self.assertEqual({(before.blocks[-1].compression, before.blocks[-1].parameters)}, shapes)
                for block in after.blocks:
                    if block.kind == bgcode.GCODE:
                        self.assertLessEqual(len(block.text()), 65536)
                        self.assertTrue(block.text().endswith("\n"))
                self.assertNotEqual(commands(before.text()), commands(after.text()))
                self.assertEqual(sorted(line for line in commands(before.text()) if line.startswith("M")),
                                 sorted(line for line in commands(after.text()) if line.startswith("M")))
                self.optimize(self.path("original.bgcode"), "-o", self.path("text.gcode"))
                self.assertEqual(commands(read(self.path("text.gcode")).decode()), commands(after.text()))
                self.assertIn("prints the same as", self.succeed("verify", path, self.path("text.gcode")))

    def test_text_and_binary_are_the_same_print(self):
        text = self.put("part.gcode", sliced())
        self.optimize(text, "-o", self.path("shorter.gcode"))
        self.optimize(text, "-o", self.path("shorter.bgcode"))
        self.optimize(self.put_bgcode(), "-o", self.path("other.gcode"))

        self.assertEqual(commands(read(self.path("shorter.gcode")).decode()),
                         commands(bgcode.parse(read(self.path("shorter.bgcode"))).text()))
        self.assertTrue(read(self.path("other.gcode")).startswith(b"; generated by PrusaSlicer 2.8.1 on 2024-"))
        for one, other in (("part.gcode", "part.bgcode"), ("part.bgcode", "part.gcode"), ("shorter.gcode", "shorter.bgcode"),
                           ("shorter.bgcode", "other.gcode")):
            self.succeed("verify", self.path(one), self.path(other), "--quiet")
        changed = read(self.path("shorter.gcode")).replace(b"G1 X", b"G1 X1", 1)
        self.assertIn("spoiled.gcode:", self.run_traverse("verify", self.path("shorter.bgcode"),
                                                           self.put("spoiled.gcode", changed))[2])

    def test_container_says_what_is_written(self):
        path = self.put_bgcode()
        text = self.optimize(path, "-o", "-", "--container=text", "--quiet")
        self.assertTrue(text.startswith("; generated by"))
        with open(path, "rb") as stdin:
            code, out, err = self.run_traverse("optimize", "-", "--container=text", "--quiet", "--strategy=ni2opt",
                                               stdin=stdin)
        self.assertEqual((DONE, text), (code, out.decode()), err)
        self.optimize(self.put("part.gcode", sliced()), "-o", self.path("x.out"), "--container=bgcode")
        self.assertTrue(read(self.path("x.out")).startswith(b"GCDE"))
        self.assertIn("use -o OUTPUT",
                      self.fail_with(USAGE, "optimize", self.path("part.gcode"), "--container=bgcode"))
        self.assertIn("cannot make a .gcode.3mf from",
                      self.fail_with(USAGE, "optimize", self.path("part.gcode"), "-o", self.path("x.gcode.3mf")))
        self.assertEqual(sliced(), read(self.path("part.gcode")).decode())

    def test_restated_times_are_the_same_everywhere(self):
        path = self.put_bgcode()
        kept = self.path("kept.bgcode")
        restated = self.path("restated.bgcode")
        self.optimize(path, "-o", kept)
        self.optimize(path, "-o", restated, "--restate_times")

        self.assertIn("1h 0m 0s", bgcode.parse(read(kept)).blocks[1].content().decode())
        printer, print_data = (bgcode.parse(read(restated)).blocks[i].content().decode() for i in (1, 3))
        stated = re.search(r"normal mode\)=(\d+)m (\d+)s", printer)
        self.assertIsNotNone(stated, printer)
        self.assertIn(stated.group(0), print_data)
        minutes = int(stated.group(1))
        self.assertLess(minutes, 60)
        progress = re.search(r"M73 P50 R(\d+)", bgcode.parse(read(restated)).text())
        self.assertLessEqual(abs(int(progress.group(1)) - minutes / 2), 1)
        self.succeed("verify", kept, restated)
        lied = self.optimize(path, "-o", "-", "--container=text", "--quiet").replace("M73 P50 R30", "M73 P50 R29")
        code, _, err = self.run_traverse("verify", kept, self.put("lied.gcode", lied))
        self.assertEqual(INPUT, code)
        self.assertIn("line of progress", err)

    def test_commands_that_take_gcode_take_it(self):
        path = self.put_bgcode()
        text = self.put("part.gcode", bgcode.parse(read(path)).text())
        shown = self.succeed("inspect", path)
        for fact in ("container", "binary G-code, version 1, CRC32", "thumbnail, QOI 16x16", "heatshrink 12/4",
                     "MeatPack with comments", "printer_model", "PrusaSlicer 2.8.1"):
            self.assertIn(fact, shown)
        self.assertIn("greedy", self.succeed("compare", path, "--strategies=greedy", "--layers=2"))
        self.succeed("convert", path, "-o", self.path("binary.json"))
        self.succeed("convert", text, "-o", self.path("text.json"))
        self.assertEqual(json.loads(read(self.path("text.json")))["layers"],
                         json.loads(read(self.path("binary.json")))["layers"])
        self.optimize(path, "-o", self.path("x.bgcode"), f"--report={self.path('x.html')}",
                     f"--json={self.path('x.json')}")
        self.assertEqual(path, json.loads(read(self.path("x.json")))["input"])

    def test_damage_is_one_line_and_nothing_is_written(self):
        good = read(self.put_bgcode())
        file = bgcode.parse(good)
        gcode = file.blocks[-1]
        number = len(file.blocks)
        huge = bytearray(good)
        struct.pack_into("<I", huge, file.blocks[2].offset + 4, 0xfffffff0)
        bomb = bytearray(good)
        struct.pack_into("<I", bomb, gcode.offset + 4, 0xfffffff0)
        struct.pack_into("<I", bomb, len(bomb) - 4, zlib.crc32(bomb[gcode.offset:-4]))
        cases = {
            "cut.bgcode": (good[:gcode.offset + 40], rf"block {number} at offset {gcode.offset} states \d+ bytes of G-code"),
            "header.bgcode": (good[:gcode.offset + 5], rf"block {number} at offset {gcode.offset}: the file ends in its header"),
            "crc.bgcode": (good[:-20] + b"x" + good[-19:], rf"block {number} at offset {gcode.offset} \(G-code\): its CRC32"),
            "huge.bgcode": (bytes(huge), r"block 3 at offset \d+ states 4294967280 bytes of thumbnail"),
            "bomb.bgcode": (bytes(bomb), rf"block {number} at offset {gcode.offset}: .* a block may have 2097152 at most"),
            "version.bgcode": (good[:4] + b"\2" + good[5:], "version 2 is unknown"),
            "short.bgcode": (b"GCDE\1", "the header of binary G-code is cut short"),
            "empty.bgcode": (good[:file.blocks[5].offset], "no block of G-code"),
            "other.bgcode": (b"\x7fELF\0\0\0", "does not begin with GCDE"),
        }
        for name, (content, message) in cases.items():
            with self.subTest(name):
                path = self.put(name, content)
                fault = self.fail_with(INPUT, "optimize", path, preexec_fn=None if SANITIZED else little_memory)
                self.assertRegex(fault, f"^{re.escape(path)}: ")
                self.assertRegex(fault, message)
                self.assertEqual(content, read(path))
                self.fail_with(INPUT, "optimize", path, "-o", self.path("out.bgcode"))
                self.fail_with(INPUT, "inspect", path)
        self.assertFalse(os.path.exists(self.path("out.bgcode")))


class GcodeZip(Containers):
    def entries(self, path):
        with zipfile.ZipFile(path) as archive:
            self.assertIsNone(archive.testzip())
            return [(info.filename, info.compress_type, info.date_time, info.external_attr) for info in archive.infolist()]

    def content(self, path, name):
        with zipfile.ZipFile(path) as archive:
            return archive.read(name)

    def test_all_plates_are_optimised_and_all_else_stays(self):
        for case, end in ((str.upper, ""), (str.lower, "\n")):
            path = self.put_3mf(md5=case, end=end)
            shutil.copy(path, self.path("original.gcode.3mf"))
            original = self.path("original.gcode.3mf")

            summary = self.optimize(path)

            self.assertEqual(2, summary.count("layers rewritten"), summary)
            self.assertEqual(self.entries(original), self.entries(path))
            for plate in (1, 2):
                text = self.content(path, f"Metadata/plate_{plate}.gcode")
                self.assertIn(b"optimised by Traverse", text)
                self.assertEqual((case(hashlib.md5(text).hexdigest()) + end).encode(),
                                 self.content(path, f"Metadata/plate_{plate}.gcode.md5"))
            for name in ("[Content_Types].xml", "Metadata/plate_1.png", "Metadata/slice_info.config"):
                self.assertEqual(self.content(original, name), self.content(path, name))
            self.optimize(self.put("part.gcode", sliced()), "-o", self.path("shorter.gcode"))
            self.succeed("verify", path, self.path("shorter.gcode"), "--plate=1")
            self.succeed("verify", original, self.put_3mf("again.gcode.3mf"))
            if shutil.which("unzip"):
                subprocess.run(["unzip", "-tq", path], check=True, stdout=subprocess.DEVNULL)

    def test_one_plate_is_optimised(self):
        path = self.put_3mf()
        out = self.path("out.gcode.3mf")
        self.optimize(path, "--plate=2", "-o", out)
        self.assertEqual(self.content(path, "Metadata/plate_1.gcode"), self.content(out, "Metadata/plate_1.gcode"))
        self.assertNotEqual(self.content(path, "Metadata/plate_2.gcode"), self.content(out, "Metadata/plate_2.gcode"))
        self.optimize(path, "--plate=2", "-o", self.path("plate.gcode"))
        self.assertEqual(self.content(out, "Metadata/plate_2.gcode"), read(self.path("plate.gcode")))
        self.succeed("verify", out, self.path("plate.gcode"), "--plate=2")
        self.assertIn("no plate 3, only 1, 2", self.fail_with(INPUT, "optimize", path, "--plate=3"))
        self.assertIn("choose one with --plate",
                      self.fail_with(INPUT, "optimize", path, "-o", self.path("both.gcode")))
        self.assertIn("choose one with --plate", self.fail_with(INPUT, "compare", path))
        self.assertIn("no plate 2, only 1", self.fail_with(INPUT, "optimize", self.put("a.gcode", sliced()), "--plate=2"))
        shown = self.succeed("inspect", path)
        self.assertIn("Metadata/plate_2.gcode, deflate", shown)
        self.assertIn("Metadata/plate_1.png", shown)

    def test_prediction_is_restated(self):
        path = self.put_3mf()
        self.optimize(path, "--plate=1", "--restate_times")
        predictions = re.findall(r'prediction" value="(\d+)"', self.content(path, "Metadata/slice_info.config").decode())
        self.assertLess(int(predictions[0]), 3600)
        self.assertEqual("3600", predictions[1])

    def test_a_wrong_md5_is_refused_unless_ignored(self):
        path = self.put_3mf(md5=lambda digest: digest[::-1])
        before = read(path)
        fault = self.fail_with(INPUT, "optimize", path)
        self.assertIn("entry Metadata/plate_1.gcode.md5: the MD5", fault)
        self.assertEqual(before, read(path))
        self.optimize(path, "--ignore_md5")
        self.succeed("inspect", path)

    def test_packages_of_ultimaker(self):
        path = self.path("part.ufp")
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("/Metadata/thumbnail.png", "picture")
            archive.writestr("/3D/model.gcode", sliced())
        self.optimize(path)
        self.assertEqual(["/Metadata/thumbnail.png", "/3D/model.gcode"], [entry[0] for entry in self.entries(path)])
        self.assertIn(b"optimised by Traverse", self.content(path, "/3D/model.gcode"))

    def test_damage_is_one_line_and_nothing_is_written(self):
        good = read(self.put_3mf())
        cases = {}

        def made(name, message, *entries, spoil=lambda content: content):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of names that occur twice
                with zipfile.ZipFile(self.path("made.zip"), "w", zipfile.ZIP_DEFLATED) as archive:
                    for entry, content in entries:
                        archive.writestr(entry, content)
            cases[name] = (spoil(read(self.path("made.zip"))), message)

        plate = ("Metadata/plate_1.gcode", sliced())
        made("up.3mf", "entry ../x: its name leads out of its folder", plate, ("../x", "x"))
        made("root.3mf", "entry /etc/passwd: its name is absolute", plate, ("/etc/passwd", "x"))
        made("twice.3mf", "entry Metadata/plate_1.gcode: there are two with that name", plate, plate)
        made("none.3mf", "a zip archive without G-code", ("3D/3dmodel.model", "<model/>"))
        made("bomb.3mf", "entry Metadata/plate_1.gcode: it states 300 MiB", (plate[0], b"G" * (300 << 20)))
        made("text.3mf", "Metadata/plate_1.gcode", (plate[0], "nothing"))
        cases["cut.3mf"] = (good[:-30], "has no directory")
        cases["other.3mf"] = (b"\x7fELF\0\0\0", "does not begin as a zip archive")
        for name, (content, message) in cases.items():
            with self.subTest(name):
                path = self.put(name, content)
                fault = self.fail_with(INPUT, "optimize", path, preexec_fn=None if SANITIZED else little_memory)
                self.assertRegex(fault, f"^{re.escape(path)}: ")
                self.assertIn(message, fault)
                self.assertEqual(content, read(path))


if __name__ == "__main__":
    unittest.main()
