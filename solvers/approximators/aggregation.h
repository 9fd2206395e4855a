#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace coppice {

/// What a forest makes of its trees' predictions.
enum class Aggregation {
  mean,         ///< their mean (thesis, Eq. 2.2)
  trimmed_mean  ///< the mean of those that are left without the lowest and the highest tenth
};

/// Predictions that a trimmed mean leaves out on each side: a tenth of them, rounded up as in the thesis's
/// code (3 of 25), but one or two always stay.
constexpr std::size_t trimmed_on_each_side(std::size_t trees) {
  return trees == 0 ? 0 : std::min((trees + 9) / 10, (trees - 1) / 2);
}

/// The trimmed mean of `values`, which it may put into another order; NaN when one of them is. It rises with
/// each of them, so trimmed means of bounds are bounds.
double trimmed_mean(std::span<double> values);

}  // namespace coppice
