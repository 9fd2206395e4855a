#pragma once

#include <functional>
#include <optional>
#include <span>

#include "engine/statistics/intervals.h"

namespace coppice {

/// A statistic of independent units with its standard error.
struct Studentized {
  double value = 0;
  double error = 0;
  double degrees = 0;  ///< of freedom of the error
};
using Statistic = std::function<Studentized(std::span<const double> units)>;

/// Mean, error sd / sqrt(n).
Studentized studentized_mean(std::span<const double> units);
/// Interquartile mean of at least one unit, with the error of a trimmed mean: that of the winsorized values,
/// with a degree of freedom less than values are kept (Tukey and McLaughlin, Sankhya A 25, 1963).
Studentized studentized_iqm(std::span<const double> units);

/// Student's interval of the interquartile mean with that error. Nothing for fewer than five units, of which
/// too few would be kept, nor when all that are kept are equal and others are not.
std::optional<Interval> iqm_interval(std::span<const double> units, double confidence = 0.95);

}  // namespace coppice
