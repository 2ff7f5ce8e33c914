"""The gateway's OpenAPI document against the schema of OpenAPI 3.1, and against what the gateway answers to.

Skips without npm. The environment names the binaries: TRAVERSE and TRAVERSE_GATEWAY.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path += [HERE, os.path.normpath(os.path.join(HERE, *[os.pardir] * 3))]
from gateway_process import Gateway, lines_of_infill
from tests.support import node_packages

SKIPPED = 77


def answers_are_described(gateway, document):
    """Each path answers as the document says, each parameter is taken, and no other."""
    for path, methods in document["paths"].items():
        for method, described in methods.items():
            if method == "parameters":
                continue
            status, headers, _ = gateway.ask(method.upper(), path, b"nothing" if method == "post" else None)
            assert str(status) in described["responses"], (path, status)
            content = described["responses"][str(status)]["content"]
            assert headers["content-type"].split(";")[0] in content, (path, headers)
    samples = {"boolean": "true", "string": "1", "array": "effort=1"}
    for parameter in document["paths"]["/v1/gcode"]["post"]["parameters"]:
        schema = parameter["schema"]
        value = schema["enum"][0] if "enum" in schema else samples[schema["type"]]
        _, _, body = gateway.ask("POST", f"/v1/gcode?{parameter['name']}={value}", lines_of_infill(1))
        assert b"unknown parameter" not in body, parameter
    assert b"unknown parameter" in gateway.ask("POST", "/v1/gcode?colour=red", b"x")[2]


def main():
    gateway = Gateway()
    try:
        status, headers, body = gateway.ask("GET", "/openapi.json")
        assert (status, headers["content-type"]) == (200, "application/json")
        answers_are_described(gateway, json.loads(body))
    finally:
        gateway.close()
    with tempfile.TemporaryDirectory() as folder:
        for name in os.listdir(os.path.join(HERE, "openapi")):
            shutil.copy(os.path.join(HERE, "openapi", name), folder)
        missing = node_packages.install(folder)
        if missing:
            print("SKIPPED:", missing)
            sys.exit(SKIPPED)
        done = subprocess.run(["node", "lint.mjs"], cwd=folder, input=body, capture_output=True, check=False)
        assert done.returncode == 0, done.stderr.decode()


if __name__ == "__main__":
    main()
