#!/bin/sh
# Executes the exported policies in a folder with Node.js and with the ONNX Runtime that package-lock.json pins (its
# WebAssembly build: it comes inside the package).
#   onnx_test.sh FOLDER WORK_FOLDER
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$1
work=$2
mkdir -p "$work"

# Packages stay installed while the lock file is the same; then no network is needed.
if ! cmp -s "$here/package-lock.json" "$work/installed.json"; then
  rm -f "$work/installed.json"
  cp "$here/package.json" "$here/package-lock.json" "$work/"
  (cd "$work" && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error)
  cp "$here/package-lock.json" "$work/installed.json"
fi
cp "$here/check.mjs" "$work/"
node "$work/check.mjs" "$folder"
