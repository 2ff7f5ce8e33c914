#!/usr/bin/env bash
# Builds the wheel and the sdist of the Python client into a folder.
#
#   client/python/build.sh [dist]
#
# Needs Debian's python3-setuptools, python3-wheel, python3-pip, protobuf-compiler and protobuf-compiler-grpc.
set -euo pipefail
out=$(realpath -m "${1:-$(dirname "$0")/dist}")
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# In a copy, so that the sources stay as they are.
mkdir -p "$work/client" "$out"
cp -r "$here" "$work/client/python"
cp -r "$here/../../proto" "$here/../../CMakeLists.txt" "$work/"
cd "$work/client/python"
rm -rf dist build
/usr/bin/python3 setup.py -q sdist -d "$work/sdist"
# Python's tar writes when and by whom it was packed; as SOURCE_DATE_EPOCH says, it is the same each time.
for sdist in "$work"/sdist/*.tar.gz; do
  mkdir "$work/unpacked"
  tar -xzf "$sdist" -C "$work/unpacked"
  (cd "$work/unpacked" && tar --sort=name --owner=0 --group=0 --numeric-owner \
    ${SOURCE_DATE_EPOCH:+--mtime=@$SOURCE_DATE_EPOCH} -c -- *) |
    gzip -9n >"$out/$(basename "$sdist")"
done
/usr/bin/python3 -m pip --disable-pip-version-check wheel -q --no-build-isolation --no-deps -w "$out" .
ls "$out"
