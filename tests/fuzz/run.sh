#!/usr/bin/env bash
# Runs fuzz targets built with the preset `fuzz`, and stops at the first finding.
#
#   tests/fuzz/run.sh SECONDS [NAME...]   each target for so long; all of them unless named
#
# What was learnt stays in build/fuzz/corpus/NAME, findings come to build/fuzz/findings/NAME.
set -euo pipefail
cd "$(dirname "$0")/../.."

seconds=${1:?usage: tests/fuzz/run.sh SECONDS [NAME...]}
shift
build=build/fuzz
names=("$@")
if [ ${#names[@]} -eq 0 ]; then
  for program in "$build"/tests/fuzz/fuzz_*; do
    [ -x "$program" ] && [ -f "$program" ] && names+=("${program##*/fuzz_}")
  done
fi
[ ${#names[@]} -gt 0 ] || { echo "$0: no fuzz target is built" >&2; exit 1; }

for name in "${names[@]}"; do
  mkdir -p "$build/corpus/$name" "$build/findings/$name"
  places=("$build/corpus/$name")
  for place in "tests/fuzz/seeds/$name" "tests/fuzz/findings/$name"; do
    [ -d "$place" ] && places+=("$place")
  done
  echo "== $name, $seconds s"
  # Without weights for rare features, which took a quarter of the time, runs are a quarter more.
  "$build/tests/fuzz/fuzz_$name" -max_total_time="$seconds" -entropic=0 -timeout=20 -rss_limit_mb=2560 \
    -print_final_stats=1 -verbosity=1 -artifact_prefix="$build/findings/$name/" "${places[@]}" \
    2>&1 | tee "$build/findings/$name.log" |
    grep -E '^(==|broken|SUMMARY|stat::(number|average|peak)|.*(ERROR|runtime error|DEDUP|Test unit))' ||
    true
  [ "${PIPESTATUS[0]}" -eq 0 ] || { echo "$name: see $build/findings/$name.log" >&2; exit 1; }
done
