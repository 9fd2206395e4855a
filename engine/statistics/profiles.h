#pragma once

#include <span>
#include <vector>

#include "engine/statistics/estimates.h"

namespace coppice {

/// One point of a performance profile.
struct ProfilePoint {
  double threshold = 0;
  double share = 0;  ///< of the units that are better than the threshold
  Interval ci95;     ///< of that share, for this threshold alone
};

/// The performance profile of units (Agarwal et al., NeurIPS 2021: run-score distribution), at increasing
/// thresholds. Throws std::logic_error without units.
std::vector<ProfilePoint> performance_profile(std::span<const double> units,
                                              std::span<const double> thresholds, Better better);

/// By how much units miss a target, those that reach it counting 0 (Agarwal et al. 2021); in the values'
/// unit. NaN without units, and where a unit is NaN.
double optimality_gap(std::span<const double> units, double target, Better better);

}  // namespace coppice
