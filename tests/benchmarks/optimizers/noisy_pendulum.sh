#!/bin/sh
# The table of docs/optimizers.md about the noisy pendulum: median cost over the searches of each optimizer, with and
# without common random numbers. Arguments go to the runner (scale:=ci, -j 1, ...).
set -eu
cd "$(dirname "$0")/../../.."
out=${OUT:-out}
build/runner configs/sweeps/noisy_pendulum.xml scale:=desk --out "$out" "$@" >&2
for point in "$out"/noisy_pendulum/nodes/scores/optimizer=*; do
  median=$(for file in "$point"/tuned/*/evaluation.csv; do
    awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "mean_cost") column = i } NR == 2 { print $column }' "$file"
  done | sort -g | awk '{ cost[NR] = $1 } END { printf "%.4g of %d", cost[int((NR + 1) / 2)], NR }')
  echo "$(basename "$point"): $median"
done
