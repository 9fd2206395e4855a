#pragma once

#include <vector>

#include "solvers/approximators/tree_operations.h"
#include "solvers/approximators/tree_region.h"

namespace coppice {

// What the operations that build trees have in common.

// Makes `tree` a single root, to be filled.
inline void begin_tree(Tree& tree, std::size_t inputs, LeafModel leaf) {
  tree.inputs = inputs;
  tree.leaf = leaf;
  tree.nodes.assign(1, {});
  tree.models.clear();
  tree.directions.clear(inputs);
}

// Makes node `at` a split and returns its low child; the high one follows it.
inline std::int32_t add_split(Tree& tree, std::int32_t at, std::int32_t feature, double threshold) {
  const auto child = static_cast<std::int32_t>(tree.nodes.size());
  tree.nodes.resize(tree.nodes.size() + 2);
  tree.nodes[at] = {threshold, feature, child};
  return child;
}

// Makes node `at` a leaf; for a linear one the caller fills the row that is returned.
inline double* add_leaf(Tree& tree, std::int32_t at, double constant) {
  tree.nodes[at] = {constant, static_cast<std::int32_t>(tree.features()), at};
  if (tree.leaf == LeafModel::constant) return nullptr;
  const std::size_t width = model_width(tree.inputs);
  const std::size_t first = tree.models.size(), number = first / width;
  tree.nodes[at].value = static_cast<double>(number);
  tree.models.resize(first + width);
  return tree.models.data() + first;
}

// Regions of operations that do not run at the same time in one thread.
inline Region& scratch_region() {
  thread_local Region region;
  return region;
}

}  // namespace coppice
