#!/usr/bin/python3
"""Builds the Python client, installs wheel and sdist in fresh environments, and runs its cases with what is installed."""

import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path.append(str(ROOT))
from tests.support import short_part


def run(*command, **more):
    subprocess.run([str(word) for word in command], check=True, **more)


def environment(folder, package):
    """A fresh environment with the package and what Debian has of its needs."""
    python = folder / "bin/python"
    run("/usr/bin/python3", "-m", "venv", "--without-pip", "--system-site-packages", folder)
    # Debian's pip, which is among what the environment has; `--python` would start it twice.
    run(python, "-m", "pip", "install", "-q", "--no-index", "--no-build-isolation", "--no-deps", package)
    return python


def main():
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        run(ROOT / "client/python/build.sh", work / "dist", stdout=subprocess.DEVNULL)
        wheel, = (work / "dist").glob("*.whl")
        sdist, = (work / "dist").glob("*.tar.gz")
        from_source = environment(work / "from_source", sdist)
        run(from_source, "-c", "import traverse_client; traverse_client.TravelOptimizer(['127.0.0.1:1']).close()", cwd=work)
        python = environment(work / "installed", wheel)
        short_part.write(work / "short.gcode")
        more = dict(os.environ, GRPC_VERBOSITY="NONE", TRAVERSE_GUIDE=str(ROOT / "client/python/README.md"),
                    TRAVERSE_EXAMPLES=str(ROOT / "deploy/examples/python"),
                    TRAVERSE_SAMPLE=str(short_part.SAMPLE), TRAVERSE_SHORT=str(work / "short.gcode"),
                    PYTHONDONTWRITEBYTECODE="1")
        return subprocess.run([python, HERE / "cases.py", *sys.argv[1:]], cwd=work, env=more, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
