"""Servers that ask for TLS, client certificates and tokens, as the commands reach them.

The environment names the binaries: TRAVERSE, TRAVERSE_SERVER and TRAVERSE_LOADGEN.
"""
import hashlib
import os
import socket
import subprocess
import sys
import tempfile
import unittest

sys.path.append(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from test_certificates import make_certificates

TESTS = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SMALL = os.path.join(TESTS, "data", "damat", "two_islands.damat")
TOKEN = "not-a-real-token-but-long-enough"

DONE, USAGE, NO_SERVER = 0, 2, 3


class Security(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = cls.temporary.name
        make_certificates(cls.folder)
        cls.put("tokens", "farm-1 " + hashlib.sha256(TOKEN.encode()).hexdigest() + "\n")
        cls.put("token", TOKEN + "\n")
        cls.put("wrong", "another-token\n")
        cls.put("empty", "")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def put(cls, name, content):
        with open(cls.path(name), "w", encoding="utf-8") as file:
            file.write(content)

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    def serve(self, *flags):
        server = subprocess.Popen(
            [os.environ["TRAVERSE_SERVER"], "--listen=127.0.0.1:0", "--metrics_listen=", "--log_file=/dev/null", *flags],
            stdout=subprocess.PIPE, text=True)
        self.addCleanup(server.stdout.close)
        self.addCleanup(server.wait)
        self.addCleanup(server.kill)
        return server.stdout.readline().split()[-1]

    def tls(self, *more):
        return self.serve("--tls_certificate=" + self.path("server.pem"), "--tls_key=" + self.path("server.key"), *more)

    def run_program(self, name, *arguments, env=None):
        ran = subprocess.run([os.environ[name], *arguments], capture_output=True, timeout=60, text=True,
                             env={**os.environ, **(env or {})})
        return ran.returncode, ran.stdout, ran.stderr

    def strategies(self, *arguments, env=None):
        return self.run_program("TRAVERSE", "strategies", *arguments, env=env)

    def need_localhost(self):
        try:
            socket.getaddrinfo("localhost", None)
        except OSError:
            self.skipTest("this system does not know localhost, such as one that a bare debootstrap made")

    def test_tls_by_authority_and_name(self):
        self.need_localhost()
        port = self.tls()
        ca = "--tls_ca=" + self.path("ca.pem")
        self.assertEqual(self.strategies(f"--server=localhost:{port}", ca)[0], DONE)
        self.assertEqual(self.strategies(f"--server=127.0.0.1:{port}", ca, "--tls_name=farm.test")[0], DONE)
        self.assertEqual(self.strategies(f"--server=127.0.0.1:{port},localhost:{port}", ca, "--tls_name=farm.test")[0], DONE)
        for arguments in [[f"--server=127.0.0.1:{port}", ca],
                          [f"--server=localhost:{port}", "--tls_ca=" + self.path("other.pem")],
                          [f"--server=localhost:{port}", "--tls"],
                          [f"--server=localhost:{port}"]]:
            with self.subTest(arguments):
                self.assertEqual(self.strategies(*arguments)[0], NO_SERVER)

    def test_mutual_tls(self):
        self.need_localhost()
        port = self.tls("--tls_client_ca=" + self.path("ca.pem"))
        server = [f"--server=localhost:{port}", "--tls_ca=" + self.path("ca.pem")]
        mine = ["--tls_certificate=" + self.path("client.pem"), "--tls_key=" + self.path("client.key")]
        code, _, err = self.run_program("TRAVERSE", "optimize", SMALL, "--quiet", "--strategy=greedy",
                                        "--json=/dev/null", *server, *mine)
        self.assertEqual((code, err), (DONE, ""))
        self.assertEqual(self.strategies(*server)[0], NO_SERVER)

    def test_tokens_from_a_file_and_from_the_environment(self):
        port = self.serve("--token_file=" + self.path("tokens"))
        server = f"--server=127.0.0.1:{port}"
        self.assertEqual(self.strategies(server, "--token_file=" + self.path("token"))[0], DONE)
        self.assertEqual(self.strategies(server, env={"TRAVERSE_TOKEN": TOKEN})[0], DONE)
        for arguments in [[server], [server, "--token_file=" + self.path("wrong")]]:
            code, _, err = self.strategies(*arguments)
            self.assertEqual(code, NO_SERVER)
            self.assertIn("UNAUTHENTICATED", err)
        code, out, _ = self.run_program("TRAVERSE_LOADGEN", f"--target=127.0.0.1:{port}", "--rate=20", "--duration=200ms",
                                        "--token_file=" + self.path("token"))
        self.assertEqual(code, DONE)
        self.assertNotIn(TOKEN, out)

    def test_a_token_goes_to_other_machines_encrypted(self):
        server = "--server=192.0.2.1:9"
        code, _, err = self.strategies(server, env={"TRAVERSE_TOKEN": TOKEN})
        self.assertEqual((code, err), (USAGE, "traverse strategies: the token would go to another machine unencrypted; "
                                              "use --tls, or --insecure\n"))

    def test_faults_are_named(self):
        ca, pem, missing = self.path("ca.pem"), self.path("token"), self.path("missing")
        cases = [
            (["--server=localhost:1", "--tls_ca=" + missing], f"--tls_ca: cannot read {missing}"),
            (["--server=localhost:1", "--tls_ca=" + pem], f"--tls_ca: {pem} contains nothing in PEM format"),
            (["--server=localhost:1", "--tls_certificate=" + ca], "--tls_certificate and tls_key must be given together"),
            (["--server=a.test:1,b.test:1", "--tls_ca=" + ca],
             "--tls_name: with several servers, give the name that their certificates share"),
            (["--server=localhost:1", "--token_file=" + missing], f"--token_file={missing}: cannot be read, or is empty"),
            (["--server=localhost:1", "--token_file=" + self.path("empty")],
             f"--token_file={self.path('empty')}: cannot be read, or is empty"),
            (["--server=localhost:1", "--tls=false", "--tls_ca=" + ca], "--tls=false contradicts the other TLS flags"),
            (["--tls_ca=" + ca], "--tls_ca needs --server"),
        ]
        for arguments, message in cases:
            with self.subTest(arguments):
                code, _, err = self.strategies(*arguments)
                self.assertEqual((code, err), (USAGE, f"traverse strategies: {message}\n"))


if __name__ == "__main__":
    unittest.main()
