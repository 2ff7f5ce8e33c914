"""Uploads of slicers to printers, through the gateway, with stand-ins for the printers' servers.

The environment names the binaries: TRAVERSE and TRAVERSE_GATEWAY.
"""
import hashlib
import json
import os
import signal
import socket
import sys
import tempfile
import threading
import time
import unittest

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
from gateway_process import Gateway, detail, form, lines_of_infill, optimised_by_command
from printer_stand_in import PrinterStandIn

PART = lines_of_infill(3)
KEY = {"X-Api-Key": "secret"}


# As PrusaSlicer 2.5 sends it: libcurl's form, in this order.
def prusa_slicer(content, name="part.gcode", print_it="false", more=()):
    return form([("print", print_it), ("path", ""), *more, ("file", name, content)],
                boundary="------------------------6b1f6a7d0a1c2f3e")


class Uploads(unittest.TestCase):
    def setUp(self):
        self.printer = PrinterStandIn()
        self.addCleanup(self.printer.close)
        self.key_file = tempfile.NamedTemporaryFile("w")
        self.addCleanup(self.key_file.close)
        self.key_file.write("secret\n")
        self.key_file.flush()

    def start(self, *flags, **more):
        config = tempfile.NamedTemporaryFile("w", suffix=".json", delete=False)
        self.addCleanup(os.unlink, config.name)
        printers = [{"name": "octo", "url": self.printer.url},
                    {"name": "moon", "kind": "moonraker", "url": self.printer.url},
                    {"name": "link", "kind": "prusalink", "url": self.printer.url, "storage": "usb"},
                    {"name": "keyed", "url": self.printer.url, "api_key_file": self.key_file.name},
                    {"name": "strict", "url": self.printer.url, "on_failure": "refuse"},
                    {"name": "gone", "url": "http://127.0.0.1:1"}]
        with config:
            json.dump({"default": "octo", "printers": printers}, config)
        gateway = Gateway("--printers=" + config.name, *flags, **more)
        self.addCleanup(gateway.close)
        return gateway

    def send(self, gateway, content=PART, path="/api/files/local", headers=KEY, **more):
        body, form_headers = prusa_slicer(content, **more)
        return gateway.ask("POST", path, body, {**form_headers, **headers})

    def test_the_printer_gets_the_optimised_file(self):
        gateway = self.start()
        status, headers, body = self.send(gateway, print_it="true", more=[("select", "true"), ("userdata", "{}")])
        self.assertEqual(status, 201, body)
        self.assertEqual(headers["traverse-sent"], "optimised")
        self.assertTrue(json.loads(body)["done"])
        path, name, content, fields = self.printer.uploads[0]
        self.assertEqual((path, name), ("/api/files/local", "part.gcode"))
        self.assertEqual(content, optimised_by_command(PART))
        self.assertEqual(fields, {"print": "true", "path": "", "select": "true", "userdata": "{}"})
        self.assertEqual(gateway.metric('traverse_gateway_uploads_total{outcome="optimised",printer="octo",reason=""}'), 1)

    def test_requests_as_prusa_slicer_sends_them(self):
        """To the byte as libcurl writes them when called as PrusaSlicer 2.5's Http.cpp and OctoPrint.cpp do."""
        gateway = self.start()
        place = f"127.0.0.1:{gateway.http_port}".encode()
        head = b"Host: " + place + b"\r\nUser-Agent: PrusaSlicer/2.5.0\r\nAccept: */*\r\nX-Api-Key: secret\r\n"
        body = (b"--------------------------d74496d66958873e\r\n"
                b'Content-Disposition: form-data; name="print"\r\n\r\ntrue\r\n'
                b"--------------------------d74496d66958873e\r\n"
                b'Content-Disposition: form-data; name="path"\r\n\r\nfarm/today\r\n'
                b"--------------------------d74496d66958873e\r\n"
                b'Content-Disposition: form-data; name="file"; filename="box \\"A\\" T\xc3\xbcr_0.2mm.gcode"\r\n'
                b"Content-Type: application/octet-stream\r\n\r\n" + PART +
                b"\r\n--------------------------d74496d66958873e--\r\n")
        post = (b"POST /api/files/local HTTP/1.1\r\n" + head + b"Content-Length: %d\r\n" % len(body) +
                b"Content-Type: multipart/form-data; boundary=------------------------d74496d66958873e\r\n")
        with socket.create_connection(("127.0.0.1", gateway.http_port), timeout=30) as connection:
            answers = connection.makefile("rb")

            def answer():
                status, length = answers.readline(), 0
                while (line := answers.readline()) != b"\r\n":
                    if line.lower().startswith(b"content-length:"):
                        length = int(line.split(b":")[1])
                return status, answers.read(length)

            # The test of the connection, then on the same one an upload, and one that waits to be told to go on.
            connection.sendall(b"GET /api/version HTTP/1.1\r\n" + head + b"\r\n")
            status, version = answer()
            self.assertIn(b"200 OK", status)
            self.assertTrue(json.loads(version)["text"].startswith("OctoPrint"))
            connection.sendall(post + b"\r\n" + body)
            self.assertIn(b"201 Created", answer()[0])
            connection.sendall(post + b"Expect: 100-continue\r\n\r\n")
            self.assertEqual(answer(), (b"HTTP/1.1 100 Continue\r\n", b""))
            connection.sendall(body)
            self.assertIn(b"201 Created", answer()[0])
        for path, name, content, fields in self.printer.uploads:
            self.assertEqual((path, content), ("/api/files/local", optimised_by_command(PART)))
            self.assertEqual(fields, {"print": "true", "path": "farm/today"})
            self.assertEqual(name, "box %22A%22 T\u00fcr_0.2mm.gcode")
        self.assertEqual(len(self.printer.uploads), 2)

    def test_a_token_for_the_gateway_is_shown_to_nobody_else(self):
        with tempfile.NamedTemporaryFile("w") as tokens:
            tokens.write("farm-1 " + hashlib.sha256(b"token for the gateway").hexdigest() + "\n")
            tokens.flush()
            gateway = self.start("--token_file=" + tokens.name)
        token = {"X-Api-Key": "token for the gateway"}
        self.assertEqual(self.send(gateway, headers=token)[0], 403)
        self.assertEqual(gateway.ask("GET", "/api/version", headers=token)[0], 403)
        self.assertEqual(self.printer.keys, [None, None])
        both = {"Authorization": "Bearer token for the gateway", "X-Api-Key": "secret"}
        self.assertEqual(self.send(gateway, headers=both)[0], 201)
        self.assertEqual(self.send(gateway, headers={**both, **token})[0], 403)
        self.assertEqual(self.send(gateway, path="/printers/keyed/api/files/local", headers=token)[0], 201)
        self.assertEqual(self.printer.keys[2:], ["secret", None, "secret"])

    def test_no_field_goes_on_that_a_server_keeps_for_itself(self):
        gateway = self.start()
        others = [("root", "config"), ("checksum", "0" * 64), ("file.path", "/etc/passwd"), ("file.name", "x"),
                  ("location", "sdcard"), ("select", "true"), ("noOverwrite", "true")]
        for name in ["octo", "moon", "link"]:
            self.assertEqual(self.send(gateway, path=f"/printers/{name}/api/files/local", more=others)[0], 201)
        octo, moon, _ = (fields for _, _, _, fields in self.printer.uploads)
        self.assertEqual(octo, {"print": "false", "path": "", "select": "true", "noOverwrite": "true"})
        self.assertEqual(moon, {"print": "false", "path": "", "root": "gcodes"})

    def test_each_kind_of_server_in_its_own_words(self):
        gateway = self.start()
        for name, path in [("moon", "/server/files/upload"), ("link", "/api/v1/files/usb/my%20part.gcode"),
                           ("octo", "/api/files/sdcard")]:
            status, headers, body = self.send(gateway, path=f"/printers/{name}/api/files/sdcard", name="my part.gcode",
                                              print_it="true")
            self.assertEqual(status, 201, body)
            self.assertEqual(headers["traverse-sent"], "optimised")
            self.assertTrue(json.loads(body)["done"])
            self.assertEqual(self.printer.uploads[-1][0], path)
            self.assertEqual(self.printer.uploads[-1][2], optimised_by_command(PART))
        self.assertEqual(self.printer.uploads[0][3], {"print": "true", "root": "gcodes", "path": ""})
        self.assertEqual(self.printer.uploads[1][3], {"print": "?1", "overwrite": "?1"})

    def test_a_print_that_did_not_begin_is_not_said_to_have(self):
        gateway = self.start()
        for print_it, away, began in [("true", False, True), ("true", True, False), ("false", False, False)]:
            self.printer.away = away
            status, _, body = self.send(gateway, path="/printers/moon/api/files/local", print_it=print_it)
            self.assertEqual((status, json.loads(body)["effectivePrint"]), (201, began), body)

    def test_a_file_that_needs_too_much_memory_goes_on_as_it_came(self):
        gateway = self.start("--max_memory=16777216")
        status, headers, _ = self.send(gateway, PART)
        self.assertEqual((status, headers["traverse-sent"]), (201, "original"))
        self.assertIn("memory", headers["traverse-reason"])
        self.assertEqual(self.printer.uploads[-1][2], PART)

    def test_version(self):
        gateway = self.start()
        self.assertEqual(json.loads(gateway.ask("GET", "/api/version", headers=KEY)[2])["text"], "OctoPrint 1.9.3")
        text = json.loads(gateway.ask("GET", "/printers/moon/api/version", headers=KEY)[2])["text"]
        self.assertTrue(text.startswith("OctoPrint"), text)
        self.assertEqual(gateway.ask("GET", "/api/version", headers={"X-Api-Key": "wrong"})[0], 403)
        self.assertEqual(gateway.ask("GET", "/printers/gone/api/version", headers=KEY)[0], 502)
        self.assertEqual(gateway.ask("GET", "/printers/none/api/version", headers=KEY)[0], 404)
        self.assertEqual(gateway.ask("GET", "/api/job", headers=KEY)[0], 404)

    def test_what_is_not_understood_goes_on_as_it_came(self):
        gateway = self.start()
        for content in [b"solid a\nendsolid a\n", bytes(range(256)) * 40, b"nF,1\nF1,1\nI1,1,0\nC1,X1,Y1,X2,Y1,X2,Y2\n"]:
            status, headers, _ = self.send(gateway, content)
            self.assertEqual((status, headers["traverse-sent"]), (201, "original"))
            self.assertTrue(headers["traverse-reason"])
            self.assertEqual(self.printer.uploads[-1][2], content)
        name = 'traverse_gateway_uploads_total{outcome="original",printer="octo",reason="not_understood"}'
        self.assertEqual(gateway.metric(name), 3)

    def test_what_is_late_goes_on_as_it_came(self):
        gateway = self.start("--upload_deadline=1s")
        content = lines_of_infill(20000)
        began = time.time()
        status, headers, _ = self.send(gateway, content)
        self.assertLess(time.time() - began, 20)
        self.assertEqual((status, headers["traverse-sent"]), (201, "original"))
        self.assertEqual(self.printer.uploads[-1][2], content)

    def test_a_server_that_is_not_there_costs_no_print(self):
        gateway = self.start("--server=127.0.0.1:1", "--upload_deadline=5s")
        status, headers, _ = self.send(gateway)
        self.assertEqual((status, headers["traverse-sent"]), (201, "original"))
        self.assertEqual(self.printer.uploads[-1][2], PART)

    def test_a_printer_may_take_optimised_files_alone(self):
        gateway = self.start()
        status, _, body = self.send(gateway, b"solid a\n", path="/printers/strict/api/files/local")
        self.assertEqual(status, 422)
        self.assertIn("only optimised files", detail(body))
        self.assertEqual(self.printer.uploads, [])

    def test_a_file_with_our_line_goes_on_as_it_is(self):
        gateway = self.start()
        once = optimised_by_command(PART)
        for path in ["/api/files/local", "/printers/strict/api/files/local"]:
            status, headers, _ = self.send(gateway, once, path=path)
            self.assertEqual((status, headers["traverse-sent"]), (201, "original"))
            self.assertEqual(self.printer.uploads[-1][2], once)

    def test_what_the_printer_says_is_passed_on(self):
        gateway = self.start()
        for status in [409, 415, 500, 507]:
            self.printer.fail = status
            self.assertEqual(self.send(gateway)[0], status)
        self.printer.fail = 0
        self.assertEqual(self.send(gateway, headers={})[0], 403)
        self.assertEqual(self.send(gateway, headers={"X-Api-Key": "wrong"})[0], 403)
        self.assertEqual(self.printer.uploads, [])

    def test_a_printer_that_cannot_be_reached_or_is_slow(self):
        gateway = self.start("--upstream_idle_timeout=1s")
        status, _, body = self.send(gateway, path="/printers/gone/api/files/local")
        self.assertEqual(status, 502)
        self.assertIn("printer gone cannot be reached", detail(body))
        self.printer.delay = 5
        status, _, body = self.send(gateway)
        self.assertEqual(status, 504, body)
        self.printer.delay = 0
        self.printer.trickles = True
        for path in ("/api/files/local", "/printers/moon/api/files/local", "/printers/link/api/files/local"):
            status, _, body = self.send(gateway, path=path)
            self.assertEqual(status, 504, (path, body))
        self.assertEqual(gateway.ask("GET", "/api/version", headers=KEY)[0], 504)

    def test_names_are_not_trusted(self):
        gateway = self.start()
        for name in ["../part.gcode", "a\\part.gcode", "..", "a\x02.gcode", "", "x" * 300]:
            self.assertEqual(self.send(gateway, name=name)[0], 400, name)
        body, headers = form([("path", "../../etc"), ("file", "a.gcode", PART)])
        self.assertEqual(gateway.ask("POST", "/api/files/local", body, {**headers, **KEY})[0], 400)
        body, headers = form([("print", "true")])
        self.assertEqual(gateway.ask("POST", "/api/files/local", body, {**headers, **KEY})[0], 400)
        self.assertEqual(gateway.ask("POST", "/api/files/local", PART, KEY)[0], 400)
        for path in ["/printers/http:%2f%2fevil/api/files/local", "/printers/../api/files/local", "/printers//api/files/local",
                     "/api/files/usb", "/printers/octo"]:
            self.assertIn(self.send(gateway, path=path)[0], (400, 404), path)
        self.assertEqual(self.printer.uploads, [])

    def test_killed_in_the_middle_nothing_half_goes_on(self):
        gateway = self.start()
        answers = []

        def send():
            try:
                answers.append(self.send(gateway, lines_of_infill(300))[0])
            except OSError:
                answers.append(None)

        threads = [threading.Thread(target=send) for _ in range(6)]
        for thread in threads:
            thread.start()
        time.sleep(0.5)
        gateway.process.send_signal(signal.SIGKILL)
        for thread in threads:
            thread.join()
        whole = optimised_by_command(lines_of_infill(300)) if self.printer.uploads else None
        for _, _, content, _ in self.printer.uploads:
            self.assertEqual(content, whole)
        self.assertEqual(os.listdir(gateway.spool.name), [])


class Configuration(unittest.TestCase):
    def test_a_file_that_is_wrong_ends_the_start(self):
        import subprocess
        with tempfile.NamedTemporaryFile("w") as config:
            config.write('{"printers": [{"name": "a", "url": "gopher://a"}]}')
            config.flush()
            done = subprocess.run([os.environ["TRAVERSE_GATEWAY"], "--printers=" + config.name, "--listen_http=127.0.0.1:0",
                                   "--listen=", "--metrics_listen="], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn(config.name + ": printers[0].url: ", done.stderr)


if __name__ == "__main__":
    unittest.main()
