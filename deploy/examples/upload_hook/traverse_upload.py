#!/usr/bin/env python3
"""Sends uploaded G-code (.gcode, .bgcode, .gcode.3mf, .ufp) through `traverse optimize` and keeps the original.

Three ways to use it:

1. Moonraker (Klipper), or any folder that files arrive in: watch it.

       traverse_upload.py --watch ~/printer_data/gcodes --originals ~/originals -- --server=farm:50051

2. One file, for instance from an upload handler of one's own.

       traverse_upload.py part.gcode --originals originals -- --policy=safe

3. OctoPrint: put this file into OctoPrint's folder `plugins`. Its settings come from the environment:
   TRAVERSE_ORIGINALS (folder; default ~/.traverse/originals), TRAVERSE_OPTIONS (words for `traverse
   optimize`, for instance "--server=farm:50051 --deadline=60s"), TRAVERSE_TIMEOUT (seconds, default 300).

What comes after `--` goes to `traverse optimize`. The upload always ends up printable: if Traverse refuses,
fails, or takes longer than --timeout, the file stays as it was uploaded and the reason is logged. The original
is on disk before the upload is touched, and the upload is replaced in one step.
"""

import argparse
import hashlib
import json
import logging
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

LOG = logging.getLogger("traverse")
ENDINGS = (".gcode", ".gco", ".g", ".bgcode", ".gcode.3mf", ".ufp")  # not .3mf: projects have that name as well


def is_gcode(path):
    return pathlib.Path(path).name.lower().endswith(ENDINGS)


def digest(path):
    found = hashlib.sha256()
    with open(path, "rb") as file:
        for block in iter(lambda: file.read(1 << 20), b""):
            found.update(block)
    return found.hexdigest()


def optimize(path, target, options=(), timeout=300.0, program="traverse"):
    """Writes an optimised `path` to `target`. Returns None, or why there is none."""
    command = [program, "optimize", str(path), "-o", str(target), "--quiet", *options]
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=timeout, check=False)
    except subprocess.TimeoutExpired:
        return f"not done within {timeout:g} s"
    except OSError as error:
        return f"cannot run {program}: {error.strerror}"
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines()
        return lines[-1] if lines else f"{program} ended with exit code {done.returncode}"
    return None


def process(path, originals, options=(), timeout=300.0, program="traverse", name=None):
    """Optimises one uploaded file in place. True if it was replaced.

    `originals` gets the file as uploaded, under the same name (or `name`), and beside it NAME.json with the
    digest of what took its place: so a file is known again and never optimised twice.
    """
    path, originals = pathlib.Path(path), pathlib.Path(originals)
    name = name or path.name
    note = originals / (name + ".json")
    if note.exists() and json.loads(note.read_text()).get("result_sha256") == digest(path):
        return False
    originals.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=originals, prefix=".traverse-") as scratch:
        kept, result = pathlib.Path(scratch, "original" + path.suffix), pathlib.Path(scratch, "result" + path.suffix)
        shutil.copy2(path, kept)
        reason = optimize(kept, result, options, timeout, program)
        if reason is not None:
            LOG.warning("%s stays as uploaded: %s", name, reason)
            return False
        if digest(path) != digest(kept):
            LOG.warning("%s was uploaded again meanwhile; leaving it to the next turn", name)
            return False
        note.write_text(json.dumps({"original": name, "result_sha256": digest(result)}) + "\n")
        os.replace(kept, originals / name)
        replace(path, result)
    LOG.info("%s optimised; the original is %s", name, originals / name)
    return True


def replace(path, result):
    """Puts `result` where `path` is, in one step, also across file systems; mode and owner stay."""
    with tempfile.NamedTemporaryFile(dir=path.parent, prefix=".traverse-", delete=False) as beside:
        try:
            with open(result, "rb") as source:
                shutil.copyfileobj(source, beside)
            beside.flush()
            os.fsync(beside.fileno())
            shutil.copystat(path, beside.name)
            os.replace(beside.name, path)
        except BaseException:
            os.unlink(beside.name)
            raise


