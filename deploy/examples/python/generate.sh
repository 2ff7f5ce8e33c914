#!/usr/bin/env bash
# Generates the message classes, their type stubs (.pyi) and the service's client into a folder.
#
#   apt-get install protobuf-compiler protobuf-compiler-grpc python3-grpcio
#   ./generate.sh [generated]
#
# TRAVERSE_PROTO names the folder of the .proto files where they are not beside the example as in the
# source; the Debian package has them in /usr/share/traverse/proto.
#
# With pip instead: `pip install grpcio-tools`, and `python -m grpc_tools.protoc` for protoc.
set -euo pipefail
out=$(realpath -m "${1:-$(dirname "$0")/generated}")
cd "$(dirname "$0")"
mkdir -p "$out"
protoc -I "${TRAVERSE_PROTO:-../../../proto}" -I "${TRAVERSE_PROTO:-../../../server/proto}" \
  --python_out="$out" --pyi_out="$out" \
  --grpc_out="$out" --plugin=protoc-gen-grpc="$(command -v grpc_python_plugin)" \
  traverse/v1/options.proto traverse/v1/plan.proto traverse/v1/route_optimizer_service.proto \
  google/rpc/status.proto google/rpc/error_details.proto
