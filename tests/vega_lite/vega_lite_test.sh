#!/bin/sh
# Draws the figures of the shipped configs, at the smallest scale, and one of every kind with the Vega-Lite that
# package-lock.json pins.
#   vega_lite_test.sh RUNNER WORK_FOLDER
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
runner=$1
work=$2
"$here/../support/npm_install.sh" "$here" "$work"
cp "$here/check.mjs" "$work/"

rm -rf "$work/out"
"$runner" "$here/figures.xml" --out "$work/out" --progress none
for config in $(grep -rl --include='*.xml' '<figure' "$root/configs"); do
  scale=""
  if grep -q 'scale.xml\|name="scale"' "$config"; then scale="scale:=ci"; fi
  "$runner" "$config" $scale --out "$work/out" --progress none
done
set --
for experiment in "$work"/out/*/figures; do
  for figure in "$experiment"/*.vl.json; do
    if [ -e "$figure" ]; then set -- "$@" "$experiment"; break; fi
  done
done
node "$work/check.mjs" "$@"
