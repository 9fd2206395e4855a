#pragma once

#include <functional>
#include <span>
#include <vector>

namespace coppice {

/// A function to climb: its value at x; fills the gradient.
using Hill = std::function<double(std::span<const double> x, std::span<double> gradient)>;

/// Climbs from `at` inside the box of `low` and `high` by NLopt's limited-memory BFGS (Nocedal 1980; Liu and
/// Nocedal 1989), at most `evaluations` times evaluated. `at` becomes the best place seen, whose value is
/// returned. Values that are not finite end the climb.
double climb(const Hill& hill, std::span<const double> low, std::span<const double> high,
             std::vector<double>& at, int evaluations);

}  // namespace coppice
