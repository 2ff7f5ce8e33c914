"""Packages of Node for a test, as a lock file pins them."""
import pathlib
import shutil
import subprocess

# A registry that cannot be reached is asked once more and no longer: with npm's own patience a machine without one spends
# a minute in each of these tests before it is skipped.
NPM_CI = ("npm", "ci", "--silent", "--no-audit", "--no-fund", "--prefer-offline", "--fetch-retries=1",
          "--fetch-retry-mintimeout=1000", "--fetch-retry-maxtimeout=2000")


def install(folder):
    """`npm ci` in a copy of a folder with a lock file. Returns why the packages cannot be had here; empty if they are there."""
    for program in ("node", "npm"):
        if not shutil.which(program):
            return f"no {program}"
    done = subprocess.run(NPM_CI, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode == 0:
        return ""
    return "npm could not install the locked packages: " + done.stdout + done.stderr


def install_buf(folder):
    """Installs buf there. Returns (its path, "") or (None, why it cannot be had here)."""
    pins = pathlib.Path(__file__).resolve().parents[1] / "deploy" / "buf"
    for path in pins.iterdir():
        shutil.copy(path, folder)
    missing = install(folder)
    # The program is in a package of this machine's processor, which npm leaves out without a word if it cannot be had.
    program = next(pathlib.Path(folder).glob("node_modules/@bufbuild/buf-linux-*/bin/buf"), None)
    return program, "" if program else missing or "npm could not install the program of buf"
