#!/usr/bin/env bash
# Builds Traverse and compares its strategies on two bundled samples: a sliced G-code plate and a DAMAT
# part. Installs the packages that the build needs first. A second run only prints the tables.
set -euo pipefail
cd "$(dirname "$0")/.."

deploy/install-packages.sh build
mkdir -p build
cmake --preset release -DTRAVERSE_TESTS=OFF >build/configure.log 2>&1 || {
  cat build/configure.log >&2
  exit 1
}
cmake --build --preset release --target traverse traverse-server

traverse=build/release/client/traverse
for sample in deploy/samples/clusters13.gcode deploy/samples/part2.damat; do
  echo
  echo "== $traverse compare $sample --layer_time_limit=700ms"
  "$traverse" compare "$sample" --layer_time_limit=700ms
done
