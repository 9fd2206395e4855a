#pragma once

#include <cstddef>

#include "engine/vocabulary/approximator.h"
#include "solvers/approximators/forest.h"
#include "solvers/approximators/tree_kernels.h"

namespace coppice {

/// How a tree is grown (thesis, Algorithm 6).
struct Growth {
  /// What becomes of a threshold that leaves fewer than n_min samples on a side.
  enum class Short {
    redraw,  ///< the thesis's rule: thresholds are uniform among those that leave enough
    reject   ///< scikit-learn's: thresholds are uniform between the ends; one that leaves too few is no
             ///< candidate
  };
  LeafModel leaf = LeafModel::constant;
  std::size_t candidates = 1;   ///< k: inputs and directions tried at each node
  std::size_t directions = 0;   ///< random directions that all trees may split by, besides the inputs
  std::size_t min_samples = 1;  ///< n_min: samples in each leaf at least
  Short too_few = Short::redraw;
  double min_variance = 0;  ///< v_min: nodes with no more variance of the output become leaves
  double leaf_margin = 0;   ///< a linear leaf may leave its outputs' range by this part of it
};

/// Grows forests of `trees` trees for each output of the set (thesis, Algorithms 4 to 7). Samples of weight 0
/// do not exist; the weights are not negative and not all 0. Inputs are rounded up to single precision
/// (rounded_up), outputs rounded to it relative to their spread. Uses, besides the forest, memory for a copy
/// of the set in single precision for each thread.
Forest grow_forest(const TrainingSet& set, const Growth& growth, std::size_t trees, const Draws& draws,
                   Parallel& parallel, const TreeKernels& kernels = tree_kernels());

}  // namespace coppice
