#!/bin/sh
# Builds the tests with the address and undefined-behaviour sanitizers, then with the thread sanitizer, and runs them.
#   scripts/test_sanitizers.sh [jobs]
set -eu
cd "$(dirname "$0")/.."
jobs="${1:-$(nproc)}"
for preset in asan tsan; do
  cmake --preset "$preset" --log-level=WARNING
  cmake --build "build-$preset" -j "$jobs"
  ctest --test-dir "build-$preset" --output-on-failure -j "$jobs" -L "$preset"
done
