"""What the commands make: documents, routes, pictures, reports. TRAVERSE_SERVER names the server of remote jobs."""
import copy
import json
import lzma
import os
import re
import stat
import subprocess
import sys
import unittest
import xml.etree.ElementTree

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(HERE)), "support"))
import check_routes  # noqa: E402
from command_line import DONE, INPUT, PART1, SERVER, SMALL, TESTS, USAGE, CommandLine, read  # noqa: E402


class Views(CommandLine):
    def test_pictures_of_any_input_by_optimize_and_compare(self):
        gcode = os.path.join(TESTS, os.pardir, "deploy", "samples", "clusters13.gcode")
        for name, arguments in {
            "damat.svg": ["optimize", SMALL],
            "gcode.svg": ["optimize", gcode, "-o", self.path("out.gcode"), "--strategy=greedy"],
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

    def test_moves_that_cannot_be_read_are_named(self):
        sample = os.path.join(TESTS, os.pardir, "deploy", "samples", "clusters13.gcode")
        lines = read(sample).splitlines()
        place = next(i for i, line in enumerate(lines) if line.startswith("G1 X") and i > 1000)
        lines[place] = lines[place].replace("G1 ", "G1 (here) ")
        name = self.put("odd.gcode", "\n".join(lines) + "\n")
        said = self.succeed("optimize", name, "-o", self.path("out.gcode"), "--strategy=greedy")
        self.assertIn(f"1 line begins as a move does, but cannot be read (first in {name}:{place + 1}), "
                      "and nothing passes such a line\n", said)

    def test_what_is_allowed_beside_the_policy(self):
        gcode = os.path.join(TESTS, "data", "gcode", "sl_clusters13_brim.gcode.xz")
        plain = self.path("plain.gcode")
        with lzma.open(gcode, "rb") as packed, open(plain, "wb") as file:
            file.write(packed.read())
        made = self.path("made.gcode")
        out = self.succeed("optimize", plain, "-o", made, "--allow=infill_order", "--strategy=ni2opt")
        self.assertRegex(out, r"travel [0-9.]+ -> [0-9.]+ m \(-[1-9]")
        self.assertIn(", policy safe, allow infill_order: travel", read(made))
        self.assertIn("(policy safe, infill_order)", self.succeed("verify", plain, made))
        code, _, err = self.run_traverse("verify", plain, made, "--policy=safe", "--allow=")
        self.assertEqual(code, 1)
        self.assertIn("(order; ", err)
        self.assertIn("--allow=doors", self.fail_with(2, "optimize", plain, "-o", made, "--allow=doors"))

    def test_fast_is_written_to_the_head_and_read_there(self):
        line = "G1 X0 Y{0} F9000\nG1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 X9 Y{0} E.3\nG1 E-1 F2100\n"
        plain = self.put("plain.gcode", "M83\nG1 E-1 F2100\n;LAYER_CHANGE\nG1 Z.2 F9000\n" +
                         "".join(line.format(y) for y in (0, 30, 5, 35, 10, 40)))
        made = self.path("made.gcode")
        self.succeed("optimize", plain, "-o", made, "--policy=fast")
        self.assertIn(", policy fast: travel", read(made))
        self.assertIn("(policy fast)", self.succeed("verify", plain, made))
        self.assertIn("(policy fast)", self.succeed("verify", plain, made, "--policy=fast"))

    def test_verify_answers_by_exit_code_and_rule_by_rule(self):
        line = "G1 E-1 F2100\nG1 X0 Y{0} F9000\nG1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 X9 Y{0} E.3\n"
        text = "M83\n;LAYER_CHANGE\nG1 Z.2 F9000\n" + "".join(line.format(y) for y in (0, 5, 10))
        plain = self.put("plain.gcode", text)
        deeper = self.put("deeper.gcode", text.replace("E-1 F2100\nG1 X0 Y10 F9000\nG1 E1 ",
                                                       "E-1.8 F2100\nG1 X0 Y10 F9000\nG1 E1.8 "))
        findings = self.path("findings.json")
        self.assertEqual(self.succeed("verify", plain, plain, "--quiet", f"--json={findings}"), "")
        same = json.loads(read(findings))
        self.assertTrue(same["same"])
        self.assertEqual((same["policy"], same["allow"]), ("safe", []))
        self.assertTrue(all(rule["breaks"] == 0 and rule["first"] is None for rule in same["rules"]))

        code, out, err = self.run_traverse("verify", plain, deeper, f"--json={findings}", "--policy=free")
        self.assertEqual((code, out), (1, ""))
        self.assertRegex(err, r"deeper.gcode:16: leaves by retraction of 1.8000 mm; .* \(made_of_parts; .*plain.gcode")
        other = json.loads(read(findings))
        self.assertFalse(other["same"])
        self.assertEqual(other["policy"], "free")
        self.assertEqual([rule["rule"] for rule in other["rules"]], [rule["rule"] for rule in same["rules"]])
        broken = [rule for rule in other["rules"] if rule["breaks"]]
        self.assertEqual([rule["rule"] for rule in broken], ["made_of_parts", "kept_travel"])
        self.assertEqual(broken[0]["breaks"], 1)
        self.assertEqual(broken[0]["first"]["optimised_line"], 16)
        self.assertIn(broken[0]["first"]["message"], err)

        self.assertIn("No such file", self.fail_with(INPUT, "verify", plain, self.path("none.gcode")))
        self.assertIn("--policy=wild", self.fail_with(2, "verify", plain, plain, "--policy=wild"))
        self.assertIn("OPTIMISED is missing", self.fail_with(2, "verify", plain))

    def test_reports_of_gcode_state_what_the_files_amount_to(self):
        gcode = os.path.join(TESTS, os.pardir, "deploy", "samples", "clusters13.gcode")
        page = self.path("page.html")
        routes = self.path("routes.json")
        out = self.succeed("optimize", gcode, "-o", self.path("out.gcode"), f"--report={page}", f"--json={routes}",
                           "--strategy=greedy")
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
        said = self.fail_with(INPUT, "optimize", sliced, "--quiet", "--strategy=greedy", f"--picture={folder}")
        self.assertIn("folder.png: Is a directory", said)
        self.assertEqual(read(sliced), before)
        self.assertEqual(sorted(os.listdir(self.folder)), ["folder.png", "part.gcode"])


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

    def test_a_bound_of_all_layers_together_if_asked_for(self):
        def total(*flags):
            return self.optimize(PART1, "--layers=1-3", *flags)["total"]

        asked = "--option=chain_bound=true"
        proven = total("--strategy=exact", asked)
        quick = total("--strategy=auto", asked)

        # Each layer is proven for its own start, and yet ending elsewhere would save travel.
        self.assertAlmostEqual(proven["lower_bound_mm"], proven["travel_mm"])
        self.assertLess(proven["chain_lower_bound_mm"], 0.99 * proven["travel_mm"])
        self.assertLessEqual(proven["chain_lower_bound_mm"], quick["travel_mm"] * (1 + 1e-9))
        self.assertLessEqual(quick["chain_lower_bound_mm"], proven["chain_lower_bound_mm"] * (1 + 1e-9))
        self.assertGreater(quick["chain_lower_bound_mm"], 0)
        self.assertNotIn("chain_lower_bound_mm", total("--strategy=exact"))

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
            {"kind": "contour", "island": 1, "id": 1, "entry": 0, "at": [10.0, 10.0]},
            {"kind": "contour", "island": 1, "id": 7, "entry": 0, "at": [15.0, 15.0]},
            {"kind": "contour", "island": 9, "id": 1, "entry": 0, "at": [-50.25, 0.1]},
            {"kind": "raster", "island": 1, "id": 1, "reversed": False, "from": [11.0, 11.0],
             "to": [29.0, 11.0]},
            {"kind": "raster", "island": 1, "id": 4, "reversed": False, "from": [29.0, 29.0],
             "to": [11.0, 29.0]}])
        self.assertEqual(document["layers"][1]["route"], [])
        self.assertAlmostEqual(document["total"]["idle_seconds"], document["total"]["travel_mm"] / 20.32)
        self.check(SMALL, document)

    def test_routes_hold_for_every_way_to_do_a_job(self):
        quick = "--option=effort=0.1"
        for flags, expected in [
            ([], {}),
            (["--strategy=none"], {}),
            ([quick, "--deposition=interleaved"], {"interleaved": True}),
            ([quick, "--cleaning_every=2", "--cleaning_point=5,-10.5"], {"cleaning": (2, (5, -10.5))}),
            ([quick, "--cleaning_every=5", "--cleaning_point=0,0"], {"cleaning": (5, (0, 0))}),
            ([quick, "--layers=2-4"], {"first": 2}),
            ([quick, "--layers=3"], {"first": 3}),
            ([quick, "--cost=time", "--travel_speed=60", "--travel_accel=500"], {}),
            ([quick, "--threads=1", "--seed=18446744073709551615"], {}),
            ([quick, "--deadline=30s", "--layer_time_limit=1s"], {}),
        ]:
            with self.subTest(flags):
                self.check(PART1, self.optimize(PART1, *flags), **expected)

    def test_the_checker_finds_faults(self):
        given = self.optimize(PART1, "--option=effort=0.1")
        part = check_routes.read_part(check_routes.read_text(PART1))

        def faults(change):
            document = copy.deepcopy(given)
            change(document)
            checker = check_routes.Checker(part)
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

    def start_from(self, text, *flags, strategy="none"):
        """The document of `text` as a part that begins with routes.json, and what the command said."""
        name, new = self.put("edited.damat", text), self.path("new.json")
        said = self.succeed("optimize", name, f"--strategy={strategy}", f"--start_from={self.path('routes.json')}",
                            f"--json={new}", *flags)
        return name, json.loads(read(new)), said

    def test_a_job_begins_with_earlier_routes(self):
        earlier = self.path("routes.json")
        self.succeed("optimize", PART1, "--quiet", f"--json={earlier}")
        known = json.loads(read(earlier))
        # `none` keeps what it begins with; no other answers anything worse.
        for strategy in self.strategies():
            _, document, said = self.start_from(read(PART1), "--option=time_limit=0.1" if strategy == "exact" else "--seed=2",
                                                strategy=strategy)
            self.assertIn("began with known routes of 5 of 5 layers (53 of 53 paths in them)\n", said)
            for old, new in zip(known["layers"], document["layers"]):
                if strategy == "none":
                    self.assertEqual(new["route"], old["route"])
                if new["start"] == old["start"]:
                    self.assertLessEqual(new["travel_mm"], old["travel_mm"] * (1 + 1e-12))
            self.check(PART1, document)

    def test_a_part_that_was_edited_keeps_the_order_of_the_rest(self):
        lines = read(PART1).splitlines(True)
        contours = [i for i, line in enumerate(lines) if line.startswith("C")]
        gone, moved = contours[-1], contours[-2]
        edited = lines[:]
        edited[moved] = re.sub(r"X([-+.0-9e]+)", lambda x: f"X{float(x[1]) + 0.5}", edited[moved])
        del edited[gone]
        island = max(i for i in range(gone) if lines[i].startswith("I"))
        label, count, rest = edited[island].split(",", 2)
        edited[island] = f"{label},{int(count) - 1},{rest}"
        self.succeed("optimize", PART1, "--quiet", f"--json={self.path('routes.json')}", "--strategy=ni2opt")
        known = json.loads(read(self.path("routes.json")))

        name, document, said = self.start_from("".join(edited))

        self.assertIn("began with known routes of 5 of 5 layers (52 of 52 paths in them)\n", said)
        self.check(name, document)
        for flags, extra in (["--deposition=interleaved"], {"interleaved": True}), (["--layers=2-3"], {"first": 2}):
            name, document, _ = self.start_from("".join(edited), *flags, strategy="ni2opt")
            self.check(name, document, **extra)
        self.assertEqual(document["layers"][0]["id"], known["layers"][1]["id"])

    def test_sliced_files_begin_with_earlier_routes_too(self):
        gcode = os.path.join(TESTS, os.pardir, "deploy", "samples", "clusters13.gcode")
        earlier, again = self.path("routes.json"), self.path("again.json")
        self.succeed("optimize", gcode, "--quiet", "--strategy=ni2opt", f"--json={earlier}")
        said = self.succeed("optimize", gcode, "--strategy=none", f"--start_from={earlier}", f"--json={again}")
        self.assertRegex(said, r"began with known routes of (\d+) of \1 layers \((\d+) of \2 paths in them\)\n")
        self.assertEqual([layer["route"] for layer in json.loads(read(again))["layers"]],
                         [layer["route"] for layer in json.loads(read(earlier))["layers"]])
        self.succeed("optimize", gcode, "--quiet", "--strategy=greedy", f"--start_from={earlier}",
                     "-o", self.path("out.gcode"))
        self.succeed("verify", gcode, self.path("out.gcode"))

    def test_pictures_show_what_was_given_beside_what_was_begun_with(self):
        routes, page = self.path("routes.json"), self.path("page.html")
        self.succeed("optimize", PART1, "--quiet", "--strategy=ni2opt", f"--json={routes}")
        self.succeed("optimize", PART1, "--quiet", "--strategy=ni2opt", f"--start_from={routes}", f"--report={page}")
        scene = json.loads(re.search(r'<script id="scene" type="application/json">(.*?)</script>', read(page))[1])
        given = json.loads(read(routes))["total"]["travel_given_mm"]
        self.assertAlmostEqual(scene["routes"][0]["travel"], given, places=2)

    def test_what_is_no_earlier_result_is_refused(self):
        reason = "not what `traverse optimize --json` writes: "
        api = self.path("api.json")
        self.succeed("convert", SMALL, "-o", api)
        for name, message in [
                (SMALL, f"{SMALL}: {reason}it is not JSON, or is cut short"),
                (api, f'{api}: {reason}layers[0]: "id" is not a whole number up to 18446744073709551615'),
                (self.put("empty.json", ""), f"{self.path('empty.json')}: {reason}it is not JSON, or is cut short"),
                (self.path("gone.json"), f"{self.path('gone.json')}: No such file or directory")]:
            code, _, err = self.run_traverse("optimize", SMALL, f"--start_from={name}", "--json=-")
            self.assertEqual((code, err), (INPUT, message + "\n"))
        code, _, err = self.run_traverse("optimize", "-", "--start_from=-", "--json=-")
        self.assertEqual(code, USAGE)
        self.assertIn("only one of INPUT and --start_from can be standard input", err)

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
            piped = self.succeed("optimize", "-", "--json=-", "--quiet", "--strategy=ni2opt", stdin=file.read())
        self.assertEqual(json.loads(piped)["layers"][0]["route"],
                         self.optimize(PART1, "--strategy=ni2opt")["layers"][0]["route"])


