#!/usr/bin/env python3
"""A sliced file through gateways: send_file.py part.gcode shorter.gcode HOST:PORT..."""
import pathlib
import sys
from traverse_client import GcodeGateway
with GcodeGateway(sys.argv[3:]) as gateway:
    made = gateway.rewrite(sys.argv[1], on_progress=lambda now: print(f"{now.layers_done} of {now.layers} layers", end="\r"))
pathlib.Path(sys.argv[2]).write_bytes(made.data)
print(made.summary.text)
