#!/bin/sh
# Configures and builds a preset of CMakePresets.json: on a terminal with a status line, else silent but for what fails.
#   scripts/build.sh PRESET JOBS [targets...]
set -eu
cd "$(dirname "$0")/.."
preset="$1" jobs="$2"
shift 2
case "$preset" in
  release | bench) folder=build ;;
  *) folder="build-$preset" ;;
esac

# A compiler cache, where there is one, serves the builds of every clone.
cache=""
if command -v ccache >/dev/null; then
  export CCACHE_BASEDIR="$PWD" CCACHE_NOHASHDIR=1
  cache="-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"
fi

quiet="--quiet"
[ -t 1 ] && quiet=""
cmake --preset "$preset" --log-level=WARNING $cache >/dev/null
if [ "$#" -gt 0 ]; then
  cmake --build "$folder" -j "$jobs" --target "$@" -- $quiet
else
  cmake --build "$folder" -j "$jobs" -- $quiet
fi
echo "build: $folder is up to date"
