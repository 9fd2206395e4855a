#pragma once

#include <string>
#include <string_view>

namespace coppice {

/// Why an interval of a mean over `units` values may cover less than it says, or is missing; "" when nothing
/// speaks against it. `unit` names them ("training runs", "episodes"). The limits are explained in
/// docs/statistics.md.
std::string caution(double units, double skewness, std::string_view unit);

}  // namespace coppice
