"""The committed page of --report is what its sources make, to the byte. Skips without Node and npm."""
import os
import shutil
import subprocess
import sys
import tempfile

SOURCE = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), *[os.pardir] * 3))
sys.path.append(SOURCE)
from tests.support import node_packages

WEB = os.path.join(SOURCE, "client", "view", "web")
SKIPPED = 77


def skip(reason):
    print("SKIPPED:", reason)
    sys.exit(SKIPPED)


def main():
    with tempfile.TemporaryDirectory() as folder:
        work = os.path.join(folder, "web")
        shutil.copytree(WEB, work, ignore=shutil.ignore_patterns("node_modules", "bundle"))
        missing = node_packages.install(work)
        if missing:
            skip(missing)
        made = os.path.join(folder, "page.html")
        subprocess.run(["node", "build.mjs", made], cwd=work, check=True)
        with open(made, "rb") as new, open(os.path.join(WEB, "bundle", "page.html"), "rb") as committed:
            if new.read() != committed.read():
                sys.exit("the bundle is not current: run `npm ci && npm run build` in client/view/web")


main()
