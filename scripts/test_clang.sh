#!/bin/sh
# Lets clang check every source of the program, warnings as errors. Needs a configured build/ (for generated headers).
#   scripts/test_clang.sh [jobs]
set -eu
cd "$(dirname "$0")/.."
jobs="${1:-$(nproc)}"
git ls-files 'registry/*.cpp' 'engine/*.cpp' 'problems/*.cpp' 'solvers/*.cpp' 'reports/*.cpp' |
  xargs -P "$jobs" -n 6 clang++ -fsyntax-only -std=c++20 -Wall -Wextra -Wpedantic -Wshadow -Wconversion \
    -Wno-sign-conversion -Werror -DFMT_SHARED -I. -Ibuild -isystem /usr/include/eigen3
echo "clang: all sources compile without a warning"
