"""The gateway's page in headless Chromium.

Skips without Node, npm or Chromium. TRAVERSE_SCREENSHOTS names a folder that gets pictures of the page. The environment
names the binaries: TRAVERSE and TRAVERSE_GATEWAY.
"""
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.normpath(os.path.join(HERE, *[os.pardir] * 3))
sys.path += [HERE, SOURCE]
from gateway_process import Gateway, lines_of_infill, optimised_by_command
from tests.support import node_packages

SKIPPED = 77


def skip(reason):
    print("SKIPPED:", reason)
    sys.exit(SKIPPED)


def main():
    found = [shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome") if shutil.which(name)]
    if not found:
        skip("no Chromium")
    with tempfile.TemporaryDirectory() as folder:
        for path in [os.path.join(SOURCE, "tests", "client", "view", "browser", name)
                     for name in ("package.json", "package-lock.json")] + [os.path.join(HERE, "page_test.mjs")]:
            shutil.copy(path, folder)
        missing = node_packages.install(folder)
        if missing:
            skip(missing)
        content = lines_of_infill(40)
        part, expected = os.path.join(folder, "part.gcode"), os.path.join(folder, "expected.gcode")
        for name, bytes_ in [(part, content), (expected, optimised_by_command(content, "--policy=balanced"))]:
            with open(name, "wb") as file:
                file.write(bytes_)
        gateway = Gateway()
        try:
            subprocess.run(["node", "page_test.mjs", found[0], f"http://127.0.0.1:{gateway.http_port}/", part, expected,
                            os.environ.get("TRAVERSE_SCREENSHOTS", folder)], cwd=folder, check=True, timeout=300)
        finally:
            gateway.close()


if __name__ == "__main__":
    main()
