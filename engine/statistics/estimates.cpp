#include "engine/statistics/estimates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/statistics/mean_estimate.h"

namespace coppice {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<double> sorted(std::span<const double> values) {
  std::vector<double> copy(values.begin(), values.end());
  std::sort(copy.begin(), copy.end());
  return copy;
}

/// Of values whose sum is beyond the range of doubles: the mean of finite ones is within.
double mean_of_large(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0;
  for (double value : values) sum += value / n;
  return sum;
}

/// A power of two that takes squares of deviations into the range of doubles; 1 unless they leave it.
double square_scale(std::span<const double> values, double centre) {
  constexpr double kLarge = 0x1p500;
  double largest = 0;
  for (double value : values) largest = std::max(largest, std::fabs(value - centre));
  return largest > kLarge && std::isfinite(largest) ? 0x1p-600 : 1;
}

}  // namespace

double mean(std::span<const double> values) {
  if (values.empty()) return kNone;
  double sum = 0;
  for (double value : values) sum += value;
  const double first = sum / static_cast<double>(values.size());
  if (!std::isfinite(first)) return mean_of_large(values);
  double rest = 0;  // what rounding left out of the first pass
  for (double value : values) rest += value - first;
  return std::isfinite(rest) ? first + rest / static_cast<double>(values.size()) : first;
}

double standard_deviation(std::span<const double> values) {
  if (values.size() < 2) return kNone;
  const double centre = mean(values);
  const double scale = square_scale(values, centre);
  double squares = 0;
  for (double value : values) {
    const double deviation = (value - centre) * scale;
    squares += deviation * deviation;
  }
  return std::sqrt(squares / static_cast<double>(values.size() - 1)) / scale;
}

double sample_skewness(std::span<const double> values) {
  if (values.size() < 3) return kNone;
  const double n = static_cast<double>(values.size()), centre = mean(values);
  const double deviation = standard_deviation(values);
  if (!(deviation > 0)) return 0;
  double cubes = 0;
  for (double value : values) {
    const double scaled = (value - centre) / deviation;
    cubes += scaled * scaled * scaled;
  }
  return cubes * n / ((n - 1) * (n - 2));
}

double quantile(std::span<const double> values, double p) {
  if (!(p >= 0 && p <= 1)) throw std::logic_error("a quantile's p is in [0, 1]");
  if (values.empty()) return kNone;
  const std::vector<double> order = sorted(values);
  const double position = p * static_cast<double>(order.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, order.size() - 1);
  return order[below] + (position - std::floor(position)) * (order[above] - order[below]);
}

double median(std::span<const double> values) {
  return quantile(values, 0.5);
}

double interquartile_mean(std::span<const double> values) {
  const std::vector<double> order = sorted(values);
  const std::size_t cut = order.size() / 4;
  return mean(std::span<const double>(order).subspan(cut, order.size() - 2 * cut));
}

Estimate estimate(std::span<const double> units, std::optional<Better> better) {
  Estimate result;
  result.units = units.size();
  const Moments known = moments(units);
  result.mean = known.mean;
  result.sd = known.deviation;
  result.skewness = known.skewness;
  result.ci95 = confidence_interval(mean_estimate(known));
  result.median = median(units);
  result.iqm = interquartile_mean(units);
  const double lowest = better ? quantile(units, 0) : kNone;
  const double highest = better ? quantile(units, 1) : kNone;
  result.worst = better == Better::higher ? lowest : highest;
  result.best = better == Better::higher ? highest : lowest;
  return result;
}

Estimate estimate(const std::vector<std::vector<double>>& runs, Unit unit, Better better) {
  std::vector<double> units;
  for (const std::vector<double>& episodes : runs) {
    if (unit == Unit::training_run) {
      units.push_back(mean(episodes));
    } else {
      units.insert(units.end(), episodes.begin(), episodes.end());
    }
  }
  return estimate(units, better);
}

}  // namespace coppice
