#!/bin/sh
# Lets clang-tidy check every source of the program, as .clang-tidy says. Needs build-asan/, which clang compiled.
#   scripts/check_tidy.sh [jobs]
set -eu
cd "$(dirname "$0")/.."
jobs="${1:-$(nproc)}"
talk=$(mktemp)
trap 'rm -f "$talk"' EXIT
git ls-files 'registry/*.cpp' 'engine/*.cpp' 'problems/*.cpp' 'solvers/*.cpp' 'reports/*.cpp' |
  xargs -P "$jobs" -n 4 clang-tidy -p build-asan --quiet 2>"$talk" || {
  grep -v 'warnings generated' "$talk" >&2 || true
  exit 1
}
echo "tidy: nothing found"
