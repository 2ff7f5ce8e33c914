#!/usr/bin/env python3
"""Sends a sliced file to traverse-gateway and writes what comes back: the same print with less travel.

    pip install requests          (Debian: python3-requests)
    send_file.py part.gcode -o shorter.gcode --gateway=http://127.0.0.1:8080 --policy=balanced

The token, where the gateway asks for one, is in TRAVERSE_TOKEN. Exit code 0: written; 1: refused, nothing is written.
"""
import argparse
import os
import sys
import time

import requests


def send(gateway, path, parameters, token=None, attempts=5):
    """The answer to the file; asks again while the gateway is full, as it says when."""
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    for attempt in range(attempts):
        with open(path, "rb") as file:  # in pieces, not read into memory
            answer = requests.post(f"{gateway}/v1/gcode", params={"name": os.path.basename(path), **parameters}, data=file,
                                   headers=headers, timeout=(10, 660))
        if answer.status_code not in (429, 503) or attempt + 1 == attempts:
            return answer
        time.sleep(float(answer.headers.get("Retry-After", 5)))
    raise AssertionError("unreachable")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("input")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--gateway", default="http://127.0.0.1:8080")
    parser.add_argument("--policy", default="safe")
    options = parser.parse_args()
    answer = send(options.gateway, options.input, {"policy": options.policy}, os.environ.get("TRAVERSE_TOKEN"))
    if not answer.ok:
        # RFC 9457: one sentence says why.
        problem = answer.json() if "json" in answer.headers.get("Content-Type", "") else {}
        sys.exit(f"{options.input}: {problem.get('detail', answer.reason)}")
    with open(options.output, "wb") as file:
        file.write(answer.content)
    print(answer.headers["Traverse-Summary"])


if __name__ == "__main__":
    main()
