#include "solvers/approximators/least_squares.h"

#include <algorithm>
#include <cmath>

namespace coppice {
namespace {

// A direction with less than this part of its variance left, given the inputs before it, counts as dependent.
constexpr double kDependent = 1e-10;

constexpr std::size_t triangle(std::size_t row) {
  return row * (row + 1) / 2;
}

}  // namespace

Moments::Moments(std::size_t inputs)
    : size_(inputs + 1),
      centre_(size_),
      sum_(size_),
      product_(triangle(size_)),
      scale_(size_),
      correlation_(triangle(size_)),
      cholesky_(triangle(size_)),
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

void Moments::set_difference(const Moments& whole, const Moments& part) {
  centre_ = whole.centre_;
  weight_ = whole.weight_ - part.weight_;
  for (std::size_t i = 0; i < size_; ++i) sum_[i] = whole.sum_[i] - part.sum_[i];
  for (std::size_t i = 0; i < product_.size(); ++i) product_[i] = whole.product_[i] - part.product_[i];
}

// Cholesky factor of the inputs' correlations, with `ridge` added to the diagonal; false when it is singular.
bool Moments::factor(double ridge) {
  const std::size_t n = size_ - 1;
  for (std::size_t i = 0; i < n; ++i) {
    double* row = cholesky_.data() + triangle(i);
    for (std::size_t j = 0; j <= i; ++j) {
      const double* other = cholesky_.data() + triangle(j);
      double rest = correlation_[triangle(i) + j] + (i == j ? ridge : 0.0);
      for (std::size_t k = 0; k < j; ++k) rest -= row[k] * other[k];
      if (i == j && !(rest > kDependent)) return false;
      row[j] = i == j ? std::sqrt(rest) : rest / other[j];
    }
  }
  return true;
}

double Moments::fit(double& bias, std::span<double> slopes) {
  const std::size_t n = size_ - 1;
  // Correlations about the samples' own mean; an input without variance is replaced by an independent one.
  const auto central = [&](std::size_t i, std::size_t j) {
    return product_[triangle(i) + j] - sum_[i] * (sum_[j] / weight_);
  };
  for (std::size_t i = 0; i < size_; ++i) {
    const double variance = central(i, i);
    const double noise = 1e-14 * product_[triangle(i) + i];  // of the difference above
    scale_[i] = variance > noise ? std::sqrt(variance) : 0.0;
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const bool varies = scale_[i] > 0 && scale_[j] > 0;
      correlation_[triangle(i) + j] = varies ? central(i, j) / scale_[i] / scale_[j] : 0.0;
    }
    correlation_[triangle(i) + i] = 1;
  }
  if (!factor(0)) factor(kRidge);

  // cholesky cholesky^T slopes = correlations with y; with the ridge as without, both residuals below are >=
  // 0.
  for (std::size_t i = 0; i < n; ++i) {
    double rest = scale_[i] > 0 ? central(n, i) / scale_[i] : 0.0;
    const double* row = cholesky_.data() + triangle(i);
    for (std::size_t k = 0; k < i; ++k) rest -= row[k] * solution_[k];
    solution_[i] = rest / row[i];
  }
  double explained = 0;
  for (std::size_t i = 0; i < n; ++i) explained += solution_[i] * solution_[i];
  for (std::size_t i = n; i-- > 0;) {
    double rest = solution_[i];
    for (std::size_t k = i + 1; k < n; ++k) rest -= cholesky_[triangle(k) + i] * solution_[k];
    solution_[i] = rest / cholesky_[triangle(i) + i];
  }
  bias = centre_[n] + sum_[n] / weight_;
  for (std::size_t i = 0; i < n; ++i) {
    slopes[i] = scale_[i] > 0 ? solution_[i] / scale_[i] : 0.0;
    bias -= slopes[i] * (centre_[i] + sum_[i] / weight_);
  }
  return std::max(0.0, central(n, n) - explained);
}

}  // namespace coppice
