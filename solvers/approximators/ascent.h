#pragma once

#include <span>
#include <vector>

#include "engine/vocabulary/approximator.h"
#include "solvers/approximators/forest.h"
#include "solvers/approximators/line_maximum.h"

namespace coppice {

/// A local maximum of a forest's mean (of output 0) over a box of its last inputs, the best of several:
/// coordinate ascent, each step of which is the exact maximum along an axis. It begins at the best of points
/// that are spread evenly over the box, so equal calls give equal results. Along a single axis it is exact.
class Ascent {
 public:
  /// The first inputs are fixed to `prefix`; `box` is of the others, one at least. Along axes without an end
  /// all begin near 0.
  Maximum over(const Forest& forest, std::span<const double> prefix, const Space& box);

 private:
  struct Start {
    double value = 0;
    std::size_t number = 0;
  };
  void spread(std::size_t n);
  void place(std::size_t number, const Space& box);
  void choose_starts(const Forest& forest, const Space& box);
  double climb(const Forest& forest, const Space& box);

  std::size_t first_ = 0;      // of the inputs that are free
  std::vector<double> steps_;  // from one point to the next, as parts of the box
  std::vector<double> x_;      // all inputs
  std::vector<double> values_;
  std::vector<Start> starts_;
  LineMaximum line_;
};

}  // namespace coppice
