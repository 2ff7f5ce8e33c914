#!/usr/bin/env bash
# Draws the pictures of the guides anew: one layer of a plate, sliced with a printer's own profile, under each policy.
#
#   client/pictures/draw.sh [FOLDER [FLAG...]]      TRAVERSE names the command (default: build/release/client/traverse),
#                                                   the flags are for it
set -euo pipefail
cd "$(dirname "$0")/../.."

folder=${1:-client/pictures}
traverse=${TRAVERSE:-build/release/client/traverse}
plate=deploy/samples/brackets8.gcode.xz
for policy in safe balanced free fast; do
  "$traverse" optimize "$plate" --quiet --policy="$policy" -o /dev/null --layers=5-7 --layer=6 "${@:2}" \
    --picture="$folder/$policy.svg"
done
