#pragma once

#include <span>

#include "engine/vocabulary/approximator.h"
#include "solvers/approximators/forest.h"

namespace coppice {

/// The largest value of output 0 over `box` for the last inputs, the first ones fixed to `prefix`. `merge`:
/// of the tree that the projected forest is merged into (thesis, Algorithm 14). `exact`: of the forest
/// itself, along one axis from break to break, else by branch and bound. Uses memory that the calling thread
/// keeps from call to call.
Maximum maximize(const Forest& forest, std::span<const double> prefix, const Space& box,
                 const Maximization& how);

}  // namespace coppice
