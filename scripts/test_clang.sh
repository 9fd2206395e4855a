#!/bin/sh
# Builds everything with clang, warnings as errors, and runs the quick tests. No goldens: those hold for one compiler.
#   scripts/test_clang.sh [jobs]
set -eu
cd "$(dirname "$0")/.."
jobs="${1:-$(nproc)}"
cmake -S . -B build-clang -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=clang++ --log-level=WARNING
cmake --build build-clang -j "$jobs"
ctest --test-dir build-clang --output-on-failure -j "$jobs" -LE slow
