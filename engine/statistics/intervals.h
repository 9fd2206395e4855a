#pragma once

#include <optional>
#include <span>

namespace coppice {

/// A confidence interval.
struct Interval {
  double low = 0;
  double high = 0;
};

/// The p-quantile of Student's t distribution; p in (0, 1), degrees of freedom at least 1 (need not be
/// whole). Relative error below 1e-12 for up to 10^5 degrees, 1e-10 for up to 10^7.
double student_t_quantile(double p, double degrees);

/// Student's interval of the mean; nothing for fewer than two values. Exact for normal values, and good for
/// others from some dozens on, fewer when they are not skewed.
std::optional<Interval> t_interval(std::span<const double> values, double confidence = 0.95);

}  // namespace coppice
