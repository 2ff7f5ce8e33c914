"""An authority, the servers' certificate, a caller's, and a bearer token, made for one test."""

import hashlib
import pathlib
import shutil
import unittest

import support

TOKEN = "a-token-of-the-tests"


class Certificates:
    """Files in `folder`: ca.crt; tls.crt, tls.key and server.pem (both) of the servers; farm.crt and farm.key of
    a caller; tokens, the servers' list; token, the caller's own."""

    def __init__(self, folder):
        if not shutil.which("openssl"):
            raise unittest.SkipTest("no openssl")
        self.folder = pathlib.Path(folder)
        self._openssl("req", "-x509", *self._key("ca"), "-subj", "/CN=tests", "-days", "2", "-out", self.path("ca.crt"))
        self._sign("tls", "traverse", "DNS:traverse,DNS:localhost,IP:127.0.0.1")
        self._sign("farm", "farm", "DNS:farm.example")
        self.path("server.pem").write_text(self.path("tls.crt").read_text() + self.path("tls.key").read_text())
        self.path("tokens").write_text(f"farm {hashlib.sha256(TOKEN.encode()).hexdigest()}\n")
        self.path("token").write_text(TOKEN + "\n")

    def path(self, name):
        return self.folder / name

    @staticmethod
    def _openssl(*words):
        support.run("openssl", *words)

    def _key(self, name):
        return ("-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-keyout", self.path(f"{name}.key"))

    def _sign(self, name, common_name, alternatives):
        request, extensions = self.path(f"{name}.csr"), self.path(f"{name}.ext")
        extensions.write_text(f"subjectAltName={alternatives}\nextendedKeyUsage=serverAuth,clientAuth\n")
        self._openssl("req", "-new", *self._key(name), "-subj", f"/CN={common_name}", "-out", request)
        self._openssl("x509", "-req", "-in", request, "-CA", self.path("ca.crt"), "-CAkey", self.path("ca.key"),
                      "-CAcreateserial", "-days", "2", "-extfile", extensions, "-out", self.path(f"{name}.crt"))