class OtherCommands(CommandLine):
    def test_compare_prints_a_row_for_each_strategy(self):
        out = self.succeed("compare", PART1, "--strategies=none,greedy", "--layers=1-2", "--quiet")
        rows = [line.split()[0] for line in out.splitlines()[1:] if not line.startswith("-")]
        self.assertEqual(rows, ["strategy", "none", "greedy"])

    def test_compare_prints_what_the_frameworks_reductions_leave(self):
        out = self.succeed("compare", PART1, "--strategies=greedy,tabu:diversifications=5", "--layers=1-2", "--quiet")
        self.assertIn("contour points per layer", out)
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

    def test_strategies_lists_the_default_and_what_else_the_server_can_do(self):
        listed = self.succeed("strategies")
        self.assertIn("(default)", listed)
        document = json.loads(self.succeed("strategies", "--json=-"))

        self.assertEqual(sorted(document["capabilities"]), document["capabilities"])
        self.assertIn("partial_answers", document["capabilities"])
        self.assertTrue(listed.endswith(
            f"\n(server {document['server_version']}, capabilities: {', '.join(document['capabilities'])})\n"))
        self.assertEqual(document["default_strategy"], "auto")
        self.assertEqual([strategy["name"] for strategy in document["strategies"]],
                         ["none", "greedy", "ni2opt", "auto", "tabu", "exact"])


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
        self.succeed("optimize", PART1, "--quiet", "--strategy=greedy", f"--server={dead_address},{address}")

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
