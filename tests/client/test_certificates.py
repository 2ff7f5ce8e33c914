"""Certificates for tests of TLS."""
import os
import subprocess


def openssl(*arguments, cwd):
    subprocess.run(["openssl", *arguments], cwd=cwd, check=True, capture_output=True)


def make_certificates(folder):
    """An authority `ca`, and certificates `server` (for farm.test and localhost) and `client` from it; `other` is not."""
    key = ["-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes"]
    for name in ["ca", "other"]:
        openssl("req", "-x509", *key, "-days", "2", "-subj", "/CN=" + name, "-keyout", name + ".key", "-out",
                name + ".pem", cwd=folder)
    with open(os.path.join(folder, "ext"), "w", encoding="utf-8") as file:
        file.write("subjectAltName=DNS:localhost,DNS:farm.test\n")
    for name in ["server", "client"]:
        openssl("req", *key, "-subj", "/CN=" + name, "-keyout", name + ".key", "-out", name + ".csr", cwd=folder)
        openssl("x509", "-req", "-days", "2", "-CAcreateserial", "-extfile", "ext", "-in", name + ".csr", "-CA", "ca.pem",
                "-CAkey", "ca.key", "-out", name + ".pem", cwd=folder)
