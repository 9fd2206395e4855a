#!/bin/sh
# Executes the exported policies in a folder with Node.js and with the ONNX Runtime that package-lock.json pins (its
# WebAssembly build: it comes inside the package).
#   onnx_test.sh FOLDER WORK_FOLDER
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$1
work=$2
"$here/../support/npm_install.sh" "$here" "$work"
cp "$here/check.mjs" "$work/"
node "$work/check.mjs" "$folder"
