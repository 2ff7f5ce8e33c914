"""Who may send files to the gateway: TLS, client certificates, tokens, plaintext.

The environment names the binaries: TRAVERSE and TRAVERSE_GATEWAY.
"""
import hashlib
import http.client
import os
import signal
import socket
import ssl
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path += [HERE, os.path.dirname(HERE)]
from gateway_process import Gateway, detail, lines_of_infill, optimised_by_command
from test_certificates import make_certificates

TOKEN = "not-a-real-token-but-long-enough"
PART = lines_of_infill(2)


class Security(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = cls.temporary.name
        make_certificates(cls.folder)
        with open(cls.path("tokens"), "w", encoding="utf-8") as file:
            file.write("farm-1 " + hashlib.sha256(TOKEN.encode()).hexdigest() + "\n")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    def start(self, *flags):
        gateway = Gateway(*flags)
        self.addCleanup(gateway.close)
        return gateway

    def ask_tls(self, gateway, certificate=None):
        context = ssl.create_default_context(cafile=self.path("ca.pem"))
        if certificate:
            context.load_cert_chain(self.path(certificate + ".pem"), self.path(certificate + ".key"))
        connection = http.client.HTTPSConnection("localhost", gateway.http_port, context=context, timeout=30)
        try:
            connection.request("POST", "/v1/gcode", PART)
            answer = connection.getresponse()
            return answer.status, answer.read()
        finally:
            connection.close()

    def test_tokens(self):
        gateway = self.start("--token_file=" + self.path("tokens"))
        for headers, status in [({}, 401), ({"Authorization": "Bearer wrong"}, 401), ({"X-Api-Key": "wrong"}, 401),
                                ({"Authorization": "Basic " + TOKEN}, 401), ({"Authorization": "Bearer " + TOKEN}, 200),
                                ({"X-Api-Key": TOKEN}, 200)]:
            answer = gateway.ask("POST", "/v1/gcode", PART, headers)
            self.assertEqual(answer[0], status, headers)
            if status == 401:
                self.assertEqual(answer[1]["www-authenticate"], "Bearer")
        self.assertEqual(gateway.ask("GET", "/metrics")[0], 401)
        self.assertEqual(gateway.ask("GET", "/readyz")[0], 200)
        self.assertEqual(gateway.ask("GET", "/")[0], 200)
        with open(gateway.log.name, encoding="utf-8") as log:
            self.assertNotIn(TOKEN, log.read())

    def test_with_tokens_any_name_of_the_gateway_will_do(self):
        gateway = self.start("--token_file=" + self.path("tokens"))
        headers = {"Authorization": "Bearer " + TOKEN, "Host": "farm.example"}
        self.assertEqual(gateway.ask("POST", "/v1/gcode", PART, headers)[0], 200)
        strict = self.start("--token_file=" + self.path("tokens"), "--allowed_hosts=other.example")
        self.assertEqual(strict.ask("POST", "/v1/gcode", PART, headers)[0], 421)

    def test_a_refused_caller_sends_nothing_into_the_spool(self):
        gateway = self.start("--token_file=" + self.path("tokens"))
        status, _, body = gateway.ask("POST", "/v1/gcode", PART)
        self.assertEqual(status, 401)
        self.assertIn("token", detail(body))

    def test_tls(self):
        gateway = self.start("--tls_certificate=" + self.path("server.pem"), "--tls_key=" + self.path("server.key"))
        self.assertEqual(self.ask_tls(gateway), (200, optimised_by_command(PART)))
        with self.assertRaises((http.client.HTTPException, OSError)):
            gateway.ask("GET", "/healthz")

    def test_draining_waits_for_no_handshake(self):
        gateway = self.start("--tls_certificate=" + self.path("server.pem"), "--tls_key=" + self.path("server.key"),
                             "--header_timeout=60s", "--drain_timeout=60s")
        with socket.create_connection(("127.0.0.1", gateway.http_port)) as connection:
            connection.sendall(b"\x16\x03\x01")
            self.assertEqual(self.ask_tls(gateway), (200, optimised_by_command(PART)))  # it has come
            gateway.process.send_signal(signal.SIGTERM)
            self.assertEqual(gateway.process.wait(timeout=20), 0)

    def test_client_certificates(self):
        tls = ["--tls_certificate=" + self.path("server.pem"), "--tls_key=" + self.path("server.key"),
               "--tls_client_ca=" + self.path("ca.pem")]
        gateway = self.start(*tls)
        self.assertEqual(self.ask_tls(gateway, "client")[0], 200)
        for certificate in [None, "other"]:
            with self.assertRaises((ssl.SSLError, OSError, http.client.HTTPException)):
                self.ask_tls(gateway, certificate)
        named = self.start(*tls, "--allowed_clients=farm.test")
        self.assertEqual(self.ask_tls(named, "client")[0], 200)
        others = self.start(*tls, "--allowed_clients=somebody.test")
        self.assertEqual(self.ask_tls(others, "client")[0], 403)

    def test_a_new_certificate_counts_for_new_connections(self):
        for name in ["server.pem", "server.key"]:
            with open(self.path(name), "rb") as source, open(self.path("live-" + name), "wb") as live:
                live.write(source.read())
        gateway = self.start("--tls_certificate=" + self.path("live-server.pem"),
                             "--tls_key=" + self.path("live-server.key"))
        self.assertEqual(self.ask_tls(gateway)[0], 200)
        for name in ["pem", "key"]:
            with open(self.path("other." + name), "rb") as source, open(self.path("live-server." + name), "wb") as live:
                live.write(source.read())
        import time
        deadline = time.time() + 10
        while time.time() < deadline:
            try:
                self.ask_tls(gateway)
            except ssl.SSLError:
                return
            time.sleep(0.2)
        self.fail("the old certificate is still shown")

    def test_what_does_not_fit_ends_the_start(self):
        for flags, code, words in [
                (["--listen_http=0.0.0.0:0"], 2, "--insecure"),
                (["--tls_certificate=" + self.path("server.pem")], 2, "private key"),
                (["--tls_certificate=" + self.path("server.pem"), "--tls_key=" + self.path("client.key")], 2, "client.key"),
                (["--tls_certificate=/not/there", "--tls_key=/not/there"], 2, "/not/there"),
                (["--token_file=/not/there"], 2, "/not/there"),
                (["--allowed_clients=x"], 2, "tls_client_ca"),
                (["--workers=-1"], 2, "--workers: -1 is below 0"),
                (["--max_time=0s"], 2, "--max_time"),
                (["--colour=red"], 2, "unknown flag --colour"),
                (["--server=nowhere"], 2, "--server"),
                (["--server_tls"], 2, "--server"),
                (["--listen_http=127.0.0.1"], 2, "HOST:PORT")]:
            command = [os.environ["TRAVERSE_GATEWAY"], "--listen_http=127.0.0.1:0", "--listen=", "--metrics_listen=", *flags]
            done = subprocess.run(command, capture_output=True, text=True, timeout=30)
            self.assertEqual(done.returncode, code, (flags, done.stderr))
            self.assertIn(words, done.stderr)


if __name__ == "__main__":
    unittest.main()
