#include "solvers/optimizers/cma_es_rates.h"

#include <algorithm>
#include <cmath>

#include "engine/vocabulary/elementary.h"

namespace coppice {
namespace {

/// Both learning rates of the covariance beside the tutorial's, which aim at robustness: 5 to 11 % fewer
/// evaluations on ellipsoids (docs/optimizers.md).
constexpr double kFaster = 1.25;

/// ln((lambda + 1)/2) - ln i, scaled: the positive weights to the sum 1, the negative ones by Eq. 53.
void set_weights(CmaRates& rates, double n, bool active) {
  const double middle = elementary::log((static_cast<double>(rates.population) + 1) / 2);
  double positive = 0, positive_squares = 0, negative = 0, negative_squares = 0;
  for (std::size_t i = 0; i < rates.population; ++i) {
    const double w = middle - elementary::log(static_cast<double>(i + 1));
    rates.weights.push_back(w);
    (w > 0 ? positive : negative) += std::fabs(w);
    (w > 0 ? positive_squares : negative_squares) += w * w;
  }
  rates.mu_eff = positive * positive / positive_squares;
  const double negative_mu_eff = negative_squares > 0 ? negative * negative / negative_squares : 0;
  for (double& w : rates.weights) {
    if (w > 0) w /= positive;
  }
  rates.c_1 = kFaster * 2 / ((n + 1.3) * (n + 1.3) + rates.mu_eff);
  rates.c_mu = std::min(1 - rates.c_1, kFaster * 2 * (0.25 + rates.mu_eff + 1 / rates.mu_eff - 2) /
                                           ((n + 2) * (n + 2) + rates.mu_eff));
  const double scale = std::min({1 + rates.c_1 / rates.c_mu, 1 + 2 * negative_mu_eff / (rates.mu_eff + 2),
                                 (1 - rates.c_1 - rates.c_mu) / (n * rates.c_mu)});
  for (double& w : rates.weights) {
    if (w <= 0) w = active && negative > 0 ? w * scale / negative : 0;
  }
}

}  // namespace

std::size_t default_population(std::size_t dimension) {
  return 4 + static_cast<std::size_t>(3 * elementary::log(static_cast<double>(dimension)));
}

CmaRates cma_rates(std::size_t dimension, std::size_t population, bool active, bool separable) {
  const auto n = static_cast<double>(dimension);
  CmaRates rates;
  rates.population = population;
  set_weights(rates, n, active);
  const double mu_eff = rates.mu_eff;
  rates.c_sigma = (mu_eff + 2) / (n + mu_eff + 5);
  rates.d_sigma = 1 + 2 * std::max(0.0, std::sqrt((mu_eff - 1) / (n + 1)) - 1) + rates.c_sigma;
  rates.c_c = (4 + mu_eff / n) / (n + 4 + 2 * mu_eff / n);
  if (separable) {
    rates.c_1 = std::min(0.5, rates.c_1 * (n + 2) / 3);
    rates.c_mu = std::min(1 - rates.c_1, rates.c_mu * (n + 2) / 3);
  }
  for (const double w : rates.weights) rates.weight_sum += w;
  rates.expected_length = std::sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
  return rates;
}

}  // namespace coppice
