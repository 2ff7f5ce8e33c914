#!/usr/bin/env bash
# Measures the optimiser and prints all tables, as Markdown.
#
#   tests/bench/run.sh                     everything, on the machine as it is: about half an hour
#   tests/bench/run.sh --quick             a minute: a few parts, one sliced file, short times
#   tests/bench/run.sh --corpus=FOLDER     sliced files of your own instead of tests/data/gcode
#   tests/bench/run.sh --build=FOLDER      a build other than build/release
#   tests/bench/run.sh --as_built          builds nothing
set -euo pipefail
cd "$(dirname "$0")/../.."

build=build/release
corpus=
quick=()
micro=()
builds=1
for argument in "$@"; do
  case "$argument" in
    --quick) quick=(--quick) micro=(--benchmark_min_time=0.01) ;;
    --corpus=*) corpus=${argument#*=} ;;
    --build=*) build=${argument#*=} ;;
    --as_built) builds=0 ;;
    *)
      sed -n '4,8s/^# *//p' "$0" >&2
      exit 2
      ;;
  esac
done

if [ -z "$corpus" ]; then
  corpus=tests/data/gcode
  [ ${#quick[@]} -eq 0 ] || corpus+=/ps_hooks_support_bridge.gcode.xz
fi

if [ "$builds" = 1 ]; then
  cmake -B "$build" -DTRAVERSE_LONG_TESTS=ON >&2
  targets=(layers_bench gcode_corpus_bench)
  if cmake --build "$build" --target help | grep -q '^engine_micro'; then targets+=(engine_micro); fi
  cmake --build "$build" --target "${targets[@]}" >&2
fi

printf '# Benchmarks\n\n%s, %s threads, %s\n\n' \
  "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)" "$(nproc)" "$(git rev-parse --short HEAD)"
status=0
"$build"/tests/bench/layers/layers_bench "${quick[@]}" || status=1
printf '## Sliced files\n\n'
"$build"/tests/bench/gcode/gcode_corpus_bench --threads="$(nproc)" "$corpus" || status=1
if [ -x "$build"/tests/bench/micro/engine_micro ]; then
  printf '\n## Kernels\n\n```\n'
  "$build"/tests/bench/micro/engine_micro "${micro[@]}" 2>/dev/null
  printf '```\n'
fi
exit "$status"
