#!/bin/sh
# Processor time an evaluation of our CMA-ES and of pagmo2's, in one run:
#   tests/benchmarks/optimizers/overhead.sh build/cma_es_table
set -e
[ -f /usr/include/pagmo/pagmo.hpp ] || apt-get install -y libpagmo-dev
program=$(mktemp)
trap 'rm -f "$program"' EXIT
g++ -std=c++20 -O3 -I/usr/include/eigen3 "$(dirname "$0")/pagmo_overhead.cpp" -o "$program" -lpagmo -ltbb -lboost_serialization
for round in 1 2; do
  "$1" overhead 5 10 20 40
  "$program"
done
