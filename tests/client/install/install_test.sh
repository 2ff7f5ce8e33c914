#!/usr/bin/env bash
# What is installed of the client library is enough to build and run a program against it.
#
#   install_test.sh BUILD SERVER     the build folder, and the program traverse-server
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$1
server=$2
folder=$(mktemp -d)
server_pid=
clean_up() {
  [ -z "$server_pid" ] || kill "$server_pid" 2>/dev/null || true
  rm -rf "$folder"
}
trap clean_up EXIT

cmake --install "$build" --component dev --prefix "$folder/prefix" >/dev/null
if grep -rlE "$(cd "$here/../../.." && pwd)" "$folder/prefix" --include=*.cmake; then
  echo "the package names places of the build tree" >&2
  exit 1
fi
cmake -S "$here/consumer" -B "$folder/build" -G Ninja -DCMAKE_PREFIX_PATH="$folder/prefix" \
  -DCMAKE_BUILD_TYPE=Debug >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
cmake --build "$folder/build" >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }

mkfifo "$folder/ports"
"$server" --listen=127.0.0.1:0 --metrics_listen= --log_file=/dev/null >"$folder/ports" &
server_pid=$!
read -r line <"$folder/ports"
visits=$("$folder/build/consumer" "127.0.0.1:${line##* }")
[ "$visits" = 3 ] || { echo "visits: $visits" >&2; exit 1; }
