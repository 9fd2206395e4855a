#!/bin/sh
# Processor time an evaluation of our CMA-ES and of pagmo2's (Debian's package, which it installs), in one run.
set -eu
cd "$(dirname "$0")/../../.."
scripts/install_packages.sh bench-optimizers >&2
scripts/build.sh bench "$(nproc)" cma_es_table >&2
program=$(mktemp)
trap 'rm -f "$program"' EXIT
g++ -std=c++20 -O3 -I/usr/include/eigen3 tests/benchmarks/optimizers/pagmo_overhead.cpp -o "$program" \
  -lpagmo -ltbb -lboost_serialization
for round in 1 2; do
  build/cma_es_table overhead 5 10 20 40
  "$program"
done
