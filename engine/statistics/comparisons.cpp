#include "engine/statistics/comparisons.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "engine/statistics/student.h"
#include "engine/vocabulary/elementary.h"

namespace coppice {
namespace {

/// The squared standard error that made Student's interval.
double variance_of_mean(const Summary& summary) {
  const double half = (summary.ci95->high - summary.ci95->low) / 2;
  const double error = half / student_t_quantile(0.975, static_cast<double>(summary.units - 1));
  return error * error;
}

/// Newcombe's variance of an estimated probability of improvement, were it p.
double improvement_variance(double p, double n, double m) {
  const double mean_size = (n + m) / 2 - 1;
  return p * (1 - p) * (1 + mean_size * ((1 - p) / (2 - p) + p / (1 + p))) / (n * m);
}

/// Where the estimate is just `z` errors from p, between it and `end` (0 or 1): there p is further away than
/// z errors, at the estimate itself nearer.
double improvement_limit(double estimate, double end, double z, double n, double m) {
  double inside = estimate, outside = end;
  for (int i = 0; i < 60; ++i) {
    const double p = (inside + outside) / 2;
    const bool near = std::fabs(estimate - p) <= z * std::sqrt(improvement_variance(p, n, m));
    (near ? inside : outside) = p;
  }
  return (inside + outside) / 2;
}

}  // namespace

std::optional<Interval> welch_interval(const Summary& first, const Summary& second) {
  if (!first.ci95 || !second.ci95 || first.units < 2 || second.units < 2) return std::nullopt;
  const double difference = second.mean - first.mean;
  const double a = variance_of_mean(first), b = variance_of_mean(second);
  if (!(a + b > 0)) return Interval{difference, difference};
  const double degrees =
      (a + b) * (a + b) /
      (a * a / static_cast<double>(first.units - 1) + b * b / static_cast<double>(second.units - 1));
  const double half = student_t_quantile(0.975, degrees) * std::sqrt(a + b);
  return Interval{difference - half, difference + half};
}

std::vector<double> paired_differences(std::span<const double> first, std::span<const double> second) {
  if (first.size() != second.size()) throw std::logic_error("pairs need equally many values");
  std::vector<double> differences(first.size());
  std::transform(first.begin(), first.end(), second.begin(), differences.begin(), std::minus<>());
  return differences;
}

std::vector<double> holm_adjusted(std::span<const double> p_values) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < p_values.size(); ++i) {
    if (!std::isnan(p_values[i])) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted(p_values.begin(), p_values.end());
  double last = 0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const double scaled = static_cast<double>(order.size() - rank) * p_values[order[rank]];
    last = std::min(1.0, std::max(last, scaled));
    adjusted[order[rank]] = last;
  }
  return adjusted;
}

Improvement probability_of_improvement(std::span<const double> first, std::span<const double> second,
                                       Better better) {
  if (first.empty() || second.empty()) return {std::numeric_limits<double>::quiet_NaN(), std::nullopt};
  std::vector<double> order(second.begin(), second.end());
  std::sort(order.begin(), order.end());
  double won = 0;  // pairs whose first value is the better one, equal ones half
  for (const double value : first) {
    const auto [low, high] = std::equal_range(order.begin(), order.end(), value);
    const auto below = (low - order.begin()) + (high - order.begin());
    const auto all = static_cast<std::ptrdiff_t>(2 * order.size());
    won += static_cast<double>(better == Better::higher ? below : all - below) / 2;
  }
  const double n = static_cast<double>(first.size()), m = static_cast<double>(second.size());
  Improvement result{won / (n * m), std::nullopt};
  if (n + m < 3) return result;
  const double z = normal_quantile(0.975), p = result.probability;
  result.ci95 = Interval{improvement_limit(p, 0, z, n, m), improvement_limit(p, 1, z, n, m)};
  return result;
}

}  // namespace coppice
