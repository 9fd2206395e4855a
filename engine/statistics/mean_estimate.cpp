#include "engine/statistics/mean_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/statistics/estimates.h"
#include "engine/statistics/student.h"

namespace coppice {
namespace {

/// A sixth of the skewness of the mean.
double skew_of(const MeanEstimate& estimate) {
  return estimate.third / (6 * estimate.variance * std::sqrt(estimate.variance));
}

/// Hall's monotone cubic: takes the skewness out of a studentized mean t; a is skew_of.
double symmetrized(double t, double a) {
  return a + t + 2 * a * t * t + 4.0 / 3 * a * a * t * t * t;
}

/// Its inverse, where y - 2 a y^2 + ... would lose digits.
double skewed(double y, double a) {
  if (std::fabs(a) < 1e-9) return y;
  return (std::cbrt(1 + 6 * a * (y - a)) - 1) / (2 * a);
}

}  // namespace

Moments moments(std::span<const double> values) {
  return {static_cast<double>(values.size()), mean(values), standard_deviation(values),
          sample_skewness(values)};
}

MeanEstimate mean_estimate(const Moments& values) {
  const auto& [n, mean, deviation, skewness] = values;
  if (!(n >= 2)) return {mean, 0, 0, 0};
  const double third = n < kUnitsForSkewness || std::isnan(skewness) ? 0 : skewness;
  return {mean, deviation * deviation / n, third * deviation * deviation * deviation / (n * n), n - 1};
}

MeanEstimate mean_estimate(std::span<const double> values) {
  return mean_estimate(moments(values));
}

MeanEstimate difference(const MeanEstimate& first, const MeanEstimate& second) {
  MeanEstimate result{first.mean - second.mean, first.variance + second.variance, first.third - second.third,
                      0};
  if (first.degrees == 0 || second.degrees == 0) return result;
  const double a = first.variance, b = second.variance;
  result.degrees = a + b > 0 ? (a + b) * (a + b) / (a * a / first.degrees + b * b / second.degrees)
                             : first.degrees + second.degrees;
  return result;
}

std::optional<Interval> confidence_interval(const MeanEstimate& estimate, double confidence) {
  if (!(estimate.degrees > 0) || !std::isfinite(estimate.variance)) return std::nullopt;
  if (!(estimate.variance > 0)) return Interval{estimate.mean, estimate.mean};
  const double t = student_t_quantile(0.5 + confidence / 2, estimate.degrees);
  const double a = skew_of(estimate), error = std::sqrt(estimate.variance);
  const Interval interval{estimate.mean - std::max(t, skewed(t, a)) * error,
                          estimate.mean - std::min(-t, skewed(-t, a)) * error};
  if (!std::isfinite(interval.low) || !std::isfinite(interval.high)) return std::nullopt;
  return interval;
}

double p_value(const MeanEstimate& estimate) {
  constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
  if (!(estimate.degrees > 0) || !std::isfinite(estimate.variance)) return kUndefined;
  if (!(estimate.variance > 0)) return estimate.mean == 0 ? kUndefined : 0;
  const double t = estimate.mean / std::sqrt(estimate.variance);
  return std::max(student_t_two_sided(t, estimate.degrees),
                  student_t_two_sided(symmetrized(t, skew_of(estimate)), estimate.degrees));
}

}  // namespace coppice
