"""Stand-ins for the servers of printers: OctoPrint, Moonraker and PrusaLink, as far as uploads go."""
import http.server
import json
import re
import threading
import time


def parts_of(body, content_type):
    """The parts of a form: name -> (file name or None, bytes)."""
    boundary = re.search(r"boundary=\"?([^\";]+)", content_type).group(1).encode()
    found = {}
    for part in body.split(b"--" + boundary)[1:-1]:
        head, content = part[2:-2].split(b"\r\n\r\n", 1)
        name = re.search(rb'name="([^"]*)"', head).group(1).decode()
        file = re.search(rb'filename="([^"]*)"', head)
        found[name] = (file.group(1).decode() if file else None, content)
    return found


class PrinterStandIn:
    """One server on a port of its own. `uploads` has what came, `keys` what each request showed; `fail`, `delay` and
    `trickles` make it answer badly, late or without an end; while it is `away` a Moonraker takes files and prints nothing."""

    def __init__(self, key="secret"):
        self.uploads = []
        self.keys = []
        self.fail = 0
        self.delay = 0
        self.trickles = False
        self.away = False
        stand_in = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def log_message(self, *arguments):
                pass

            def answer(self, status, document):
                body = json.dumps(document).encode()
                self.send_response(status)
                self.send_header("Content-Type", "application/json")
                self.send_header("Content-Length", str(len(body)))
                self.end_headers()
                self.wfile.write(body)

            def body(self):
                if "chunked" not in self.headers.get("Transfer-Encoding", ""):
                    return self.rfile.read(int(self.headers.get("Content-Length", 0)))
                out = b""
                while size := int(self.rfile.readline(), 16):
                    out += self.rfile.read(size)
                    self.rfile.readline()
                return out

            def trickle(self):
                """A head without an end, a letter at a time, until the other side has had enough."""
                try:
                    self.wfile.write(b"HTTP/1.1 200 OK\r\nX: ")
                    while True:
                        self.wfile.write(b"x")
                        time.sleep(0.1)
                except OSError:
                    self.close_connection = True

            def handled(self):
                """Whether all has been said: a key that is wrong, a fault that was asked for."""
                stand_in.keys.append(self.headers.get("X-Api-Key"))
                time.sleep(stand_in.delay)
                if stand_in.trickles:
                    self.trickle()
                    return True
                if self.headers.get("X-Api-Key") != key:
                    self.answer(403, {"error": "You don't have the permission"})
                    return True
                if stand_in.fail:
                    self.answer(stand_in.fail, {"error": "no"})
                    return True
                return False

            def do_GET(self):
                if self.handled():
                    return
                if self.path == "/api/version":
                    self.answer(200, {"api": "0.1", "server": "1.9.3", "text": "OctoPrint 1.9.3"})
                elif self.path == "/server/info":
                    self.answer(200, {"result": {"klippy_state": "ready"}})
                else:
                    self.answer(404, {})

            def do_POST(self):
                body = self.body()
                if self.handled():
                    return
                parts = parts_of(body, self.headers["Content-Type"])
                name, content = parts.pop("file")
                fields = {key: value[1].decode() for key, value in parts.items()}
                stand_in.uploads.append((self.path, name, content, fields))
                if self.path == "/server/files/upload":
                    self.answer(201, {"item": {"path": name, "root": "gcodes"},
                                      "print_started": fields.get("print") == "true" and not stand_in.away})
                elif self.path in ("/api/files/local", "/api/files/sdcard"):
                    self.answer(201, {"files": {"local": {"name": name, "origin": "local"}}, "done": True})
                else:
                    self.answer(404, {})

            def do_PUT(self):
                body = self.body()
                if self.handled():
                    return
                fields = {"print": self.headers["Print-After-Upload"], "overwrite": self.headers["Overwrite"]}
                stand_in.uploads.append((self.path, None, body, fields))
                self.answer(201, {"name": "x"})

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.url = f"http://127.0.0.1:{self.server.server_address[1]}"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def close(self):
        self.server.shutdown()
        self.server.server_close()
