#!/usr/bin/env bash
# Builds Traverse and passes its tests; installs the packages that this needs first.
#
#   tests/run.sh            the whole suite
#   tests/run.sh --quick    without the tests labelled slow
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
select=()
fuzz_seconds=
for argument in "$@"; do
  case "$argument" in
    --quick) select=(-LE slow) ;;
    --debug) preset=debug ;;
    --asan)
      # The sanitizer has memory and files of its own, and comes before a library that sets the clock.
      preset=asan packages="sanitize"
      select=(-LE 'slow|no_sanitizer' -E '^(StalledReaderTest|FileDescriptors|ClockJump)[.]')
      export LSAN_OPTIONS="suppressions=$PWD/tests/support/leaks_of_others.supp:print_suppressions=0"
      ;;
    --deploy)
      packages="deploy" select=(-R '^deploy[.]')
      export TRAVERSE_TEST_IMAGES=1
      ;;
    --tsan) preset=tsan packages="sanitize" target=(tsan_tests) select=(-L tsan) ;;
    --fuzz) preset=fuzz packages="sanitize" target=(fuzz_targets) fuzz_seconds=60 ;;
    --fuzz=*) preset=fuzz packages="sanitize" target=(fuzz_targets) fuzz_seconds=${argument#*=} ;;
    *)
      sed -n '4,10s/^# *//p' "$0" >&2
      exit 2
      ;;
  esac
done

deploy/install-packages.sh "$packages"
# A clean checkout is built a folder at a time, in half the time; a build that is there goes on as it was begun.
lumps=()
if [ "$preset" = release ] && [ ! -e "build/$preset/CMakeCache.txt" ]; then
  lumps=(-DCMAKE_UNITY_BUILD=ON)
fi
cmake --preset "$preset" -DTRAVERSE_TESTS=ON "${lumps[@]}"
cmake --build --preset "$preset" --target "${target[@]}"
if [ -n "$fuzz_seconds" ]; then
  exec tests/fuzz/run.sh "$fuzz_seconds"
fi
# More tests than processors: many of them wait for most of their time.
ctest --test-dir "build/$preset" -j "$(($(nproc) * 2))" --output-on-failure "${select[@]}"
