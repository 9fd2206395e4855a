#include "engine/statistics/intervals.h"

#include <cmath>

#include "engine/statistics/estimates.h"
#include "engine/statistics/student.h"
#include "engine/vocabulary/elementary.h"

namespace coppice {

std::optional<Interval> t_interval(std::span<const double> values, double confidence) {
  if (values.size() < 2) return std::nullopt;
  const auto n = static_cast<double>(values.size());
  const double centre = mean(values);
  const double half =
      student_t_quantile(0.5 + confidence / 2, n - 1) * standard_deviation(values) / std::sqrt(n);
  return Interval{centre - half, centre + half};
}

Interval share_interval(double share, double n, double confidence) {
  const double z = normal_quantile(0.5 + confidence / 2);
  const double scale = 1 + z * z / n;
  const double center = (share + z * z / (2 * n)) / scale;
  const double half = z * std::sqrt(share * (1 - share) / n + z * z / (4 * n * n)) / scale;
  // At the ends they are 0 and 1; rounding must not move them.
  return {share <= 0 ? 0 : std::fmax(0, center - half), share >= 1 ? 1 : std::fmin(1, center + half)};
}

}  // namespace coppice
