#!/bin/sh
# Follows CONTRIBUTING.md: its example problem, compiled as it stands there, is known, conforms, gets a golden and is
# learned. Arguments: the runner and the conformance tests linked with the example, the folder of extracted files.
set -eu
runner=$1 conformance=$2 example=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "contributing: $*" >&2; exit 1; }

lines=$(wc -l < "$example/problems/water_tank.cpp")
[ "$lines" -lt 60 ] || fail "the example has $lines lines; a problem takes fewer than 60"

"$runner" describe water_tank | grep -q level_noise || fail "describe does not know the example's parameters"
"$runner" schema > "$work/schema.xsd"
xmllint --noout --schema "$work/schema.xsd" "$example/configs/problems/water_tank.xml" ||
  fail "the config does not fit the schema"

mkdir -p "$work/golden/problems"
export COPPICE_GOLDEN_DIR="$work/golden"
COPPICE_UPDATE_GOLDENS=1 "$conformance" --gtest_brief=1 --gtest_filter='*water_tank*' || fail "the golden was not written"
[ -s "$work/golden/problems/water_tank.csv" ] || fail "there is no golden"
"$conformance" --gtest_brief=1 --gtest_filter='*water_tank*' || fail "the example does not conform"

"$runner" "$example/configs/problems/water_tank.xml" --out "$work/out" --progress none
table="$work/out/water_tank/tables/water_tank.csv"
random=$(awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "mean") m = i } /^random,/ { print $m }' "$table")
learned=$(awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "mean") m = i } /^fpf_pwl,/ { print $m }' "$table")
awk -v r="$random" -v l="$learned" 'BEGIN { exit !(l < r) }' ||
  fail "the learned policy costs $learned, the random one $random"
