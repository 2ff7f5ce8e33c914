#!/usr/bin/env bash
# Collects the file system of a container image: the program, the health probe, the libraries that they
# load, a user, and what there is of it.
#
#   deploy/image-root.sh BUILD OUT [traverse-server|traverse-gateway]
#
# OUT/usr/share/doc/traverse-server/packages.txt lists the Debian packages of the libraries with their
# versions, sorted: the same list is the same image but for our own programs. Their licences lie beside it. So do
# those of archives whose code is in the programs, by the linker's map.
set -euo pipefail
build=$(realpath "$1")
out=$2
case "${3:-traverse-server}" in
  traverse-server) main=$build/server/traverse-server ;;
  traverse-gateway) main=$build/client/gateway/traverse-gateway ;;
  *) echo "$0: no image of $3" >&2; exit 2 ;;
esac
doc=$out/usr/share/doc
mkdir -p "$out"/{usr/bin,etc,tmp} "$doc/traverse-server"

programs=("$main" "$build/deploy/traverse-health-probe")
for program in "${programs[@]}"; do
  install -m 755 -s "$program" "$out/usr/bin/"
done

# ldd prints "libz.so.1 => /lib/x86_64-linux-gnu/libz.so.1 (0x...)" and "/lib64/ld-linux-x86-64.so.2 (0x...)".
libraries=$(for program in "${programs[@]}"; do ldd "$program"; done |
  awk '$2 == "=>" && $3 ~ /^\// {print $3} $1 ~ /^\// {print $1}' | sort -u)
archives=$(for program in "${programs[@]}"; do sed -n 's/^\(\/[^(]*\.a\)(.*/\1/p' "$program.map"; done | sort -u)
packages=()
for library in $libraries $archives; do
  [[ $library == *.a ]] || cp -L --parents "$library" "$out"
  # dpkg knows a file by the path it was unpacked to, which may be the one behind a link.
  owner=$(dpkg-query -S "$library" 2>/dev/null || dpkg-query -S "$(realpath "$library")" 2>/dev/null ||
    dpkg-query -S "*/$(basename "$(realpath "$library")")")
  packages+=("${owner%%:*}")
done
printf '%s\n' "${packages[@]}" | sort -u | while read -r package; do
  dpkg-query -W -f '${Package} ${Version}\n' "$package" | head -1
  mkdir -p "$doc/$package"
  cp -L "/usr/share/doc/$package/copyright" "$doc/$package/"
done >"$doc/traverse-server/packages.txt"
cp "$(dirname "$0")/debian/copyright" "$doc/traverse-server/"

echo 'traverse:x:65532:65532:Traverse server:/nonexistent:/usr/sbin/nologin' >"$out/etc/passwd"
echo 'traverse:x:65532:' >"$out/etc/group"
chmod 1777 "$out/tmp"