def watch(folder, originals, options, timeout, program, interval=2.0):
    """Processes files that arrive or change in `folder`, once their size has stood still for one interval."""
    settled, seen = {}, {}
    for path in candidates(folder):
        seen[path] = stamp(path)  # what was there before is left alone
    LOG.info("watching %s", folder)
    while True:
        for path in candidates(folder):
            now = stamp(path)
            if now is None or seen.get(path) == now:
                continue
            if settled.get(path) != now:
                settled[path] = now  # still being written, perhaps
                continue
            process(path, originals, options, timeout, program)
            seen[path] = stamp(path)
        time.sleep(interval)


def candidates(folder):
    return [path for path in pathlib.Path(folder).rglob("*")
            if is_gcode(path) and not path.name.startswith(".")]


def stamp(path):
    try:
        status = path.stat()
        return status.st_size, status.st_mtime_ns
    except OSError:
        return None  # gone again


# OctoPrint: a plugin of one file.
__plugin_name__ = "Traverse"
__plugin_version__ = "0.1.0"
__plugin_description__ = "Shortens the travel moves of uploaded G-code"
__plugin_pythoncompat__ = ">=3.7,<4"


def preprocess(path, file_object, links=None, printer_profile=None, allow_overwrite=True, *args, **kwargs):
    """The hook octoprint.filemanager.preprocessor: gets each file before it is stored."""
    name = pathlib.Path(file_object.filename)
    if not is_gcode(name):
        return file_object
    import octoprint.filemanager.util
    originals = pathlib.Path(os.environ.get("TRAVERSE_ORIGINALS", "~/.traverse/originals")).expanduser()
    with tempfile.NamedTemporaryFile(prefix="traverse-", suffix=name.suffix, delete=False) as upload:
        with file_object.stream() as stream:
            shutil.copyfileobj(stream, upload)
    process(upload.name, originals, shlex.split(os.environ.get("TRAVERSE_OPTIONS", "")),
            float(os.environ.get("TRAVERSE_TIMEOUT", "300")), name=name.name)
    # Moved by OctoPrint to its place; optimised or as it came.
    return octoprint.filemanager.util.DiskFileWrapper(file_object.filename, upload.name, move=True)


__plugin_hooks__ = {"octoprint.filemanager.preprocessor": preprocess}


def main():
    words, options = sys.argv[1:], []
    if "--" in words:
        cut = words.index("--")
        words, options = words[:cut], words[cut + 1:]
    parser = argparse.ArgumentParser(description="Sends uploaded G-code through `traverse optimize` and keeps the original.")
    parser.add_argument("file", nargs="?", type=pathlib.Path, help="one uploaded file")
    parser.add_argument("--watch", type=pathlib.Path, help="a folder to watch instead")
    parser.add_argument("--originals", type=pathlib.Path, required=True, help="where originals are kept; not below --watch")
    parser.add_argument("--timeout", type=float, default=300, help="seconds for one file")
    parser.add_argument("--interval", type=float, default=2, help="seconds between two looks at the folder")
    parser.add_argument("--program", default="traverse", help="the traverse command")
    args = parser.parse_args(words)
    logging.basicConfig(level=logging.INFO, format="%(asctime)s %(levelname)s %(message)s")
    if (args.file is None) == (args.watch is None):
        parser.error("either a file or --watch")
    if args.watch:
        if args.watch.resolve() in (args.originals.resolve(), *args.originals.resolve().parents):
            parser.error("--originals must not lie in the folder that is watched")
        watch(args.watch, args.originals, options, args.timeout, args.program, args.interval)
    return 0 if process(args.file, args.originals, options, args.timeout, args.program) else 1


if __name__ == "__main__":
    sys.exit(main())
