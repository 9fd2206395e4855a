#!/bin/sh
# Builds the program with clang, warnings as errors, and learns the quick start with it.
#   scripts/test_clang.sh [jobs]
set -eu
cd "$(dirname "$0")/.."
jobs="${1:-$(nproc)}"
cmake -S . -B build-clang -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=clang++ -DCOPPICE_TESTS=OFF \
  --log-level=WARNING
cmake --build build-clang -j "$jobs" --target runner
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
build-clang/runner configs/quickstart.xml --out "$out" --progress none
echo "clang: the quick start runs"
