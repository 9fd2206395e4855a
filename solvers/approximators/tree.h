#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "solvers/approximators/directions.h"

namespace coppice {

/// More inputs and directions than this are refused; a prediction copies them to the stack.
inline constexpr std::size_t kMaxTreeInputs = 255;
/// Deeper trees are neither grown nor read: the operations on trees are recursive.
inline constexpr int kMaxTreeDepth = 1000;

/// What leaves hold: a constant, C(y), or a linear model, L(A, B) (thesis, 2.1.2).
enum class LeafModel { constant, linear };

/// A linear leaf model is a row of numbers: bias B, the slopes A (one for each input), and the range [low,
/// high] that its predictions are held in. Projection and averaging act on all of them; the range is applied
/// once, to the mean of a forest's models by the mean of their ranges. So both operations stay exact although
/// predictions are bounded.
constexpr std::size_t model_width(std::size_t inputs) {
  return inputs + 3;
}

/// One node of a tree that is worked on. A split sends x[feature] <= value to node `child` and the rest to
/// `child + 1`; features from `inputs` on are the tree's directions. A leaf has the feature after the last
/// and itself as child; its value is its constant, or the row of its linear model.
struct TreeNode {
  double value = 0;
  std::int32_t feature = 0;
  std::int32_t child = 0;
  friend bool operator==(const TreeNode&, const TreeNode&) = default;
};

/// A single tree, in double precision, for the operations of tree_operations.h; its root is node 0, children
/// follow their parents.
struct Tree {
  std::size_t inputs = 0;
  LeafModel leaf = LeafModel::constant;
  std::vector<TreeNode> nodes;
  std::vector<double> models;  ///< linear leaves: rows of model_width(inputs) numbers
  Directions directions;       ///< of its oblique splits

  std::size_t features() const { return inputs + directions.size(); }
  bool is_leaf(std::int32_t node) const { return nodes[node].child == node; }
  const double* model(std::int32_t node) const {
    return models.data() + static_cast<std::size_t>(nodes[node].value) * model_width(inputs);
  }
};

}  // namespace coppice
