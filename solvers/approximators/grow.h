#pragma once

#include <cstddef>
#include <span>

#include "engine/vocabulary/approximator.h"
#include "solvers/approximators/forest.h"

namespace coppice {

/// How a tree is grown (thesis, Algorithm 6).
struct Growth {
  LeafModel leaf = LeafModel::constant;
  std::size_t candidates = 1;   ///< k: input dimensions tried at each node
  std::size_t min_samples = 1;  ///< n_min: samples in each leaf at least
  double min_variance = 0;      ///< v_min: nodes with no more variance of the output become leaves
  double leaf_margin = 0;       ///< a linear leaf may leave its outputs' range by this part of it
};

/// Grows one tree for column `output` of the set (thesis, Algorithms 4 to 6). Samples of weight 0 do not
/// exist; the weights are not negative and not all 0.
Tree grow_tree(const TrainingSet& set, std::size_t output, const Growth& growth, Stream stream);

}  // namespace coppice
