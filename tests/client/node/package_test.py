#!/usr/bin/python3
"""Packs the Node client, installs it in a fresh folder, and runs its cases with what is installed."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path.append(str(ROOT))
from tests.support import short_part

SKIPPED = 77


def npm(*arguments, folder):
    return subprocess.run(["npm", *map(str, arguments)], cwd=folder, capture_output=True, text=True, check=False)


def main():
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        # In a copy at the same depth, so that the sources stay as they are.
        shutil.copytree(ROOT / "client/node", work / "client/node", ignore=shutil.ignore_patterns("node_modules", "proto"))
        shutil.copytree(ROOT / "proto", work / "proto")
        shutil.copy(ROOT / "CMakeLists.txt", work)
        packed = npm("pack", "--pack-destination", work, "./client/node", folder=work)
        if packed.returncode:
            sys.exit(packed.stderr)
        farm = work / "farm"
        farm.mkdir()
        (farm / "package.json").write_text('{"type": "module", "private": true}')
        package, = work.glob("traverse-client-*.tgz")
        installed = npm("install", "--no-audit", "--no-fund", package, "typescript@5", "@types/node@20", folder=farm)
        if installed.returncode:
            print(f"skipped: the packages cannot be had here\n{installed.stderr}")
            return SKIPPED
        for name in ("types.ts", "check_types.mjs", "cases.mjs"):
            shutil.copy(HERE / name, farm)
        checked = subprocess.run(["node", "check_types.mjs"], cwd=farm, capture_output=True, text=True, check=False)
        if checked.returncode:
            sys.exit(checked.stdout + checked.stderr)
        shutil.copytree(ROOT / "deploy/examples/node", farm / "examples")
        short_part.write(work / "short.gcode")
        more = dict(os.environ, TRAVERSE_GUIDE=str(ROOT / "client/node/README.md"), TRAVERSE_SAMPLE=str(short_part.SAMPLE),
                    TRAVERSE_SHORT=str(work / "short.gcode"))
        return subprocess.run(["node", "--test", "cases.mjs"], cwd=farm, env=more, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
