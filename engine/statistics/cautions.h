#pragma once

#include <string>
#include <string_view>

#include "engine/statistics/mean_estimate.h"

namespace coppice {

/// Why an interval of a mean over `units` values may cover less than it says, or is missing; "" when nothing
/// speaks against it. `unit` names them ("training runs", "episodes"). The limits are explained in
/// docs/statistics.md.
std::string caution(double units, double skewness, std::string_view unit);
/// The same, also of values that are all equal, or so large that mean or interval are beyond the range of
/// doubles.
std::string caution(const Moments& units, std::string_view unit);

}  // namespace coppice
