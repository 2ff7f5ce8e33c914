#!/usr/bin/env bash
# Draws the pictures of the guides anew: one layer of a sliced plate under each policy.
#
#   client/pictures/draw.sh [FOLDER]      TRAVERSE names the command (default: build/release/client/traverse)
set -euo pipefail
cd "$(dirname "$0")/../.."

folder=${1:-client/pictures}
traverse=${TRAVERSE:-build/release/client/traverse}
plate=tests/data/gcode/ps_islands17_marlin_abs_100.gcode.xz
for policy in safe balanced free; do
  "$traverse" optimize "$plate" --quiet --policy="$policy" -o /dev/null --layer=2 --picture="$folder/$policy.svg"
done
