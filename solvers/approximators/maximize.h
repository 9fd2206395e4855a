#pragma once

#include <span>

#include "engine/vocabulary/approximator.h"
#include "solvers/approximators/forest.h"

namespace coppice {

/// The largest value of output 0 over `box` for the last inputs, the first ones fixed to `prefix`. `merge`:
/// of the tree that the projected forest is merged into (thesis, Algorithm 14). `exact`: of the forest
/// itself, along one axis from break to break, else by branch and bound. `ascent`: see ascent.h. Uses memory
/// that the calling thread keeps from call to call.
///
/// Throws what check_maximization throws.
Maximum maximize(const Forest& forest, std::span<const double> prefix, const Space& box,
                 const Maximization& how);

/// What decides how a forest can be maximized.
struct ForestKind {
  LeafModel leaf = LeafModel::constant;
  Aggregation aggregation = Aggregation::mean;
  bool is_oblique = false;
};
/// Throws std::invalid_argument when forests of this kind have no such maximum over that many inputs.
void check_maximization(const ForestKind& forest, std::size_t free_inputs, const Maximization& how);

}  // namespace coppice
