#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

/// Small symmetric matrices by their lower triangle, column-major in n x n numbers (what lies above the
/// diagonal is not read). Loops run down the columns, so that they are vectorized without changing the order
/// of any sum.
namespace coppice::lower_triangle {

inline void scale(std::vector<double>& a, std::size_t n, double factor) {
  for (std::size_t j = 0; j < n; ++j) {
    double* column = a.data() + j * n;
    for (std::size_t i = j; i < n; ++i) column[i] *= factor;
  }
}

/// a += weight v v'
inline void add_square(std::vector<double>& a, std::size_t n, double weight, std::span<const double> v) {
  for (std::size_t j = 0; j < n; ++j) {
    double* column = a.data() + j * n;
    const double* values = v.data();
    const double factor = weight * values[j];
    for (std::size_t i = j; i < n; ++i) column[i] += factor * values[i];
  }
}

/// out = l v
inline void multiply(const std::vector<double>& l, std::size_t n, std::span<const double> v,
                     std::span<double> out) {
  double* sums = out.data();
  std::fill(sums, sums + n, 0.0);
  for (std::size_t j = 0; j < n; ++j) {
    const double* column = l.data() + j * n;
    const double factor = v[j];
    for (std::size_t i = j; i < n; ++i) sums[i] += factor * column[i];
  }
}

/// v = l^-1 v
inline void solve(const std::vector<double>& l, std::size_t n, std::span<double> v) {
  double* values = v.data();
  for (std::size_t j = 0; j < n; ++j) {
    const double* column = l.data() + j * n;
    values[j] /= column[j];
    const double factor = values[j];
    for (std::size_t i = j + 1; i < n; ++i) values[i] -= factor * column[i];
  }
}

/// l l' = a (Cholesky). False, with l unfinished, when a is not positive definite.
inline bool factorize(const std::vector<double>& a, std::size_t n, std::vector<double>& l) {
  for (std::size_t j = 0; j < n; ++j) {
    double* column = l.data() + j * n;
    std::copy(a.data() + j * n + j, a.data() + (j + 1) * n, column + j);
    for (std::size_t k = 0; k < j; ++k) {
      const double* earlier = l.data() + k * n;
      const double factor = earlier[j];
      for (std::size_t i = j; i < n; ++i) column[i] -= factor * earlier[i];
    }
    if (!(column[j] > 0) || !std::isfinite(column[j])) return false;
    const double scale = 1 / std::sqrt(column[j]);
    for (std::size_t i = j; i < n; ++i) column[i] *= scale;
  }
  return true;
}

}  // namespace coppice::lower_triangle
