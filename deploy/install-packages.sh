#!/usr/bin/env bash
# Installs the Debian 12 packages that are missing, and nothing if none is.
#
#   deploy/install-packages.sh build      what the build needs
#   deploy/install-packages.sh test       that, and what the tests need, a browser and Node among it
#   deploy/install-packages.sh release    the build's, and what packs
#   deploy/install-packages.sh sanitize   the build's, and what the tests in C++ and their sanitizers need
#   deploy/install-packages.sh debug      the tests', and GCC
#   deploy/install-packages.sh deploy     the tests', and the daemons and tools of the tests of deploy/, but kubectl
set -euo pipefail

build=(
  clang lld cmake ninja-build pkg-config
  libgrpc++-dev libssl-dev openssl protobuf-compiler-grpc libprotobuf-dev protobuf-compiler
  libabsl-dev prometheus-cpp-dev libspdlog-dev nlohmann-json3-dev libmicrohttpd-dev
  zlib1g-dev liblzma-dev libcairo2-dev coinor-libcbc-dev coinor-libclp-dev
  libboost-dev libcurl4-openssl-dev
)
unit=(libgtest-dev libgmock-dev libbenchmark-dev xz-utils python3)
test=(
  "${unit[@]}"
  python3-grpcio python3-protobuf python3-yaml python3-venv python3-pip python3-setuptools python3-wheel codespell zsh curl iproute2
  chromium fonts-dejavu-core nats-server
)
release=(dpkg-dev file gzip python3 python3-pip python3-setuptools python3-wheel)
sanitize=(libclang-rt-14-dev llvm)
debug=(g++)  # the other compiler that people have
deploy=(
  prometheus haproxy systemd mmdebstrap buildah podman podman-compose runc catatonit
  containernetworking-plugins golang-github-containernetworking-plugin-dnsname iptables
)
if ! command -v npm >/dev/null; then  # another Node may be there already
  test+=(nodejs npm)
  release+=(nodejs npm)
fi

case "${1:-}" in
  build) wanted=("${build[@]}") ;;
  test) wanted=("${build[@]}" "${test[@]}") ;;
  release) wanted=("${build[@]}" "${release[@]}") ;;
  debug) wanted=("${build[@]}" "${test[@]}" "${debug[@]}") ;;
  sanitize) wanted=("${build[@]}" "${unit[@]}" "${sanitize[@]}") ;;
  deploy) wanted=("${build[@]}" "${test[@]}" "${deploy[@]}") ;;
  *)
    echo "usage: $0 build|test|release|sanitize|debug|deploy" >&2
    exit 2
    ;;
esac

missing=()
for package in "${wanted[@]}"; do
  state=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
  [ "$state" = "install ok installed" ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "$0: missing packages, and neither root nor sudo to install them: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "Installing ${#missing[@]} packages: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
