#!/usr/bin/env bash
# Makes all that a release consists of: Debian packages, images, wheel and sdist, npm package, the list of what is
# really linked, and the sums of all that.
#
#   deploy/release.sh [OUT [BUILD]]
#
# OUT is build/traverse-VERSION. BUILD is a build of this commit; without it one is made in build/dist. From the same
# commit, with the same packages of Debian, come the same bytes: every date in them is the commit's.
set -euo pipefail
umask 022
cd "$(dirname "$0")/.."
version=$(sed -n 's/^project(traverse VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
out=$(realpath -m "${1:-build/traverse-$version}")
build=${2:-build/dist}
revision=$(git rev-parse HEAD 2>/dev/null || echo unknown)
if [ -n "$(git status --porcelain 2>/dev/null)" ]; then
  revision+="-changed"
  echo "$0: there are changes that are not committed: this is no release" >&2
fi
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}
export SOURCE_DATE_EPOCH LC_ALL=C TZ=UTC

deploy/install-packages.sh release
if [ $# -lt 2 ]; then
  cmake --preset release -B "$build" -DTRAVERSE_TESTS=OFF >/dev/null
  cmake --build "$build"
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
made=$work/made
mkdir "$made"

cpack --config "$build/CPackConfig.cmake" -B "$work/packages" >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
cp "$work"/packages/*.deb "$made/"

client/python/build.sh "$made" >/dev/null

# In a copy, so that the sources stay as they are.
mkdir -p "$work/source/client"
cp -r client/node "$work/source/client/"
cp -r proto CMakeLists.txt "$work/source/"
(cd "$work/source" && npm pack --silent --pack-destination "$made" ./client/node >/dev/null)

for program in traverse-server traverse-gateway; do
  deploy/image-root.sh "$build" "$work/$program" "$program"
  deploy/release/image.py "$program" "$version" "$revision" "$work/$program" | gzip -9n >"$made/${program}_$version.image.tar.gz"
done

deploy/release/linked.py "$build" >"$made/linked.tsv"
echo "$version $revision" >"$made/revision.txt"
(cd "$made" && sha256sum -- *) >"$work/sums"
mv "$work/sums" "$made/SHA256SUMS"

mkdir -p "$out"
if [ -e "$out/SHA256SUMS" ]; then
  diff "$out/SHA256SUMS" "$made/SHA256SUMS" && echo "The same, byte for byte, as what was there."
fi
cp "$made"/* "$out/"
cat "$out/SHA256SUMS"
