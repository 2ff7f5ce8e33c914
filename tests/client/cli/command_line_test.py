"""The command line as scripts use it: exit codes, messages, documents. Runs the built binary.

The environment names it: TRAVERSE, and TRAVERSE_SERVER for the tests with a remote service.
"""
import json
import lzma
import os
import re
import shutil
import stat
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

HERE = os.path.dirname(os.path.abspath(__file__))
TESTS = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(TESTS, "support"))
import check_routes  # noqa: E402

TRAVERSE = os.environ["TRAVERSE"]
INSTANCES = os.path.join(TESTS, "bench", "instances")
SMALL = os.path.join(TESTS, "data", "damat", "two_islands.damat")
PART1 = os.path.join(INSTANCES, "part1.damat")

DONE, INPUT, USAGE, SERVER = 0, 1, 2, 3


def read(name):
    with open(name, encoding="utf-8") as file:
        return file.read()


def island(records, contours=1, rasters=0):
    return f"nF,1\nF1,1\nI1,{contours},{rasters}\n{records}\n"


class CommandLine(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def put(self, name, content):
        mode = "wb" if isinstance(content, bytes) else "w"
        with open(self.path(name), mode) as file:
            file.write(content)
        return self.path(name)

    def run_traverse(self, *arguments, stdin=b"", env=None):
        ran = subprocess.run([TRAVERSE, *arguments], input=stdin, capture_output=True, timeout=120,
                             env={**os.environ, **(env or {})})
        return ran.returncode, ran.stdout.decode(), ran.stderr.decode()

    def succeed(self, *arguments, **kw):
        """What was printed; on a busy machine the progress is told besides, and nothing else."""
        code, out, err = self.run_traverse(*arguments, **kw)
        told = [line for line in err.splitlines() if not re.match(r"\S+: \d+/\d+ layers", line)]
        self.assertEqual((code, told), (DONE, []))
        return out

    def fail_with(self, code, *arguments, **kw):
        """The one line of the failure; nothing else may be printed."""
        got, out, err = self.run_traverse(*arguments, **kw)
        self.assertEqual((got, out), (code, ""), err)
        self.assertEqual(err.count("\n"), 1, err)
        return err.rstrip("\n")


class Usage(CommandLine):
    def test_each_fault_is_one_line_and_code_2(self):
        cases = [
            ([], "traverse: which command? See traverse --help"),
            (["optimise"], 'traverse: unknown command "optimise"; did you mean optimize?'),
            (["optimize"], "traverse optimize: INPUT is missing; see traverse optimize --help"),
            (["optimize", "a", "b"], 'traverse optimize: "b" is too much; see traverse optimize --help'),
            (["optimize", SMALL, "--strateg=auto"],
             "traverse optimize: unknown flag --strateg; did you mean --strategy?"),
            (["optimize", SMALL, "--strategy=gredy"],
             'traverse optimize: unknown strategy "gredy"; did you mean greedy? '
             "(`traverse strategies` lists them)"),
            (["optimize", SMALL, "--strategy=none,greedy"], "traverse optimize: --strategy takes one strategy"),
            (["optimize", SMALL, "--strategy=none", "--option=tenure=5"],
             "traverse optimize: --option=tenure: no strategy asked for has this option"),
            (["optimize", SMALL, "--option=tenure"], 'traverse optimize: option "tenure" is not NAME=VALUE'),
            (["optimize", SMALL, "--deadline=5"],
             "traverse optimize: --deadline=5: not a duration from 1ns on, such as 500ms, 30s or 5m"),
            (["optimize", SMALL, "--layers=0-1"], "traverse optimize: --layers=0-1: not A-B, two positions from 1"),
            (["optimize", SMALL, "--layers=2-1"], "traverse optimize: --layers=2-1: not A-B, two positions from 1"),
            (["optimize", SMALL, "--layers=2-4"], "traverse optimize: --layers=2-4: the file has 3 layers"),
            (["optimize", SMALL, "--cleaning_every=5"],
             "traverse optimize: --cleaning_every and --cleaning_point go together"),
            (["optimize", SMALL, "--cleaning_every=0", "--cleaning_point=0,0"],
             "traverse optimize: --cleaning_every=0: not a whole number from 1 to 2147483647"),
            (["optimize", SMALL, "--cleaning_every=1", "--cleaning_point=0"],
             "traverse optimize: --cleaning_point=0: not a point X,Y within +-1e6 mm"),
            (["optimize", SMALL, "--cost=money"], "traverse optimize: --cost=money: not one of length, time"),
            (["optimize", SMALL, "--deposition=sequentiall"],
             "traverse optimize: --deposition=sequentiall: not one of sequential, interleaved; "
             "did you mean sequential?"),
            (["optimize", SMALL, "--travel_speed=0"],
             "traverse optimize: --travel_speed=0: not a number from 0.001 to 100000"),
            (["optimize", SMALL, "--machine=no/such.cfg"],
             "traverse optimize: --machine: no/such.cfg: No such file or directory"),
            (["optimize", SMALL, "--threads=0"], "traverse optimize: --threads=0: not a whole number from 1 to 1024"),
            (["optimize", SMALL, "--server=farm"], 'traverse optimize: --server: "farm" is not HOST:PORT'),
            (["optimize", SMALL, "--server=farm:1", "--threads=2"],
             "traverse optimize: --threads is for the embedded service, not for --server"),
            (["optimize", SMALL, "-o", "x.damat"],
             "traverse optimize: -o is for G-code; the routes of DAMAT go to --json=FILE"),
            (["optimize", SMALL, "--picture=x.gif"],
             "traverse optimize: --picture=x.gif: ends neither in .svg nor in .png"),
            (["compare", SMALL, "--picture=no/such/x.svg"],
             "traverse compare: --picture=no/such/x.svg: there is no folder no/such"),
            (["optimize", SMALL, "--picture=x.svg", "--layer=4"],
             "traverse optimize: --layer=4: not one of the layers 1 to 3"),
            (["compare", SMALL, "--picture=x.svg", "--layers=2-3", "--layer=1"],
             "traverse compare: --layer=1: not one of the layers 2 to 3"),
            (["optimize", SMALL, "--report=part.gcode"],
             "traverse optimize: --report=part.gcode: does not end in .html"),
            (["compare", SMALL, "--report=no/such/x.html"],
             "traverse compare: --report=no/such/x.html: there is no folder no/such"),
            (["optimize", SMALL, "--layer=1"], "traverse optimize: --layer is for --picture"),
            (["compare", SMALL, "--strategies=none,,greedy"],
             'traverse compare: "none,,greedy" names no strategy'),
            (["compare", SMALL, "--repeat=0"], "traverse compare: --repeat=0: not a whole number from 1 to 1000"),
            (["convert", SMALL], "traverse convert: -o OUTPUT is missing"),
            (["convert", SMALL, "-o", "x.gcode"],
             "traverse convert: -o writes .damat, .json or .pb; see --to for other names"),
            (["strategies", "x"], 'traverse strategies: "x" is too much; see traverse strategies --help'),
        ]
        for arguments, line in cases:
            with self.subTest(arguments):
                self.assertEqual(self.fail_with(USAGE, *arguments), line)

    def test_a_machine_is_read_from_a_file(self):
        for content, fault in [("[printer]\nmax_velocity: fast\n",
                                ':2: max_velocity: "fast" is no number above 0, at most 1e9'),
                               ("[printer]\nmax_accel: 5\n", ": [printer] has no max_velocity"),
                               ("fast\n", ": neither a Klipper configuration, with [printer], nor lines of M201 to M205")]:
            machine = self.put("printer.cfg", content)
            for command in ("optimize", "compare", "inspect"):
                self.assertEqual(self.fail_with(USAGE, command, SMALL, f"--machine={machine}"),
                                 f"traverse {command}: --machine: {machine}{fault}")

    def test_help_names_every_flag_and_has_an_example(self):
        general = self.succeed("--help")
        self.assertLessEqual(max(map(len, general.splitlines())), 80)
        for command in ("optimize", "compare", "inspect", "convert", "strategies", "completion", "manual"):
            self.assertIn(f"  {command} ", general)
            text = self.succeed(command, "--help")
            self.assertIn(f"usage: traverse {command}", text)
            self.assertIn("\nexample: ", text)
            self.assertEqual(text, self.succeed("help", command))
            self.assertEqual(text, self.succeed(command, "x", "--no_such_flag", "-h"))
            self.assertLessEqual(max(map(len, text.splitlines())), 80)
            self.assertLessEqual(len(text.splitlines()), 24)
        for flag in ("-o", "--strategy", "--server", "--deadline", "--layers", "--deposition", "--cleaning_every",
                     "--cleaning_point", "--cost", "--policy", "--seed", "--threads", "--json", "--quiet"):
            self.assertIn(f" {flag}", self.succeed("optimize", "--help"))

    def test_bash_completes_commands_flags_and_choices(self):
        def complete(*words):
            line = "(" + " ".join(f"'{word}'" for word in words) + ")"
            script = (f'eval "$("$TRAVERSE" completion bash)"; COMP_WORDS={line}; '
                      "COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); compopt() { :; }; _traverse; "
                      'printf "%s\\n" "${COMPREPLY[@]}"')
            return subprocess.run(["bash", "-uc", script], cwd=self.folder, capture_output=True, check=True,
                                  text=True).stdout.split()

        self.put("part.damat", "")
        self.assertEqual(complete("traverse", "opt"), ["optimize"])
        self.assertEqual(complete("traverse", "optimize", "--se"), ["--seed=", "--server="])
        self.assertEqual(complete("traverse", "optimize", "--cost", "=", "t"), ["time"])
        self.assertEqual(complete("traverse", "optimize", "--cost", "="), ["length", "time"])
        self.assertEqual(complete("traverse", "optimize", "pa"), ["part.damat"])
        self.assertEqual(complete("traverse", "optimize", "--json", "=", "pa"), ["part.damat"])

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh_accepts_the_completion_script(self):
        script = "autoload -Uz compinit && compinit -u -D && source <($TRAVERSE completion zsh) && echo ${_comps[traverse]}"
        ran = subprocess.run(["zsh", "-fc", script], capture_output=True, check=True, text=True)
        self.assertEqual((ran.stdout, ran.stderr), ("_traverse\n", ""))

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh_completes_commands_flags_and_values(self):
        """Types into a shell on a terminal of its own and presses Tab."""
        script = (
            "zmodload zsh/zpty\n"
            "complete() {\n"
            "  zpty shell zsh -f -i\n"
            "  zpty -w shell 'PS1=; unsetopt zle_bracketed_paste; stty columns 200; autoload -Uz compinit; compinit -u -D; "
            "source <($TRAVERSE completion zsh); zstyle \":completion:*\" list-prompt \"\"; LISTMAX=1000; echo re\"\"ady'\n"
            "  zpty -r -m shell out '*ready*'\n"
            "  zpty -w -n shell \"$1\"$'\\t'\n"
            "  sleep 1\n"
            "  zpty -w -n shell $'\\C-e\\C-uecho do\"\"ne\\n'\n"
            "  zpty -r -m shell out '*done*'\n"
            "  print -r -- \"$out\"; zpty -d shell\n"
            "}\n"
            "complete \"$1\"\n")

        def shown(line):
            ran = subprocess.run(["zsh", "-f", "-c", script, "zsh", line], capture_output=True, text=True, timeout=60,
                                 env={**os.environ, "TERM": "dumb"}, cwd=self.folder)
            return ran.stdout

        self.assertIn("balanced", shown("traverse optimize --policy=bal"))
        self.put("part.damat", "")
        self.assertIn("part.damat", shown("traverse compare pa"))

    def test_completion_knows_two_shells(self):
        self.assertEqual(self.fail_with(USAGE, "completion", "fish"),
                         'traverse completion: "fish" is neither bash nor zsh')

    def test_manual_has_every_command_and_flag(self):
        page = self.succeed("manual")
        self.assertTrue(page.startswith(".TH TRAVERSE 1"))
        for word in (".SS traverse optimize INPUT", ".B \\-\\-cleaning_point=X,Y", ".B \\-o OUTPUT", ".SH EXIT STATUS"):
            self.assertIn(word + "\n", page)

    @unittest.skipUnless(shutil.which("groff"), "groff is not installed")
    def test_the_formatter_of_man_pages_has_no_complaint(self):
        ran = subprocess.run(["groff", "-man", "-Tutf8", "-ww"], input=self.succeed("manual"), capture_output=True,
                             check=True, text=True)
        self.assertEqual(ran.stderr, "")

    def test_version(self):
        self.assertRegex(self.succeed("--version"), r"^traverse \d+\.\d+\.\d+\n$")


class Views(CommandLine):
    def test_pictures_of_any_input_by_optimize_and_compare(self):
        gcode = os.path.join(TESTS, os.pardir, "deploy", "samples", "clusters13.gcode")
        for name, arguments in {
            "damat.svg": ["optimize", SMALL],
            "gcode.svg": ["optimize", gcode, "-o", self.path("out.gcode")],
            "compare.svg": ["compare", gcode, "--strategies=greedy", "--layers=3-4"],
        }.items():
            self.run_traverse(*arguments, "--quiet", f"--picture={self.path(name)}")
            picture = xml.etree.ElementTree.parse(self.path(name)).getroot()
            self.assertTrue(picture.tag.endswith("}svg"))
            captions = [text.text for text in picture.iter("{http://www.w3.org/2000/svg}text")]
            self.assertRegex(captions[0], r"^(two_islands.damat|clusters13.gcode), layer \d")
            self.assertRegex(captions[1], "^before: travel ")
            self.assertRegex(captions[2], "^after: travel ")
        with open(gcode, encoding="utf-8") as file:
            self.assertNotEqual(file.read(), read(self.path("out.gcode")))

    def test_reports_hold_their_figures(self):
        os.mkdir(self.path("<"))
        name = self.put("</script><b>.damat", read(SMALL))
        page, routes = self.path("page.html"), self.path("routes.json")
        self.succeed("optimize", name, "--quiet", f"--report={page}", f"--json={routes}")
        scene = self.scene(page)
        total = json.loads(read(routes))["total"]
        self.assertEqual(scene["title"], "script><b>.damat")  # what is behind the slash
        self.assertEqual([route["label"] for route in scene["routes"]], ["as given", "auto"])
        self.assertAlmostEqual(scene["routes"][0]["travel"], total["travel_given_mm"], places=2)
        self.assertAlmostEqual(scene["routes"][1]["travel"], total["travel_mm"], places=2)

    def test_reports_of_compare_have_every_strategy_and_show_the_best(self):
        page = self.path("page.html")
        self.run_traverse("compare", PART1, "--quiet", "--strategies=none,greedy,ni2opt", f"--report={page}")
        scene = self.scene(page)
        self.assertEqual([route["label"] for route in scene["routes"]], ["as given", "greedy", "ni2opt"])
        self.assertEqual(scene["shown"], 2)
        self.run_traverse("compare", PART1, "--quiet", "--strategies=none", f"--report={page}")
        self.assertEqual([route["label"] for route in self.scene(page)["routes"]], ["as given", "none"])

    def scene(self, page):
        return json.loads(re.search(r'<script id="scene" type="application/json">(.*?)</script>', read(page))[1])

    def test_what_is_allowed_beside_the_policy(self):
        gcode = os.path.join(TESTS, "data", "gcode", "sl_clusters13_brim.gcode.xz")
        plain = self.path("plain.gcode")
        with lzma.open(gcode, "rb") as packed, open(plain, "wb") as file:
            file.write(packed.read())
        made = self.path("made.gcode")
        out = self.succeed("optimize", plain, "-o", made, "--allow=infill_order")
        self.assertRegex(out, r"travel [0-9.]+ -> [0-9.]+ m \(-[1-9]")
        self.assertIn(", policy safe, allow infill_order: travel", read(made))
        self.assertIn("(policy safe, infill_order)", self.succeed("verify", plain, made))
        code, _, err = self.run_traverse("verify", plain, made, "--policy=safe", "--allow=")
        self.assertEqual(code, 1)
        self.assertIn("(order; ", err)
        self.assertIn("--allow=doors", self.fail_with(2, "optimize", plain, "-o", made, "--allow=doors"))

    def test_reports_of_gcode_state_what_the_files_amount_to(self):
        gcode = os.path.join(TESTS, os.pardir, "deploy", "samples", "clusters13.gcode")
        page = self.path("page.html")
        routes = self.path("routes.json")
        out = self.succeed("optimize", gcode, "-o", self.path("out.gcode"), f"--report={page}", f"--json={routes}")
        before, after = self.scene(page)["routes"]
        self.assertIn(f"travel {before['travel'] / 1000:.2f} -> {after['travel'] / 1000:.2f} m", out)
        self.assertIn(f"retractions {before['retractions']} -> {after['retractions']},", out)
        self.assertIn(f"visible walls crossed {before['crossings']} -> {after['crossings']},", out)
        written = json.loads(read(routes))["gcode"]
        for route, totals in (before, written["given"]), (after, written["written"]):
            self.assertEqual(sum(route["layers"]["crossings"]), totals["crossings"])
            self.assertLessEqual(totals["open_crossings"], totals["crossings"])
            self.assertEqual(route["retractions"], totals["retractions"])
            self.assertAlmostEqual(route["seconds"], totals["print_seconds"], delta=0.001)

    def test_the_layer_is_counted_in_the_file(self):
        picture = self.path("layer.svg")
        self.succeed("optimize", SMALL, "--quiet", "--layers=2-3", "--layer=3", f"--picture={picture}")
        self.assertIn(">two_islands.damat, layer 3<", read(picture))

    def test_a_picture_that_cannot_be_written_leaves_all_as_it_was(self):
        folder = self.path("folder.png")
        os.mkdir(folder)
        sliced = self.put("part.gcode", read(os.path.join(TESTS, os.pardir, "deploy", "samples", "clusters13.gcode")))
        before = read(sliced)
        self.assertIn("folder.png: Is a directory", self.fail_with(INPUT, "optimize", sliced, "--quiet", f"--picture={folder}"))
        self.assertEqual(read(sliced), before)
        self.assertEqual(sorted(os.listdir(self.folder)), ["folder.png", "part.gcode"])


class BadInput(CommandLine):
    def test_each_fault_is_one_line_with_its_place_and_code_1(self):
        good = read(SMALL)
        cases = [
            ("missing.damat", None, "No such file or directory"),
            ("empty.damat", "", "the file is empty"),
            ("binary.damat", bytes(range(256)), "1: not a DAMAT record"),
            ("binary", bytes(range(256)), "neither its content nor its name"),
            ("text.txt", "hello\n", '1: not a DAMAT record: "hello"'),
            ("cut.damat", good[: len(good) // 2], ""),
            ("cut.damat.xz", b"\xfd7zXZ\0\0\4", "xz data end too early"),
            ("nan.damat", island("C1,Xnan,Y1"), '4: "Xnan" is no coordinate'),
            ("inf.damat", island("C1,X1,Yinf"), '4: "Yinf" is no coordinate'),
            ("far.damat", island("C1,X1,Y1e300"), '4: "Y1e300" is no coordinate'),
            ("none.damat", island("C1"), "4: a contour without points"),
            ("twice.damat", island("C1,X1,Y1,X2,Y1\nC1,X1,Y1,X2,Y1", 2), "5: second contour with id 1"),
            ("spellings.damat", island("C1,X1,Y1\nC1,X2,Y1\nC2,X1,Y1,X2,Y2", 2), "6: two spellings in one file"),
            ("thickness.damat", "E,\nnF,0\n", "1: \"\" is no thickness"),
            ("outer.damat", island("C1,X0,Y0,X9,Y0,X9,Y9\nC2,X20,Y0,X29,Y0,X29,Y9", 2), "5: C2 and C1 (line 4) are two outer"),
            ("count.damat", island("C1,X1,Y1", 3), "3: I1 announces 3 contours, the file has 1"),
            ("odd.json", '{"layers": [{"islands": [{"contours": [{"points": [1, 2, 3]}]}]}]}',
             "layers[0].islands[0].contours[0].points"),
            ("nan.json", '{"layers": [{"islands": [{"contours": [{"points": [1, "NaN"]}]}]}]}',
             "layers[0].islands[0].contours[0].points[0].y"),
            ("word.json", '{"layers": [{"isles": []}]}', "isles"),
            ("open.json", '{"layers": [', "not an OptimizeBatchRequest"),
            ("cut.pb", b"\x12\x20\x08\x01", "damaged or cut short"),
        ]
        for name, content, message in cases:
            with self.subTest(name):
                if content is not None:
                    self.put(name, content)
                routes = self.path("routes.json")
                line = self.fail_with(INPUT, "optimize", self.path(name), f"--json={routes}")
                self.assertTrue(line.startswith(self.path(name) + ":"), line)
                self.assertIn(message, line)
                self.assertFalse(os.path.exists(routes))

    def test_a_folder_is_no_file(self):
        self.assertEqual(self.fail_with(INPUT, "inspect", self.folder), f"{self.folder}: Is a directory")

    def test_deep_plans_are_refused(self):
        depth = 10_000
        nodes = [{"in_order": {"children": [i + 1]}} for i in range(depth)] + [{"path": 0}]
        paths = [{"contour": {"points": [0, 0]}}]
        name = self.put("deep.json", json.dumps({"layers": [{"plan": {"paths": paths, "nodes": nodes}}]}))

        self.assertIn("layers[0].plan", self.fail_with(INPUT, "optimize", name))

    def test_standard_input_is_named(self):
        self.assertEqual(self.fail_with(INPUT, "inspect", "-", stdin=b""), "standard input: the file is empty")
        self.assertEqual(self.fail_with(INPUT, "inspect", "-", stdin=b"nF,1\n"),
                         "standard input:1: nF announces 1 layers, the file has 0")

    def test_an_output_that_cannot_be_written_is_a_fault(self):
        line = self.fail_with(INPUT, "optimize", SMALL, "--json=/no/such/folder/x.json")
        self.assertEqual(line, "/no/such/folder/x.json: No such file or directory")

    def test_options_of_a_file_that_are_wrong_are_named(self):
        name = self.put("options.json", '{"options": {"idle_speed_mm_s": -1}, "layers": []}')
        self.assertIn("options.idle_speed_mm_s", self.fail_with(USAGE, "optimize", name))


class Routes(CommandLine):
    def optimize(self, part, *flags):
        routes = self.path("routes.json")
        self.succeed("optimize", part, f"--json={routes}", "--quiet", *flags)
        return json.loads(read(routes))

    def check(self, part, document, **kw):
        first = kw.pop("first", 1)
        checker = check_routes.Checker(check_routes.read_part(check_routes.read_text(part)), **kw)
        checker.check(document, first)
        self.assertEqual(checker.faults, [])

    def test_the_document_is_as_agreed(self):
        document = self.optimize(SMALL, "--strategy=none")

        self.assertEqual(list(document), ["input", "strategy", "seed", "total", "layers"])
        self.assertEqual(document["input"], SMALL)
        self.assertEqual((document["strategy"], document["seed"]), ("none", 1))
        self.assertEqual(list(document["total"]),
                         ["travel_given_mm", "travel_mm", "cleaning_mm", "lower_bound_mm", "solve_seconds",
                          "wall_seconds", "idle_seconds_given", "idle_seconds"])
        self.assertEqual([layer["id"] for layer in document["layers"]], [1, 5, 3])
        self.assertEqual(list(document["layers"][0]),
                         ["id", "start", "travel_given_mm", "travel_mm", "lower_bound_mm", "stop", "solve_seconds",
                          "route"])
        self.assertEqual(document["layers"][0]["route"], [
            {"kind": "contour", "island": 1, "id": 1, "entry": 0},
            {"kind": "contour", "island": 1, "id": 7, "entry": 0},
            {"kind": "contour", "island": 9, "id": 1, "entry": 0},
            {"kind": "raster", "island": 1, "id": 1, "reversed": False},
            {"kind": "raster", "island": 1, "id": 4, "reversed": False}])
        self.assertEqual(document["layers"][1]["route"], [])
        self.assertAlmostEqual(document["total"]["idle_seconds"], document["total"]["travel_mm"] / 20.32)
        self.check(SMALL, document)

    def test_routes_hold_for_every_way_to_do_a_job(self):
        for flags, expected in [
            ([], {}),
            (["--strategy=none"], {}),
            (["--deposition=interleaved"], {"interleaved": True}),
            (["--cleaning_every=2", "--cleaning_point=5,-10.5"], {"cleaning": (2, (5, -10.5))}),
            (["--cleaning_every=5", "--cleaning_point=0,0"], {"cleaning": (5, (0, 0))}),
            (["--layers=2-4"], {"first": 2}),
            (["--layers=3"], {"first": 3}),
            (["--cost=time", "--travel_speed=60", "--travel_accel=500"], {}),
            (["--threads=1", "--seed=18446744073709551615"], {}),
            (["--deadline=30s", "--layer_time_limit=1s"], {}),
        ]:
            with self.subTest(flags):
                self.check(PART1, self.optimize(PART1, *flags), **expected)

    def test_the_checker_finds_faults(self):
        def faults(change):
            document = self.optimize(PART1)
            change(document)
            checker = check_routes.Checker(check_routes.read_part(check_routes.read_text(PART1)))
            checker.check(document)
            return len(checker.faults)

        def total(document):
            document["total"]["travel_mm"] += 0.1

        for change in (
            lambda d: d["layers"][2]["route"].pop(),
            lambda d: d["layers"][2]["route"].append(d["layers"][2]["route"][0]),
            lambda d: d["layers"][2]["route"].reverse(),
            lambda d: d["layers"][2]["route"][0].update(entry=100_000),
            lambda d: d["layers"][2].update(start=[0, 0]),
            lambda d: d["layers"][2].update(travel_mm=1),
            lambda d: d["layers"][2].update(lower_bound_mm=1e9),
            total,
        ):
            self.assertGreater(faults(change), 0)

    def test_start_and_speed_count(self):
        document = self.optimize(SMALL, "--start=3,-4", "--travel_speed=100")

        self.assertEqual(document["layers"][0]["start"], [3.0, -4.0])
        self.assertAlmostEqual(document["total"]["idle_seconds"], document["total"]["travel_mm"] / 100)

    def test_the_same_bytes_whatever_the_threads(self):
        def routes(*flags):
            out = self.succeed("optimize", PART1, "--json=-", "--quiet", *flags)
            return re.sub(r'"(?!idle)\w+_seconds":[^,}]*', "", out)  # what the clock says

        for strategy in self.strategies():
            if strategy == "exact":  # stopped by its time limit where it is slow
                continue
            with self.subTest(strategy):
                one = routes("--threads=1", f"--strategy={strategy}", "--seed=7")
                self.assertEqual(one, routes("--threads=8", f"--strategy={strategy}", "--seed=7"))

    def strategies(self):
        return re.findall(r"^(\w+)", self.succeed("strategies"), re.MULTILINE)

    def test_json_goes_to_standard_output_alone_when_asked(self):
        code, out, err = self.run_traverse("optimize", SMALL, "--json=-")

        self.assertEqual(code, DONE)
        json.loads(out)
        self.assertIn("travel", err)

    def test_the_file_is_replaced_whole_and_keeps_its_mode(self):
        routes = self.put("routes.json", "old")
        os.chmod(routes, 0o600)
        self.succeed("optimize", SMALL, f"--json={routes}", "--quiet")

        self.assertEqual(stat.S_IMODE(os.stat(routes).st_mode), 0o600)
        self.assertEqual(os.listdir(self.folder), ["routes.json"])
        self.fail_with(INPUT, "optimize", self.put("bad.damat", "nF,1\n"), f"--json={routes}")
        json.loads(read(routes))

    def test_summary_goes_to_standard_output(self):
        out = self.succeed("optimize", SMALL)
        self.assertIn("travel ", out)
        self.assertEqual(self.succeed("optimize", SMALL, "--quiet"), "")

    def test_reads_standard_input(self):
        with open(PART1, "rb") as file:
            piped = self.succeed("optimize", "-", "--json=-", "--quiet", stdin=file.read())
        self.assertEqual(json.loads(piped)["layers"][0]["route"], self.optimize(PART1)["layers"][0]["route"])


class OtherCommands(CommandLine):
    def test_compare_prints_a_row_for_each_strategy(self):
        out = self.succeed("compare", PART1, "--strategies=none,greedy", "--layers=1-2", "--quiet")
        rows = [line.split()[0] for line in out.splitlines()[1:] if not line.startswith("-")]
        self.assertEqual(rows, ["strategy", "none", "greedy"])

    def test_compare_prints_what_the_frameworks_reductions_leave(self):
        out = self.succeed("compare", PART1, "--strategies=greedy,tabu:diversifications=5", "--layers=1-2", "--quiet")
        self.assertIn("contour points of a layer", out)
        self.assertIn("309 (-35.2 %)", out)  # as in the thesis's table 5.1

    def test_compare_writes_every_runs_routes(self):
        routes = self.path("routes.json")
        self.succeed("compare", PART1, "--strategies=none,greedy", "--repeat=2", "--seed=5", f"--json={routes}")
        runs = json.loads(read(routes))["runs"]

        self.assertEqual([(run["label"], run["seed"]) for run in runs],
                         [("none", 5), ("none", 6), ("greedy", 5), ("greedy", 6)])
        for run in runs:
            checker = check_routes.Checker(check_routes.read_part(check_routes.read_text(PART1)))
            checker.check(run["routes"])
            self.assertEqual(checker.faults, [])

    def test_inspect_counts(self):
        out = self.succeed("inspect", SMALL)
        for line in ("layers    3", "islands   3", "paths     3 contours, 3 rasters", "points    14"):
            self.assertIn(line, out)

    def test_convert_gives_back_the_job(self):
        part = check_routes.read_part
        for middle in ("a.json", "a.pb"):
            self.succeed("convert", SMALL, "-o", self.path(middle))
            self.succeed("convert", self.path(middle), "-o", self.path("b.damat"))
            self.assertEqual(part(read(self.path("b.damat"))), part(read(SMALL)))

    def test_convert_to_standard_output(self):
        out = self.succeed("convert", SMALL, "-o", "-", "--to=json", "--layers=2-3")
        self.assertEqual([layer["id"] for layer in json.loads(out)["layers"]], ["5", "3"])

    def test_strategies_lists_the_default(self):
        self.assertIn("(default)", self.succeed("strategies"))


class Remote(CommandLine):
    def start_server(self, *flags):
        server = subprocess.Popen([os.environ["TRAVERSE_SERVER"], "--listen=127.0.0.1:0", "--metrics_listen=", *flags],
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.addCleanup(server.stdout.close)
        self.addCleanup(server.wait)
        self.addCleanup(server.kill)
        port = re.search(r"port (\d+)", server.stdout.readline()).group(1)
        return server, f"127.0.0.1:{port}"

    def test_routes_are_those_of_the_embedded_service(self):
        _, address = self.start_server()
        remote = self.succeed("optimize", PART1, "--json=-", "--quiet", f"--server={address}")
        embedded = self.succeed("optimize", PART1, "--json=-", "--quiet")

        self.assertEqual([layer["route"] for layer in json.loads(remote)["layers"]],
                         [layer["route"] for layer in json.loads(embedded)["layers"]])
        self.assertIn("greedy", self.succeed("strategies", f"--server={address}"))

    def test_an_address_that_is_dead_is_left_out(self):
        dead, dead_address = self.start_server()
        dead.kill()
        dead.wait()
        _, address = self.start_server()
        self.succeed("optimize", PART1, "--quiet", f"--server={dead_address},{address}")

    def test_nobody_there_is_code_3(self):
        server, address = self.start_server()
        server.kill()
        server.wait()
        line = self.fail_with(SERVER, "optimize", PART1, f"--server={address}")
        self.assertTrue(line.startswith(f"server {address}: UNAVAILABLE: "), line)
        self.assertTrue(line.endswith("Connection refused"), line)

    def test_a_refusal_is_code_3(self):
        _, address = self.start_server("--max_jobs=1", "--max_queued_points=1", "--max_points_per_layer=1")
        line = self.fail_with(SERVER, "optimize", PART1, f"--server={address}")
        self.assertTrue(line.startswith(f"server {address}: RESOURCE_EXHAUSTED: "), line)


if __name__ == "__main__":
    unittest.main()
