#pragma once

#include <span>
#include <vector>

#include "engine/vocabulary/space.h"

namespace coppice {

/// The map of CMA-ES's coordinates, any numbers, onto a box. A side of finite width w is of width 1 there;
/// what lies outside is mirrored at the limits, so that the map is linear inside and nothing is distorted
/// when the optimum lies there. Sides without limits are left as they are; those with one limit are mirrored
/// at it.
class BoxMap {
 public:
  explicit BoxMap(const Space& box) : box_(box) {}

  std::size_t dimension() const { return box_.size(); }
  /// Coordinates of a point of the box.
  std::vector<double> inside_out(std::span<const double> point) const;
  /// The point of the box for any coordinates; never outside, whatever rounding does.
  /// Whether nothing is mirrored.
  bool contains(std::span<const double> coordinates) const;
  void into(std::span<const double> coordinates, std::span<double> point) const;
  /// `guess` moved into the box; where there is none, the centre, or the finite limit, or 0.
  std::vector<double> start(std::span<const double> guess) const;

 private:
  Space box_;
};

}  // namespace coppice
