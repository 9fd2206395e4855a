#!/bin/sh
# Builds the unit tests with the address and undefined-behaviour sanitizers and runs all of them; then those of the
# engine, which has all the threads, with the thread sanitizer.
#   scripts/test_sanitizers.sh [jobs]
set -eu
cd "$(dirname "$0")/.."
jobs="${1:-$(nproc)}"

check() {  # preset, tests...
  preset=$1
  shift
  cmake --preset "$preset" --log-level=WARNING
  cmake --build "build-$preset" -j "$jobs" --target "$@"
  for tests in "$@"; do
    echo "$preset: $tests"
    # Speed is not measured under sanitizers.
    "build-$preset/$tests" --gtest_brief=1 --gtest_filter="-*NoQuadraticTime*"
  done
}
check asan test_registry test_engine test_problems test_solvers test_reports test_conformance
check tsan test_engine
