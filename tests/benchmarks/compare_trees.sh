#!/bin/sh
# Compares forests with scikit-learn's ExtraTreesRegressor (Debian's package, which it installs) and with a textbook
# layout of trees, on Friedman's function 1; prints one table. docs/benchmarks.md says what it means.
#   tests/benchmarks/compare_trees.sh [quick] [--rounds N] [--up-to SAMPLES] [--only SECTION]...
# COPPICE_KERNELS=portable (or avx2) measures what processors without the faster instructions get.
set -eu
cd "$(dirname "$0")/../.."

scripts/install_packages.sh bench-trees >&2
scripts/build.sh bench "$(nproc)" tree_driver >&2
# One thread, also in numpy.
OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 exec /usr/bin/python3 tests/benchmarks/compare_trees.py build/tree_driver "$@"
