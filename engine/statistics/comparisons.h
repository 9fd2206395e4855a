#pragma once

#include <cstdint>
#include <optional>

#include "engine/statistics/intervals.h"

namespace coppice {

/// A mean as a table has it.
struct Summary {
  double mean = 0;
  std::optional<Interval> ci95;  ///< Student's, over `units`
  std::int64_t units = 0;
};

/// The 95 % interval of the second mean minus the first, of independent samples with different variances
/// (Welch 1947, Satterthwaite's degrees of freedom); nothing unless both have an interval. Samples that
/// share their random numbers are positively correlated: for them it is too wide, never too narrow.
std::optional<Interval> welch_interval(const Summary& first, const Summary& second);

}  // namespace coppice
