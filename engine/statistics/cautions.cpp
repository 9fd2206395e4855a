#include "engine/statistics/cautions.h"

#include <fmt/format.h>

#include <cmath>

namespace coppice {
namespace {

constexpr double kUnitsForSkewedValues = 50;
constexpr double kClearSkewness = 1;
/// At least 99 of 100 samples of lognormal values have more, whatever their size (tests/coverage measures
/// it).
double harmless_skewness(double units) {
  return kClearSkewness * (units - kUnitsForSkewness) / (kUnitsForSkewedValues - kUnitsForSkewness);
}
/// A value that occurs k times in n, all others being equal, has the skewness sqrt(n / k): 0.5 asks for four.
constexpr double kSkewnessPerRoot = 0.5;

}  // namespace

std::string caution(double units, double skewness, std::string_view unit) {
  if (units < 2) return fmt::format("one of the {}: no interval", unit);
  if (units < kUnitsForSkewness) {
    return fmt::format("only {} {}: the interval holds for normal values", units, unit);
  }
  const double amount = std::fabs(skewness);
  if (units < kUnitsForSkewedValues && amount > kClearSkewness) {
    return fmt::format("skewed (skewness {:.2g}): {} {} are fewer than the {} that the interval needs",
                       skewness, units, unit, kUnitsForSkewedValues);
  }
  if (units < kUnitsForSkewedValues && amount >= harmless_skewness(units)) {
    return fmt::format(
        "{} {} cannot rule out skewed values (skewness {:.2g}), of which the interval needs {}", units, unit,
        skewness, kUnitsForSkewedValues);
  }
  if (amount > kSkewnessPerRoot * std::sqrt(units)) {
    return fmt::format("a few of the {} {} decide the mean (skewness {:.2g}): the interval may miss it",
                       units, unit, skewness);
  }
  return {};
}

std::string caution(const Moments& units, std::string_view unit) {
  if (units.n >= 2) {
    if (!std::isfinite(units.mean)) return fmt::format("the {} have no finite mean", unit);
    if (!confidence_interval(mean_estimate(units))) {
      return fmt::format("values of the {} are too large for an interval", unit);
    }
    if (!(units.deviation > 0)) {
      return fmt::format("all {} {} are equal: the interval knows of no other values", units.n, unit);
    }
  }
  return caution(units.n, units.skewness, unit);
}

}  // namespace coppice
