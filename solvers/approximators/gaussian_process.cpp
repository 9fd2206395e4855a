#include "solvers/approximators/gaussian_process.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "engine/vocabulary/elementary.h"

namespace coppice {
namespace {

// Below it, rounding has eaten what is left of a sample's own variance.
constexpr double kLeastPivot = 1e-13;

/// A sum of products in a fixed order of four lanes.
double dot(const double* a, const double* b, std::size_t n) {
  std::array<double, 4> lane{};
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {
    for (std::size_t l = 0; l < 4; ++l) lane[l] += a[i + l] * b[i + l];
  }
  double sum = (lane[0] + lane[2]) + (lane[1] + lane[3]);
  for (; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

void GaussianProcess::correlations(std::span<const double> x, std::span<double> out) const {
  const std::size_t d = inputs();
  for (std::size_t i = 0; i < out.size(); ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < d; ++k) {
      const double t = (x[k] - places_[i * d + k]) / kernel_.lengths[k];
      sum += t * t;
    }
    out[i] = elementary::exp(-0.5 * sum);
  }
}

void GaussianProcess::append(std::span<const double> x, double weight) {
  if (x.size() != inputs() || !(weight > 0)) throw std::logic_error("GaussianProcess: not a sample");
  places_.insert(places_.end(), x.begin(), x.end());
  noise_.push_back(1 / weight);
  factor_last();
}

// Element (i, j) loses its products in the order of columns, whether rows come one by one or all at once.
void GaussianProcess::factor_last() {
  const std::size_t last = factor_.size();
  std::vector<double> row(last);
  correlations({places_.data() + last * inputs(), inputs()}, row);
  solve_lower(row);
  double pivot = 1 + kernel_.noise * noise_[last];
  for (std::size_t j = 0; j < last; ++j) pivot -= row[j] * row[j];
  for (std::size_t j = 0; j < last; ++j) factor_[j].push_back(row[j]);
  factor_.push_back({std::sqrt(std::max(pivot, kLeastPivot))});
}

void GaussianProcess::set_kernel(GaussianKernel kernel) {
  kernel_ = std::move(kernel);
  factor_.clear();
  while (factor_.size() < noise_.size()) factor_last();
}

void GaussianProcess::solve_lower(std::vector<double>& b) const {
  const std::size_t n = b.size();
  for (std::size_t j = 0; j < n; ++j) {
    const double* column = factor_[j].data();
    const double value = b[j] /= column[0];
    double* rest = b.data() + j;
    for (std::size_t i = 1; i < n - j; ++i) rest[i] -= value * column[i];
  }
}

void GaussianProcess::solve_upper(std::vector<double>& b) const {
  const std::size_t n = b.size();
  for (std::size_t j = n; j-- > 0;) {
    const double* column = factor_[j].data();
    b[j] = (b[j] - dot(column + 1, b.data() + j + 1, n - j - 1)) / column[0];
  }
}

void GaussianProcess::set_values(std::span<const double> values) {
  if (values.size() != size()) throw std::logic_error("GaussianProcess: values and places differ in number");
  values_.assign(values.begin(), values.end());
  const std::size_t n = size();
  std::vector<double> one(n, 1.0), y = values_;
  solve_lower(one);
  solve_lower(y);
  const double weight = dot(one.data(), one.data(), n);
  constant_ = weight > 0 ? dot(one.data(), y.data(), n) / weight : 0;
  for (std::size_t i = 0; i < n; ++i) y[i] -= constant_ * one[i];
  scale_ = n > 0 ? dot(y.data(), y.data(), n) / static_cast<double>(n) : 0;
  alpha_ = std::move(y);
  solve_upper(alpha_);
}

std::vector<double> GaussianProcess::inverse() const {
  const std::size_t n = size();
  std::vector<double> root(n * n), out(n * n);  // L^-1 by columns
  for (std::size_t j = 0; j < n; ++j) {
    double* column = root.data() + j * n;
    column[j] = 1;
    for (std::size_t k = j; k < n; ++k) {
      const double* l = factor_[k].data();
      const double value = column[k] /= l[0];
      for (std::size_t i = k + 1; i < n; ++i) column[i] -= value * l[i - k];
    }
  }
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = j; i < n; ++i) out[j * n + i] = dot(&root[i * n + i], &root[j * n + i], n - i);
  }
  return out;
}

double GaussianProcess::log_likelihood(std::span<double> gradient) const {
  const std::size_t n = size(), d = inputs();
  const double scale = std::max(scale_, 1e-300);
  double value = -0.5 * static_cast<double>(n) * (elementary::log(2 * std::numbers::pi * scale) + 1);
  for (const std::vector<double>& column : factor_) value -= elementary::log(column[0]);
  if (gradient.empty()) return value;

  // d/dt = 1/2 sum_ij P_ij dA_ij/dt, P = alpha alpha' / scale - A^-1 (Rasmussen and Williams, eq. 5.9); mean
  // and scale are at their optimum and add nothing.
  std::fill(gradient.begin(), gradient.end(), 0.0);
  const std::vector<double> inverted = inverse();
  std::vector<double> correlation(n);
  for (std::size_t j = 0; j < n; ++j) {
    correlations(place(j), correlation);
    for (std::size_t i = j + 1; i < n; ++i) {
      const double part = (alpha_[i] * alpha_[j] / scale - inverted[j * n + i]) * correlation[i];
      for (std::size_t k = 0; k < d; ++k) {
        const double t = (places_[i * d + k] - places_[j * d + k]) / kernel_.lengths[k];
        gradient[k] += part * t * t;
      }
    }
    gradient[d] += 0.5 * (alpha_[j] * alpha_[j] / scale - inverted[j * n + j]) * kernel_.noise * noise_[j];
  }
  return value;
}

GaussianPosterior GaussianProcess::posterior(std::span<const double> x) const {
  std::vector<double> correlation(size());
  correlations(x, correlation);
  GaussianPosterior at;
  at.mean = constant_ + dot(correlation.data(), alpha_.data(), size());
  solve_lower(correlation);
  at.variance = scale_ * std::max(1 - dot(correlation.data(), correlation.data(), size()), 0.0);
  return at;
}

GaussianPosterior GaussianProcess::posterior(std::span<const double> x, std::span<double> mean_gradient,
                                             std::span<double> variance_gradient) const {
  const std::size_t n = size(), d = inputs();
  std::vector<double> correlation(n);
  correlations(x, correlation);
  std::vector<double> solved = correlation;
  solve_lower(solved);
  GaussianPosterior at;
  at.mean = constant_ + dot(correlation.data(), alpha_.data(), n);
  at.variance = scale_ * std::max(1 - dot(solved.data(), solved.data(), n), 0.0);
  solve_upper(solved);
  std::fill(mean_gradient.begin(), mean_gradient.end(), 0.0);
  std::fill(variance_gradient.begin(), variance_gradient.end(), 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < d; ++k) {
      const double slope =
          correlation[i] * (places_[i * d + k] - x[k]) / (kernel_.lengths[k] * kernel_.lengths[k]);
      mean_gradient[k] += alpha_[i] * slope;
      variance_gradient[k] -= 2 * scale_ * solved[i] * slope;
    }
  }
  return at;
}

}  // namespace coppice
