#!/bin/sh
# Installs the Debian packages that a set of targets needs and that are missing; says which. Does nothing, and needs no
# network, when none is missing.
#   scripts/install_packages.sh build|test|test-all|bench|bench-trees|bench-optimizers
set -eu

build="g++ cmake ninja-build pkg-config git
  libeigen3-dev libtinyxml2-dev libfmt-dev nlohmann-json3-dev libcli11-dev
  librandom123-dev libsleef-dev libxxhash-dev libsqlite3-dev libnlopt-dev"
test="libgtest-dev libgmock-dev libxml2-utils"
all="clang clang-tidy clang-format libclang-rt-14-dev
  g++-aarch64-linux-gnu qemu-user graphviz"
bench="libbenchmark-dev"
npm="nodejs npm"

case "${1:-}" in
  build) wanted="$build" ;;
  test) wanted="$build $test" ;;
  test-all) wanted="$build $test $all $bench" ;;
  bench) wanted="$build $bench" ;;
  bench-trees) wanted="$build $bench python3-sklearn" ;;
  bench-optimizers) wanted="$build $bench libpagmo-dev" ;;
  *) echo "usage: $0 build|test|test-all|bench|bench-trees|bench-optimizers" >&2; exit 2 ;;
esac
# A npm of other origin, which Debian's would replace, serves as well.
if [ "$1" = test-all ] && ! command -v npm >/dev/null; then wanted="$wanted $npm"; fi

missing=""
for package in $wanted; do
  status=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing="$missing $package"
done
if [ -z "$missing" ]; then
  echo "packages: nothing to install"
  exit 0
fi

as_root="env DEBIAN_FRONTEND=noninteractive"
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "packages: missing$missing; become root or install sudo" >&2; exit 1; }
  as_root="sudo $as_root"  # sudo keeps no variables
fi
echo "packages: installing$missing"
$as_root apt-get update -qq || echo "packages: the package lists could not be updated; trying with what is known" >&2
$as_root apt-get install -y -qq --no-install-recommends $missing >/dev/null || {
  echo "packages: could not install$missing" >&2
  exit 1
}
echo "packages: done"
