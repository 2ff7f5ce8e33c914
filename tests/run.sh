#!/usr/bin/env bash
# Builds Traverse and passes its tests; installs the packages that this needs first.
#
#   tests/run.sh            what belongs to every commit
#   tests/run.sh --quick    that, without the tests labelled slow
#   tests/run.sh --full     that, with benches, attacks, planted defects and fuzz targets in their short forms
#   tests/run.sh --busy     what belongs to every commit three times, beside four busy loops
#   tests/run.sh --debug    the suite with assertions on
#   tests/run.sh --asan     the suite under AddressSanitizer and UndefinedBehaviorSanitizer
#   tests/run.sh --tsan     the suite's thread-safe parts under ThreadSanitizer
#   tests/run.sh --deploy   what deploy/ ships, with its images, its fleet and a clean root; as root, some minutes
#   tests/run.sh --fuzz[=SECONDS]   the fuzz targets, 60 seconds each
set -euo pipefail
cd "$(dirname "$0")/.."

preset=release
packages="test"
target=(all)
long=OFF
select=()
loops=0
fuzz_seconds=
for argument in "$@"; do
  case "$argument" in
    --quick) select=(-LE slow) ;;
    --full) long=ON ;;
    --busy) loops=4 select=(--repeat until-fail:3) ;;
    --debug) preset=debug packages=debug ;;
    --asan)
      # The sanitizer has memory and files of its own, and comes before a library that sets the clock.
      preset=asan packages="sanitize" long=ON
      select=(-LE 'slow|no_sanitizer' -E '[.](StalledReaderTest|FileDescriptors|ClockJump)$')
      export LSAN_OPTIONS="suppressions=$PWD/tests/support/leaks_of_others.supp:print_suppressions=0"
      ;;
    --deploy)
      packages="deploy" select=(-R '^deploy[.]')
      export TRAVERSE_TEST_IMAGES=1
      ;;
    --tsan) preset=tsan packages="sanitize" target=(tsan_tests) select=(-L tsan) ;;
    --fuzz) preset=fuzz packages="sanitize" long=ON target=(fuzz_targets) fuzz_seconds=60 ;;
    --fuzz=*) preset=fuzz packages="sanitize" long=ON target=(fuzz_targets) fuzz_seconds=${argument#*=} ;;
    *)
      sed -n '4,12s/^# *//p' "$0" >&2
      exit 2
      ;;
  esac
done

deploy/install-packages.sh "$packages"
cmake --preset "$preset" -DTRAVERSE_TESTS=ON -DTRAVERSE_LONG_TESTS="$long"
cmake --build --preset "$preset" --target "${target[@]}"
if [ -n "$fuzz_seconds" ]; then
  exec tests/fuzz/run.sh "$fuzz_seconds"
fi
trap 'kill $(jobs -p) 2>/dev/null || true' EXIT
for ((i = 0; i < loops; i++)); do
  while :; do :; done &
done
# More tests than processors: many of them wait for most of their time.
ctest --test-dir "build/$preset" -j "$(($(nproc) * 2))" --output-on-failure "${select[@]}"
