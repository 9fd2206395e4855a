#!/bin/sh
# Fails when a source is not formatted as .clang-format says.
set -eu
cd "$(dirname "$0")/.."
git ls-files '*.cpp' '*.h' | xargs clang-format --dry-run -Werror
echo "format: all sources are formatted"
