#include "solvers/approximators/least_squares.h"

#include <algorithm>
#include <cmath>

namespace coppice {
namespace {

constexpr std::size_t row_begin(std::size_t row) {
  return row * (row + 1) / 2;
}

}  // namespace

Moments::Moments(std::size_t inputs)
    : size_(inputs + 1),
      centre_(size_),
      sum_(size_),
      product_(row_begin(size_)),
      scale_(size_),
      correlation_(row_begin(size_)),
      cholesky_(row_begin(size_)),
      solution_(size_) {}

void Moments::reset(std::span<const double> centre) {
  std::copy(centre.begin(), centre.end(), centre_.begin());
  weight_ = 0;
  std::fill(sum_.begin(), sum_.end(), 0.0);
  std::fill(product_.begin(), product_.end(), 0.0);
}

void Moments::add(const double* xy, double weight) {
  weight_ += weight;
  double* product = product_.data();
  double* difference = solution_.data();
  for (std::size_t i = 0; i < size_; ++i) {
    difference[i] = xy[i] - centre_[i];
    const double weighted = weight * difference[i];
    sum_[i] += weighted;
    for (std::size_t j = 0; j <= i; ++j) *product++ += weighted * difference[j];
  }
}

void Moments::set(std::span<const float> centre, std::span<const double> products) {
  std::copy(centre.begin(), centre.end(), centre_.begin());
  weight_ = products[0];
  const double* next = products.data() + 1;
  double* product = product_.data();
  for (std::size_t i = 0; i < size_; ++i) {
    sum_[i] = *next++;
    product = std::copy(next, next + i + 1, product);
    next += i + 1;
  }
}

void Moments::set_difference(const Moments& whole, const Moments& part) {
  centre_ = whole.centre_;
  weight_ = whole.weight_ - part.weight_;
  for (std::size_t i = 0; i < size_; ++i) sum_[i] = whole.sum_[i] - part.sum_[i];
  for (std::size_t i = 0; i < product_.size(); ++i) product_[i] = whole.product_[i] - part.product_[i];
}

// Product of inputs i and j (the last one is the output) about the samples' own mean.
double Moments::central(std::size_t i, std::size_t j) const {
  return product_[row_begin(i) + j] - sum_[i] * (sum_[j] / weight_);
}

// Cholesky factor of the inputs' correlations, with `ridge` added to the diagonal; false when it is singular.
bool Moments::factor(double ridge, double dependent) {
  const std::size_t n = size_ - 1;
  for (std::size_t i = 0; i < n; ++i) {
    double* row = cholesky_.data() + row_begin(i);
    for (std::size_t j = 0; j <= i; ++j) {
      const double* other = cholesky_.data() + row_begin(j);
      double rest = correlation_[row_begin(i) + j] + (i == j ? ridge : 0.0);
      for (std::size_t k = 0; k < j; ++k) rest -= row[k] * other[k];
      if (i == j && !(rest > dependent)) return false;
      row[j] = i == j ? std::sqrt(rest) : rest / other[j];
    }
  }
  return true;
}

// Solves cholesky solution = correlations with y, and returns the sum of squares that is left; it is >= 0
// with the ridge as without. An input without variance is replaced by an independent one.
double Moments::solve(double dependent) {
  const std::size_t n = size_ - 1;
  for (std::size_t i = 0; i < size_; ++i) {
    const double variance = central(i, i);
    const double noise = 1e-4 * dependent * product_[row_begin(i) + i];  // of a difference
    scale_[i] = variance > noise ? std::sqrt(variance) : 0.0;
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const bool varies = scale_[i] > 0 && scale_[j] > 0;
      correlation_[row_begin(i) + j] = varies ? central(i, j) / scale_[i] / scale_[j] : 0.0;
    }
    correlation_[row_begin(i) + i] = 1;
  }
  if (!factor(0, dependent)) factor(std::max(kRidge, 10 * dependent), dependent);
  double explained = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double rest = scale_[i] > 0 ? central(n, i) / scale_[i] : 0.0;
    const double* row = cholesky_.data() + row_begin(i);
    for (std::size_t k = 0; k < i; ++k) rest -= row[k] * solution_[k];
    solution_[i] = rest / row[i];
    explained += solution_[i] * solution_[i];
  }
  return std::max(0.0, central(n, n) - explained);
}

double Moments::fit(double& bias, std::span<double> slopes) {
  const std::size_t n = size_ - 1;
  const double residual = solve(kDependent);
  for (std::size_t i = n; i-- > 0;) {
    double rest = solution_[i];
    for (std::size_t k = i + 1; k < n; ++k) rest -= cholesky_[row_begin(k) + i] * solution_[k];
    solution_[i] = rest / cholesky_[row_begin(i) + i];
  }
  bias = centre_[n] + sum_[n] / weight_;
  for (std::size_t i = 0; i < n; ++i) {
    slopes[i] = scale_[i] > 0 ? solution_[i] / scale_[i] : 0.0;
    bias -= slopes[i] * (centre_[i] + sum_[i] / weight_);
  }
  return residual;
}

}  // namespace coppice
