#include "solvers/optimizers/acquisition.h"

#include <cmath>
#include <numbers>

#include "engine/vocabulary/elementary.h"

namespace coppice {
namespace {

using elementary::log;

const double kLogRoot2Pi = 0.5 * log(2 * std::numbers::pi);

double density(double u) {
  return elementary::exp(-0.5 * u * u - kLogRoot2Pi);
}
double distribution(double u) {
  return 0.5 * elementary::erfc(-u / std::numbers::sqrt2);
}

/// log(density(u) + u distribution(u)) and its derivative, distribution(u) over that sum. Far to the left
/// both lose their digits by cancellation: there by their asymptotic series in q = 1 / u^2.
void log_improvement(double u, double& value, double& slope) {
  if (u > -12) {
    const double sum = density(u) + u * distribution(u);
    value = log(sum);
    slope = distribution(u) / sum;
    return;
  }
  const double q = 1 / (u * u);
  const double series = 1 - q * (3 - q * (15 - q * (105 - q * 945)));
  value = -0.5 * u * u - kLogRoot2Pi + log(q * series);
  slope = -u * (1 - q * (1 - q * (3 - q * (15 - q * 105)))) / series;
}

}  // namespace

Promise log_expected_improvement(double mean, double deviation, double best) {
  const double u = (mean - best) / deviation;
  double value = 0, slope = 0;
  log_improvement(u, value, slope);
  return {log(deviation) + value, slope / deviation, (1 - slope * u) / deviation};
}

Promise log_improvement_probability(double mean, double deviation, double best) {
  const double u = (mean - best) / deviation;
  double value = 0, slope = 0;
  if (u > -30) {
    const double below = distribution(u);
    value = log(below);
    slope = density(u) / below;
  } else {
    const double q = 1 / (u * u);
    const double series = 1 - q * (1 - q * (3 - q * 15));
    value = -0.5 * u * u - kLogRoot2Pi + log(-series / u);
    slope = -u / series;
  }
  return {value, slope / deviation, -slope * u / deviation};
}

Promise upper_bound(double mean, double deviation, double width) {
  return {mean + width * deviation, 1, width};
}

double bound_width(double evaluations, double dimensions, double delta, double factor) {
  const double pi = std::numbers::pi;
  const double beta = 2 * ((0.5 * dimensions + 2) * log(evaluations) + log(pi * pi / (3 * delta)));
  return factor * std::sqrt(beta);
}

}  // namespace coppice
