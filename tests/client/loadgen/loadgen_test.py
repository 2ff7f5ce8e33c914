"""traverse-loadgen as scripts use it, against a server. The environment names the binaries."""
import json
import os
import subprocess
import tempfile
import unittest

LOADGEN = os.environ["TRAVERSE_LOADGEN"]
SERVER = os.environ["TRAVERSE_SERVER"]
TESTS = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PART = os.path.join(TESTS, "data", "damat", "two_islands.damat")

DONE, INPUT, USAGE, NO_SERVER = 0, 1, 2, 3


def run(*arguments):
    ran = subprocess.run([LOADGEN, *arguments], capture_output=True, timeout=60, text=True)
    return ran.returncode, ran.stdout, ran.stderr


class Loadgen(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = subprocess.Popen(
            [SERVER, "--listen=127.0.0.1:0", "--metrics_listen=", "--log_file=/dev/null", "--max_jobs_per_caller=1000"],
            stdout=subprocess.PIPE, text=True)
        cls.target = "--target=127.0.0.1:" + cls.server.stdout.readline().split()[-1]

    @classmethod
    def tearDownClass(cls):
        cls.server.kill()
        cls.server.wait()
        cls.server.stdout.close()

    def test_faults_are_named(self):
        cases = [
            (["--rate=1"], "traverse-loadgen: --target=HOST:PORT is missing"),
            (["--target=x", "--rate=1"], "traverse-loadgen: --target: \"x\" is not HOST:PORT"),
            ([self.target], "traverse-loadgen: give --rate=JOBS_PER_SECOND, or --in_flight=N for a closed loop"),
            ([self.target, "--rate=0"], "traverse-loadgen: --rate=0: not a number from 0.001 to 100000"),
            ([self.target, "--rat=1"], "traverse-loadgen: unknown flag --rat; did you mean --rate?"),
            ([self.target, "--rate=1", "--mix=1:x"],
             "traverse-loadgen: --mix: \"1:x\" is not LAYERS:WEIGHT, such as 10:25"),
            ([self.target, "--rate=1", "--arrivals=odd"],
             "traverse-loadgen: --arrivals=odd: not one of even, poisson"),
            ([self.target, "--rate=1", "more"], "traverse-loadgen: unexpected argument \"more\""),
        ]
        for arguments, message in cases:
            with self.subTest(arguments):
                self.assertEqual(run(*arguments), (USAGE, "", message + "\n"))

    def test_help_fits_the_screen_and_has_an_example_that_works(self):
        code, out, err = run("--help")
        self.assertEqual((code, err), (DONE, ""))
        self.assertLessEqual(max(map(len, out.splitlines())), 80)
        example = out.splitlines()[-1].split()[2:]
        code, out, err = run(self.target, *example[1:], "--duration=300ms", "--warm_up=1ms")
        self.assertEqual((code, err), (DONE, ""))
        self.assertRegex(out, r"\n1 +\d+ +\d+")
        self.assertIn("Latency counts from when a job was due to be sent", out)

    def test_document(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "load.json")
            code, out, err = run(self.target, "--rate=50", "--mix=1:3,5:1", "--duration=1s", "--warm_up=100ms",
                                 "--strategy=greedy", "--json=" + path)
            self.assertEqual((code, err), (DONE, ""))
            with open(path, encoding="utf-8") as file:
                document = json.load(file)
        self.assertEqual(document["strategy"], "greedy")
        self.assertEqual(document["rate"], 50)
        self.assertEqual((document["sent"], document["ok"], document["not_sent"]), (50, 50, 0))
        self.assertEqual([size["layers"] for size in document["sizes"]], [1, 5])
        self.assertEqual(sum(size["ok"] for size in document["sizes"]), 50)
        latency = document["codes"]["OK"]["latency_ms"]
        self.assertLessEqual(0, latency["p50"])
        self.assertLessEqual(latency["p50"], latency["p99"])
        self.assertLessEqual(latency["p99_9"], latency["max"])
        self.assertLessEqual(document["codes"]["OK"]["from_sent_ms"]["mean"], latency["mean"])

    def test_layers_of_a_file_and_a_document_on_stdout(self):
        code, out, err = run(self.target, "--in_flight=2", "--duration=200ms", "--input=" + PART, "--json=-")
        self.assertEqual((code, err), (DONE, ""))
        document = json.loads(out)
        self.assertIsNone(document["rate"])
        self.assertGreater(document["ok"], 0)

    def test_refusals_are_counted_and_explained(self):
        code, out, err = run(self.target, "--rate=50", "--duration=200ms", "--strategy=best")
        self.assertEqual((code, err), (NO_SERVER, "traverse-loadgen: no job was answered\n"))
        self.assertRegex(out, r"INVALID_ARGUMENT +10 ")
        self.assertIn('INVALID_ARGUMENT: options.strategy.name: no strategy "best"', out)

    def test_bad_input(self):
        code, _, err = run(self.target, "--rate=1", "--input=/nowhere.damat")
        self.assertEqual((code, err), (INPUT, "/nowhere.damat: No such file or directory\n"))

    def test_nobody_there(self):
        code, out, err = run("--target=127.0.0.1:1", "--rate=20", "--duration=200ms", "--warm_up=1ms")
        self.assertEqual((code, err), (NO_SERVER, "traverse-loadgen: no job was answered\n"))
        self.assertIn("UNAVAILABLE", out)


if __name__ == "__main__":
    unittest.main()
