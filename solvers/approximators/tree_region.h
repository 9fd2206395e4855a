#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "solvers/approximators/tree_operations.h"

namespace coppice {

/// The part of a box that a descent through splits has reached: low < x <= high on each axis. (Low sides are
/// open because a split's upper side is; a box that contains its low side starts just below it.)
class Region {
 public:
  explicit Region(const Box& box) { reset(box); }
  Region() = default;

  void reset(const Box& box) {
    low_.resize(box.low.size());
    for (std::size_t i = 0; i < low_.size(); ++i) {
      low_[i] = std::nextafter(box.low[i], -std::numeric_limits<double>::infinity());
    }
    high_ = box.high;
  }

  double low(std::size_t axis) const { return low_[axis]; }
  double high(std::size_t axis) const { return high_[axis]; }
  /// The least number on the axis that is in the region (the box's low side, or just above a split).
  double least(std::size_t axis, const Box& box) const {
    return std::max(box.low[axis], std::nextafter(low_[axis], std::numeric_limits<double>::infinity()));
  }
  std::size_t size() const { return low_.size(); }
  /// Whether any point of the region is on that side of the split.
  bool reaches_low(std::size_t axis, double threshold) const { return low_[axis] < threshold; }
  bool reaches_high(std::size_t axis, double threshold) const { return high_[axis] > threshold; }

  /// Calls `visit` with the region restricted to x[axis] <= threshold (LOWERSPACE).
  template <class Visit>
  void in_low(std::size_t axis, double threshold, Visit visit) {
    const double kept = high_[axis];
    if (threshold < kept) high_[axis] = threshold;
    visit();
    high_[axis] = kept;
  }
  /// Calls `visit` with the region restricted to x[axis] > threshold (UPPERSPACE).
  template <class Visit>
  void in_high(std::size_t axis, double threshold, Visit visit) {
    const double kept = low_[axis];
    if (threshold > kept) low_[axis] = threshold;
    visit();
    low_[axis] = kept;
  }

 private:
  std::vector<double> low_;
  std::vector<double> high_;
};

/// Where in the region a linear model is largest along an axis: at one end, which belongs to the region, or
/// anywhere, then at the centre.
inline double best_place(const Region& region, const Box& box, std::size_t axis, double slope) {
  if (slope > 0) return region.high(axis);
  const double least = region.least(axis, box);
  if (slope < 0) return least;
  const double low = std::max(region.low(axis), box.low[axis]);
  return std::max(least, low + 0.5 * (region.high(axis) - low));
}

}  // namespace coppice
