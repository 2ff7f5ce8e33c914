"""The examples of proto/README.md: each call is made with buf, and answers what stands below it.

Skips without npm, from which buf comes (pinned in tests/deploy/buf). TRAVERSE_BUILD names the build under test.
"""
import json
import os
import pathlib
import re
import socket
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(SOURCE))
from tests.support import node_packages

BUILD = pathlib.Path(os.environ["TRAVERSE_BUILD"])
SKIPPED = 77
MARK = "== end of an example =="


def skip(reason):
    print("SKIPPED:", reason)
    sys.exit(SKIPPED)


def squeezed(text):
    """Without blanks, so that only what is said counts."""
    return re.sub(r"\s+", "", text)


def examples():
    """[(commands, what the answer has to hold)]; an example without an answer has ''."""
    guide = (SOURCE / "proto/README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"(?ms)^```(sh|)\n(.*?)^```", guide)
    found = []
    for kind, text in blocks:
        if kind == "sh":
            found.append([text, ""])
        else:
            found[-1][1] = text
    return found


def main():
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        program, missing = node_packages.install_buf(folder)
        if missing:
            skip(missing)
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = str(probe.getsockname()[1])
        found = examples()
        assert len(found) >= 6, len(found)
        # The first block starts the server; the others want it to be there.
        wait = f"until (echo > /dev/tcp/127.0.0.1/{port}) 2>/dev/null; do sleep 0.1; done\n"
        script = "trap 'code=$?; kill $(jobs -p) 2>/dev/null || true; wait; exit $code' EXIT\n" + wait.join(
            [found[0][0], "".join(f"{commands}\necho '{MARK}'\n" for commands, _ in found[1:])]).replace("50051", port)
        environment = {**os.environ, "PATH": f"{program.parent}:{BUILD / 'server'}:{os.environ['PATH']}", "BUF_CACHE_DIR": scratch}
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=folder, capture_output=False, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False, timeout=120, env=environment)
        answers = done.stdout.split(MARK)
        faults = [] if done.returncode == 0 else [f"exit code {done.returncode}\n{done.stdout}"]
        for (commands, wanted), answer in zip(found[1:], answers):
            for line in wanted.splitlines():
                if squeezed(line).rstrip(",") not in squeezed(answer):
                    faults.append(f"{commands}\nshould answer\n{line}\nbut answers\n{answer}")
        if faults:
            sys.exit("\n".join(faults))
        print(json.dumps({"examples": len(found) - 1}))


main()
