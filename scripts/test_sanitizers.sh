#!/bin/sh
# Builds everything with clang, warnings as errors, and with the address and undefined-behaviour sanitizers, and runs the
# tests so; then those of the engine, which has all the threads, with g++ and the thread sanitizer.
#   scripts/test_sanitizers.sh [jobs]
set -eu
cd "$(dirname "$0")/.."
jobs="${1:-$(nproc)}"

run() {  # preset, options of ctest...
  preset="$1"
  shift
  echo "sanitizers: $preset"
  # Speed is not measured so.
  ctest --test-dir "build-$preset" --no-tests=error -j "$jobs" --output-on-failure -E NoQuadraticTime "$@"
}
scripts/build.sh asan "$jobs"
run asan -LE slow
run asan -L slow -R Mutations
scripts/build.sh tsan "$jobs" test_engine
run tsan -L engine
