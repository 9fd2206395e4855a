#include "solvers/optimizers/cma_es_learning_rates.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/vocabulary/elementary.h"
#include "solvers/optimizers/lower_triangle.h"

namespace coppice {
namespace {

// Nomura et al., Table 1.
constexpr double kAlpha = 1.4;  // signal-to-noise ratio aimed at, for rate 1
constexpr double kGamma = 0.1;
constexpr double kMeanDecay = 0.1;
constexpr double kCovarianceDecay = 0.03;

/// l^-1 a l^-T of a symmetric `a`, whose both triangles are given and overwritten.
void whiten(const std::vector<double>& l, std::size_t n, std::vector<double>& a) {
  for (int side = 0; side < 2; ++side) {
    for (std::size_t j = 0; j < n; ++j) lower_triangle::solve(l, n, {a.data() + j * n, n});
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t i = 0; i < j; ++i) std::swap(a[j * n + i], a[i * n + j]);
    }
  }
}

}  // namespace

CmaLearningRates::CmaLearningRates(std::size_t dimension)
    : mean_{kMeanDecay, std::vector<double>(dimension)},
      covariance_{kCovarianceDecay, std::vector<double>(dimension * dimension)} {}

void CmaLearningRates::Follower::follow(const std::vector<double>& update) {
  double update_square = 0, average_square = 0;
  for (std::size_t i = 0; i < update.size(); ++i) {
    average[i] = (1 - decay) * average[i] + decay * update[i];
    update_square += update[i] * update[i];
    average_square += average[i] * average[i];
  }
  square = (1 - decay) * square + decay * update_square;
  if (!(square > average_square)) return;
  const double ratio = (average_square - decay / (2 - decay) * square) / (square - average_square);
  const double relative = std::clamp(ratio / kAlpha / rate - 1, -1.0, 1.0);
  rate = std::min(1.0, rate * elementary::exp(std::min(kGamma * rate, decay) * relative));
}

bool CmaLearningRates::shorten(const CmaDistribution& before, CmaDistribution& after) {
  const std::size_t n = before.dimension();
  update_.resize(n);
  before.standardize(after.mean_, update_);
  mean_.rate = std::max(mean_.rate, 1e-12);
  const double rate_before = mean_.rate;
  mean_.follow(update_);
  for (std::size_t i = 0; i < n; ++i) {
    after.mean_[i] = before.mean_[i] + mean_.rate * (after.mean_[i] - before.mean_[i]);
  }

  // The change of sigma^2 C in units of the old sigma^2.
  const double growth = (after.sigma_ / before.sigma_) * (after.sigma_ / before.sigma_);
  update_.resize(n * n);
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = j; i < n; ++i) {
      const std::size_t at = j * n + i;
      update_[at] = growth * after.covariance_[at] - before.covariance_[at];
      update_[i * n + j] = update_[at];
    }
  }
  std::vector<double> change = update_;
  whiten(before.factor_, n, update_);
  for (double& u : update_) u /= std::sqrt(2.0);
  covariance_.follow(update_);
  for (std::size_t i = 0; i < n * n; ++i) {
    after.covariance_[i] = before.covariance_[i] + covariance_.rate * change[i];
  }
  if (!lower_triangle::factorize(after.covariance_, n, after.factor_)) return false;
  // sigma takes the determinant's root, so that C has determinant 1.
  double logarithm = 0;
  for (std::size_t i = 0; i < n; ++i) logarithm += elementary::log(after.factor_[i * n + i]);
  const double root = elementary::exp(logarithm / static_cast<double>(n));
  lower_triangle::scale(after.covariance_, n, 1 / (root * root));
  lower_triangle::scale(after.factor_, n, 1 / root);
  after.sigma_ = before.sigma_ * root * (rate_before / mean_.rate);
  return std::isfinite(after.sigma_) && after.sigma_ > 0;
}

void CmaLearningRates::save(Archive& archive) const {
  archive.put("mean_average", mean_.average);
  archive.put("covariance_average", covariance_.average);
  archive.put("numbers", std::vector<double>{mean_.square, mean_.rate, covariance_.square, covariance_.rate});
}

void CmaLearningRates::load(Archive& archive) {
  mean_.average = archive.get<std::vector<double>>("mean_average");
  covariance_.average = archive.get<std::vector<double>>("covariance_average");
  const auto& numbers = archive.get<std::vector<double>>("numbers");
  mean_.square = numbers.at(0);
  mean_.rate = numbers.at(1);
  covariance_.square = numbers.at(2);
  covariance_.rate = numbers.at(3);
}

}  // namespace coppice
