#!/bin/sh
# Lets clang-tidy check every source of the program, one by one, as .clang-tidy says. Remembers in the user's cache
# which preprocessed sources were clean, and does not check these again.
#   scripts/check_tidy.sh [jobs]
set -eu
cd "$(dirname "$0")/.."
jobs="${1:-$(nproc)}"
export TIDY_CACHE="${XDG_CACHE_HOME:-$HOME/.cache}/coppice/tidy"
mkdir -p "$TIDY_CACHE"
talk=$(mktemp)
trap 'rm -f "$talk"' EXIT
cmake --preset tidy --log-level=WARNING >/dev/null
cmake --build build-tidy --target coppice_version -- --quiet
git ls-files 'registry/*.cpp' 'engine/*.cpp' 'problems/*.cpp' 'solvers/*.cpp' 'reports/*.cpp' |
  xargs -P "$jobs" -n 1 sh -c '
    key=$({ clang-tidy --version; cat .clang-tidy "$1"
            clang++ -E -std=c++20 -I. -Ibuild-tidy -isystem /usr/include/eigen3 "$1"; } | sha256sum | cut -d" " -f1)
    [ ! -e "$TIDY_CACHE/$key" ] || exit 0
    clang-tidy -p build-tidy --quiet "$1" && : >"$TIDY_CACHE/$key"' sh 2>"$talk" || {
  grep -v 'warnings generated' "$talk" >&2 || true
  exit 1
}
echo "tidy: nothing found"
