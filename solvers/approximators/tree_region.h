#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "solvers/approximators/tree_operations.h"

namespace coppice {

/// The part of a box that a descent through splits has reached: low < x <= high on each axis, and on each
/// direction of oblique splits, which are axes number `box.low.size()` and on. (Low sides are open because a
/// split's upper side is; a box that contains its low side starts just below it.)
class Region {
 public:
  void reset(const Box& box, const Directions& directions) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    directions_ = &directions;
    axes_ = box.low.size();
    low_.assign(axes_ + directions.size(), -kInfinity);
    high_.assign(axes_ + directions.size(), kInfinity);
    for (std::size_t i = 0; i < axes_; ++i) {
      low_[i] = std::nextafter(box.low[i], -kInfinity);
      high_[i] = box.high[i];
    }
  }

  double low(std::size_t axis) const { return low_[axis]; }
  double high(std::size_t axis) const { return high_[axis]; }
  /// The least number on the axis that is in the region (the box's low side, or just above a split).
  double least(std::size_t axis, const Box& box) const {
    return std::max(box.low[axis], std::nextafter(low_[axis], std::numeric_limits<double>::infinity()));
  }
  /// Whether any point of the region is on that side of the split. Of an oblique one false is certain; true
  /// says that none of the axes' and of the split's own direction's bounds excludes it.
  bool reaches_low(std::size_t axis, double threshold) const {
    return low_[axis] < threshold && (axis < axes_ || most_of(axis, -1) <= threshold);
  }
  bool reaches_high(std::size_t axis, double threshold) const {
    return high_[axis] > threshold && (axis < axes_ || most_of(axis, 1) > threshold);
  }

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
  // The largest (sign 1) or least (-1) number of a direction in the corners of the axes' bounds. Rounding
  // keeps the order of sums, so no point between them is beyond.
  double most_of(std::size_t axis, double sign) const {
    const std::span<const double> weights = directions_->weights(axis - axes_);
    double sum = directions_->offset(axis - axes_);
    for (std::size_t i = 0; i < axes_; ++i) {
      if (weights[i] != 0) sum += weights[i] * (weights[i] * sign > 0 ? high_[i] : low_[i]);
    }
    return sum;
  }

  const Directions* directions_ = nullptr;
  std::size_t axes_ = 0;
  std::vector<double> low_;
  std::vector<double> high_;
};

/// The part of a region's volume that is on the low side of a split along an axis on which it is low < x <=
/// high. Where the box has no width all is on one side; where rounding leaves the region none, halves.
inline double low_share(double low, double high, const Box& box, std::size_t axis, double threshold) {
  if (axis >= box.low.size()) return 0.5;  // oblique: not known, and not asked for
  if (box.high[axis] == box.low[axis]) return threshold < box.low[axis] ? 0.0 : 1.0;
  const double begin = std::max(low, box.low[axis]);
  const double width = high - begin;
  return width > 0 ? std::clamp((threshold - begin) / width, 0.0, 1.0) : 0.5;
}

/// Between two ends; near 0 where they are infinitely far from each other.
inline double centre(double low, double high) {
  return std::isfinite(high - low) ? low + 0.5 * (high - low) : std::clamp(0.0, low, high);
}

/// Where in the region a linear model is largest along an axis: at one end, which belongs to the region, or
/// anywhere, then at the centre.
inline double best_place(const Region& region, const Box& box, std::size_t axis, double slope) {
  if (slope > 0) return region.high(axis);
  const double least = region.least(axis, box);
  if (slope < 0) return least;
  const double low = std::max(region.low(axis), box.low[axis]);
  return std::max(least, centre(low, region.high(axis)));
}

}  // namespace coppice
