"""The command line as scripts use it: flags, help, completion, exit codes and messages."""
import json
import os
import re
import resource
import shutil
import subprocess
import unittest

from command_line import DONE, INPUT, SMALL, TESTS, USAGE, CommandLine, island, read

SAMPLE = os.path.join(TESTS, os.pardir, "deploy", "samples", "clusters13.gcode")


class Usage(CommandLine):
    def test_each_fault_is_one_line_and_code_2(self):
        cases = [
            ([], "traverse: no command given; see traverse --help"),
            (["optimise"], 'traverse: unknown command "optimise"; did you mean optimize?'),
            (["optimize"], "traverse optimize: INPUT is missing; see traverse optimize --help"),
            (["optimize", "a", "b"], 'traverse optimize: unexpected argument "b"; see traverse optimize --help'),
            (["optimize", SMALL, "--strateg=auto"],
             "traverse optimize: unknown flag --strateg; did you mean --strategy?"),
            (["optimize", SMALL, "--strategy=gredy"],
             'traverse optimize: unknown strategy "gredy"; did you mean greedy? '
             "(`traverse strategies` lists them)"),
            (["optimize", SMALL, "--strategy=none,greedy"], "traverse optimize: --strategy takes one strategy"),
            (["optimize", SMALL, "--strategy=none", "--option=tenure=5"],
             "traverse optimize: --option=tenure: none of the strategies has this option"),
            (["optimize", SMALL, "--option=tenure"], 'traverse optimize: option "tenure" is not NAME=VALUE'),
            (["optimize", SMALL, "--deadline=5"],
             "traverse optimize: --deadline=5: not a duration of at least 1ns, such as 500ms, 30s or 5m"),
            (["optimize", SMALL, "--layers=0-1"], "traverse optimize: --layers=0-1: not A-B, positions counted from 1"),
            (["optimize", SMALL, "--layers=2-1"], "traverse optimize: --layers=2-1: not A-B, positions counted from 1"),
            (["optimize", SMALL, "--layers=2-4"], "traverse optimize: --layers=2-4: the file has 3 layers"),
            (["optimize", SMALL, "--cleaning_every=5"],
             "traverse optimize: --cleaning_every and --cleaning_point must be given together"),
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
             "traverse optimize: --threads works only without --server"),
            (["optimize", SMALL, "-o", "x.damat"],
             "traverse optimize: -o is for G-code; the routes of DAMAT go to --json=FILE"),
            (["optimize", SMALL, "--picture=x.gif"],
             "traverse optimize: --picture=x.gif: does not end in .svg or .png"),
            (["compare", SMALL, "--picture=no/such/x.svg"],
             "traverse compare: --picture=no/such/x.svg: no such folder: no/such"),
            (["optimize", SMALL, "--picture=x.svg", "--layer=4"],
             "traverse optimize: --layer=4: not one of the layers 1 to 3"),
            (["compare", SMALL, "--picture=x.svg", "--layers=2-3", "--layer=1"],
             "traverse compare: --layer=1: not one of the layers 2 to 3"),
            (["optimize", SMALL, "--report=part.gcode"],
             "traverse optimize: --report=part.gcode: does not end in .html"),
            (["compare", SMALL, "--report=no/such/x.html"],
             "traverse compare: --report=no/such/x.html: no such folder: no/such"),
            (["optimize", SMALL, "--layer=1"], "traverse optimize: --layer needs --picture"),
            (["compare", SMALL, "--strategies=none,,greedy"],
             'traverse compare: "none,,greedy" does not name a strategy'),
            (["compare", SMALL, "--repeat=0"], "traverse compare: --repeat=0: not a whole number from 1 to 1000"),
            (["convert", SMALL], "traverse convert: -o OUTPUT is missing"),
            (["convert", SMALL, "-o", "x.gcode"],
             "traverse convert: -o writes .damat, .json or .pb; see --to for other names"),
            (["strategies", "x"], 'traverse strategies: unexpected argument "x"; see traverse strategies --help'),
        ]
        for arguments, line in cases:
            with self.subTest(arguments):
                self.assertEqual(self.fail_with(USAGE, *arguments), line)

    def test_a_machine_may_include_files(self):
        folder = self.path("of [one] printer")
        os.mkdir(folder)
        machine = self.put(f"{folder}/printer.cfg", "[include base*.cfg]\n[include none*.cfg]\n")
        self.put(f"{folder}/base1.cfg", "[printer]\nmax_velocity: 300\nmax_accel: 3000\n")
        self.succeed("inspect", SMALL, f"--machine={machine}")
        self.put(f"{folder}/base2.cfg", "[include base3.cfg]\n[printer]\nmax_accel: 0\n")
        for fault in ("base2.cfg:1: \"base3.cfg\": there is no such file to include",
                      "base2.cfg:3: max_accel: \"0\" is not a number above 0 and up to 1e9"):
            self.assertEqual(self.fail_with(USAGE, "optimize", SMALL, f"--machine={machine}"),
                             f"traverse optimize: --machine: {folder}/{fault}")
            self.put(f"{folder}/base3.cfg", "")

    def test_files_that_include_others_without_end_are_told(self):
        # 60 times 60 times 60 and so on; none includes itself.
        for depth in range(9):
            self.put(f"{depth}.cfg", f"[include {depth + 1}.cfg]\n" * 60)
        self.put("9.cfg", "[printer]\nmax_velocity: 100\nmax_accel: 1000\n")
        told = self.fail_with(USAGE, "inspect", SMALL, f"--machine={self.path('0.cfg')}")
        self.assertRegex(told, r"/8\.cfg:[0-9]+: more than 1000 files are included$")

    def test_a_machine_is_read_from_a_file(self):
        for content, fault in [("[printer]\nmax_velocity: fast\n",
                                ':2: max_velocity: "fast" is not a number above 0 and up to 1e9'),
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
            flags = [line for line in text.splitlines() if line.startswith("  -")]
            self.assertEqual([line for line in flags if len(re.findall(r"(?<= )--?[a-z]", line[:29])) != 1], [])
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
            ("nan.damat", island("C1,Xnan,Y1"), '4: "Xnan" is not a coordinate'),
            ("inf.damat", island("C1,X1,Yinf"), '4: "Yinf" is not a coordinate'),
            ("far.damat", island("C1,X1,Y1e300"), '4: "Y1e300" is not a coordinate'),
            ("none.damat", island("C1"), "4: a contour without points"),
            ("twice.damat", island("C1,X1,Y1,X2,Y1\nC1,X1,Y1,X2,Y1", 2), "5: second contour with id 1"),
            ("spellings.damat", island("C1,X1,Y1\nC1,X2,Y1\nC2,X1,Y1,X2,Y2", 2), "6: two spellings in one file"),
            ("thickness.damat", "E,\nnF,0\n", "1: \"\" is not a layer thickness"),
            ("outer.damat", island("C1,X0,Y0,X9,Y0,X9,Y9\nC2,X20,Y0,X29,Y0,X29,Y9", 2), "5: C2 and C1 (line 4) are two outer"),
            ("count.damat", island("C1,X1,Y1", 3), "3: I1 states 3 contours, but the file has 1"),
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
                         "standard input:1: nF states 1 layers, but the file has 0")

    def test_an_output_that_cannot_be_written_is_a_fault(self):
        line = self.fail_with(INPUT, "optimize", SMALL, "--json=/no/such/folder/x.json")
        self.assertEqual(line, "/no/such/folder/x.json: No such file or directory")

    def test_an_output_that_may_not_become_as_large_is_a_fault_and_leaves_nothing(self):
        line = self.fail_with(INPUT, "optimize", SAMPLE, "--quiet", "-o", self.path("out.gcode"),
                              limit=(resource.RLIMIT_FSIZE, (4096, 4096)))
        self.assertEqual(line, f"{self.path('out.gcode')}: File too large")
        self.assertEqual(os.listdir(self.folder), [])

    def test_where_memory_ends_one_line_says_so(self):
        limit = (resource.RLIMIT_DATA, (100 << 20, 100 << 20))
        if self.run_traverse("--version", limit=limit)[0] != DONE:
            self.skipTest("sanitizers take more memory to begin with")
        name = self.put("large.gcode", "G1 X1 E1\n")
        os.truncate(name, 200 << 20)

        self.assertEqual(self.fail_with(INPUT, "optimize", name, "-o", self.path("out.gcode"), limit=limit),
                         "traverse: out of memory")
        self.assertEqual(os.listdir(self.folder), ["large.gcode"])

    def test_options_of_a_file_that_are_wrong_are_named(self):
        name = self.put("options.json", '{"options": {"idle_speed_mm_s": -1}, "layers": []}')
        self.assertIn("options.idle_speed_mm_s", self.fail_with(USAGE, "optimize", name))


if __name__ == "__main__":
    unittest.main()
