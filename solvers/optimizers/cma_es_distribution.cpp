#include "solvers/optimizers/cma_es_distribution.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/vocabulary/elementary.h"
#include "solvers/optimizers/lower_triangle.h"

namespace coppice {
namespace {

double squared_length(std::span<const double> v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return sum;
}

}  // namespace

CmaDistribution::CmaDistribution(std::vector<double> mean, double sigma, bool separable)
    : separable_(separable), mean_(std::move(mean)), sigma_(sigma) {
  const std::size_t n = mean_.size();
  covariance_.assign(separable ? n : n * n, separable ? 1 : 0);
  if (!separable) {
    for (std::size_t i = 0; i < n; ++i) covariance_[i * n + i] = 1;
  }
  factor_ = covariance_;
  path_sigma_.assign(n, 0);
  path_c_.assign(n, 0);
}

double CmaDistribution::largest_deviation() const {
  double largest = 0;
  const std::size_t stride = separable_ ? 1 : dimension() + 1;
  for (std::size_t i = 0; i < dimension(); ++i) largest = std::max(largest, covariance_[i * stride]);
  return sigma_ * std::sqrt(largest);
}

double CmaDistribution::condition() const {
  const std::size_t stride = separable_ ? 1 : dimension() + 1;
  double smallest = factor_[0], largest = factor_[0];
  for (std::size_t i = 0; i < dimension(); ++i) {
    smallest = std::min(smallest, factor_[i * stride]);
    largest = std::max(largest, factor_[i * stride]);
  }
  return (largest / smallest) * (largest / smallest);
}

void CmaDistribution::apply_factor(std::span<const double> step, std::span<double> out) const {
  const std::size_t n = dimension();
  if (separable_) {
    for (std::size_t i = 0; i < n; ++i) out[i] = factor_[i] * step[i];
  } else {
    lower_triangle::multiply(factor_, n, step, out);
  }
}

void CmaDistribution::sample(Stream& stream, const BoxMap& box, int attempts, std::size_t count,
                             std::vector<double>& steps, std::vector<double>& points) const {
  const std::size_t n = dimension();
  steps.resize(count * n);
  points.resize(count * n);
  for (std::size_t k = 0; k < count; ++k) {
    const std::span<double> step(steps.data() + k * n, n), point(points.data() + k * n, n);
    for (int attempt = 0; attempt < attempts; ++attempt) {
      for (double& z : step) z = stream.normal();
      apply_factor(step, point);
      for (std::size_t i = 0; i < n; ++i) point[i] = mean_[i] + sigma_ * point[i];
      if (box.contains(point)) break;
    }
  }
}

void CmaDistribution::standardize(std::span<const double> point, std::span<double> step) const {
  const std::size_t n = dimension();
  for (std::size_t i = 0; i < n; ++i) step[i] = (point[i] - mean_[i]) / sigma_;
  if (separable_) {
    for (std::size_t i = 0; i < n; ++i) step[i] /= factor_[i];
  } else {
    lower_triangle::solve(factor_, n, step);
  }
}

/// Eqs. 41 to 45: the mean, both paths, and whether the step size grows too fast for the rank-one update.
void CmaDistribution::update_paths(const CmaRates& rates, std::span<const double> steps,
                                   std::span<const std::uint32_t> order) {
  const std::size_t n = dimension();
  scratch_.assign(2 * n, 0);
  const std::span<double> z(scratch_.data(), n), y(scratch_.data() + n, n);
  for (std::size_t k = 0; k < order.size() && rates.weights[k] > 0; ++k) {
    const double* step = steps.data() + order[k] * n;
    for (std::size_t i = 0; i < n; ++i) z[i] += rates.weights[k] * step[i];
  }
  apply_factor(z, y);
  const double keep = 1 - rates.c_sigma;
  const double gain = std::sqrt(rates.c_sigma * (2 - rates.c_sigma) * rates.mu_eff);
  for (std::size_t i = 0; i < n; ++i) {
    mean_[i] += sigma_ * y[i];
    path_sigma_[i] = keep * path_sigma_[i] + gain * z[i];
  }
  ++generation_;
  const double length = std::sqrt(squared_length(path_sigma_));
  const double begun = 1 - elementary::pow(keep, 2 * static_cast<double>(generation_));
  long_step_ = length / std::sqrt(begun) >= (1.4 + 2 / (static_cast<double>(n) + 1)) * rates.expected_length;
  const double gain_c = long_step_ ? 0 : std::sqrt(rates.c_c * (2 - rates.c_c) * rates.mu_eff);
  for (std::size_t i = 0; i < n; ++i) path_c_[i] = (1 - rates.c_c) * path_c_[i] + gain_c * y[i];
  // Eq. 44; no more than e-fold in one generation
  sigma_ *=
      elementary::exp(std::min(1.0, rates.c_sigma / rates.d_sigma * (length / rates.expected_length - 1)));
}

/// Eqs. 46 and 47. Negative weights are scaled by n / |z|^2, so that no step takes more than its share.
void CmaDistribution::update_full(const CmaRates& rates, std::span<const double> steps,
                                  std::span<const std::uint32_t> order) {
  const std::size_t n = dimension();
  const double lost = long_step_ ? rates.c_1 * rates.c_c * (2 - rates.c_c) : 0;
  lower_triangle::scale(covariance_, n, 1 + lost - rates.c_1 - rates.c_mu * rates.weight_sum);
  lower_triangle::add_square(covariance_, n, rates.c_1, path_c_);
  scratch_.resize(n);
  for (std::size_t k = 0; k < order.size(); ++k) {
    double w = rates.weights[k];
    if (w == 0) continue;
    const std::span<const double> z = steps.subspan(order[k] * n, n);
    if (w < 0) w *= static_cast<double>(n) / squared_length(z);
    apply_factor(z, scratch_);
    lower_triangle::add_square(covariance_, n, rates.c_mu * w, scratch_);
  }
}

void CmaDistribution::update_diagonal(const CmaRates& rates, std::span<const double> steps,
                                      std::span<const std::uint32_t> order) {
  const std::size_t n = dimension();
  const double lost = long_step_ ? rates.c_1 * rates.c_c * (2 - rates.c_c) : 0;
  const double keep = 1 + lost - rates.c_1 - rates.c_mu * rates.weight_sum;
  for (std::size_t i = 0; i < n; ++i) {
    covariance_[i] = keep * covariance_[i] + rates.c_1 * path_c_[i] * path_c_[i];
  }
  for (std::size_t k = 0; k < order.size(); ++k) {
    double w = rates.weights[k];
    if (w == 0) continue;
    const std::span<const double> z = steps.subspan(order[k] * n, n);
    if (w < 0) w *= static_cast<double>(n) / squared_length(z);
    for (std::size_t i = 0; i < n; ++i) {
      const double y = factor_[i] * z[i];
      covariance_[i] += rates.c_mu * w * y * y;
    }
  }
}

bool CmaDistribution::factorize() {
  if (!separable_) return lower_triangle::factorize(covariance_, dimension(), factor_);
  for (std::size_t i = 0; i < dimension(); ++i) {
    if (!(covariance_[i] > 0)) return false;
    factor_[i] = std::sqrt(covariance_[i]);
  }
  return true;
}

bool CmaDistribution::update(const CmaRates& rates, std::span<const double> steps,
                             std::span<const std::uint32_t> order) {
  update_paths(rates, steps, order);
  if (separable_) {
    update_diagonal(rates, steps, order);
  } else {
    update_full(rates, steps, order);
  }
  return factorize() && std::isfinite(sigma_) && sigma_ > 0;
}

void CmaDistribution::save(Archive& archive) const {
  archive.put("mean", mean_);
  archive.put("sigma", std::vector<double>{sigma_});
  archive.put("covariance", covariance_);
  archive.put("factor", factor_);
  archive.put("path_sigma", path_sigma_);
  archive.put("path_c", path_c_);
  archive.put("generation", std::vector<std::int64_t>{generation_});
}

void CmaDistribution::load(Archive& archive) {
  mean_ = archive.get<std::vector<double>>("mean");
  sigma_ = archive.get<std::vector<double>>("sigma").at(0);
  covariance_ = archive.get<std::vector<double>>("covariance");
  factor_ = archive.get<std::vector<double>>("factor");
  path_sigma_ = archive.get<std::vector<double>>("path_sigma");
  path_c_ = archive.get<std::vector<double>>("path_c");
  generation_ = archive.get<std::vector<std::int64_t>>("generation").at(0);
}

}  // namespace coppice
