#!/usr/bin/python3
"""Packs a file system into an image that `docker load` and `podman load` take; needs neither of them.

    image.py traverse-server|traverse-gateway VERSION REVISION ROOT >IMAGE.tar

Everything but the files comes from that program's stage of deploy/Dockerfile. All dates are SOURCE_DATE_EPOCH.
"""
import hashlib
import io
import json
import os
import pathlib
import re
import shlex
import sys
import tarfile
import time

DOCKERFILE = pathlib.Path(__file__).resolve().parents[1] / "Dockerfile"
EPOCH = int(os.environ["SOURCE_DATE_EPOCH"])
CREATED = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(EPOCH))
NANOSECONDS = 1_000_000_000


def instructions(program):
    """The pairs of instruction and value of its stage: the one with its entry point."""
    text = re.sub(r"(?m)^#.*\n", "", DOCKERFILE.read_text(encoding="utf-8")).replace("\\\n", " ")
    for stage in re.split(r"(?m)^FROM ", text):
        if f'ENTRYPOINT ["/usr/bin/{program}"]' in stage:
            return [line.split(None, 1) for line in stage.splitlines()[1:] if line.strip()]
    sys.exit(f"no stage of {DOCKERFILE} is {program}'s")


def config_of(program, version, revision):
    config = {"Env": ["PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"], "WorkingDir": "/"}
    for name, value in instructions(program):
        value = value.replace("${VERSION}", version).replace("${REVISION}", revision)
        if name == "LABEL":
            config["Labels"] = dict(word.split("=", 1) for word in shlex.split(value))
        elif name == "USER":
            config["User"] = value
        elif name == "EXPOSE":
            config["ExposedPorts"] = {f"{port}/tcp": {} for port in value.split()}
        elif name == "HEALTHCHECK":
            options, command = value.split("CMD ", 1)
            check = dict(re.findall(r"--([\w-]+)=(\d+)", options))
            config["Healthcheck"] = {"Test": ["CMD", *json.loads(command)], "Retries": int(check["retries"]),
                                     "Interval": int(check["interval"]) * NANOSECONDS,
                                     "Timeout": int(check["timeout"]) * NANOSECONDS,
                                     "StartPeriod": int(check["start-period"]) * NANOSECONDS}
        elif name in ("ENTRYPOINT", "CMD"):
            config[name.capitalize()] = json.loads(value)
        elif name not in ("ARG", "COPY"):
            sys.exit(f"{DOCKERFILE}: no rule for {name}")
    return config


def layer_of(root):
    """All files below `root`, sorted, as root's and of one time."""
    def plain(info):
        info.uid = info.gid = 0
        info.uname = info.gname = ""
        info.mtime = EPOCH
        return info
    out = io.BytesIO()
    with tarfile.open(fileobj=out, mode="w", format=tarfile.GNU_FORMAT) as tar:
        for path in sorted(root.rglob("*")):
            tar.add(path, path.relative_to(root).as_posix(), recursive=False, filter=plain)
    return out.getvalue()


def architecture():
    machine = os.uname().machine
    return {"x86_64": "amd64", "aarch64": "arm64"}.get(machine, machine)


def main():
    program, version, revision, root = sys.argv[1:]
    layer = layer_of(pathlib.Path(root))
    digest = hashlib.sha256(layer).hexdigest()
    image = json.dumps({
        "architecture": architecture(), "os": "linux", "created": CREATED, "config": config_of(program, version, revision),
        "rootfs": {"type": "layers", "diff_ids": [f"sha256:{digest}"]},
        "history": [{"created": CREATED, "created_by": "deploy/release.sh"}]}).encode()
    name = hashlib.sha256(image).hexdigest() + ".json"
    manifest = json.dumps([{"Config": name, "RepoTags": [f"docker.io/library/{program}:{version}"],
                            "Layers": [f"{digest}.tar"]}]).encode()
    with tarfile.open(fileobj=sys.stdout.buffer, mode="w|", format=tarfile.GNU_FORMAT) as tar:
        for entry, data in ((f"{digest}.tar", layer), (name, image), ("manifest.json", manifest)):
            info = tarfile.TarInfo(entry)
            info.size, info.mtime = len(data), EPOCH
            tar.addfile(info, io.BytesIO(data))


if __name__ == "__main__":
    main()
