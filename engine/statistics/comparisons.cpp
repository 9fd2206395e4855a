#include "engine/statistics/comparisons.h"

#include <cmath>

namespace coppice {
namespace {

/// The squared standard error that made Student's interval.
double variance_of_mean(const Summary& summary) {
  const double half = (summary.ci95->high - summary.ci95->low) / 2;
  const double error = half / student_t_quantile(0.975, static_cast<double>(summary.units - 1));
  return error * error;
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

}  // namespace coppice
