#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/vocabulary/archive.h"

namespace coppice {

/// More inputs than this are refused; a prediction copies its input to the stack.
inline constexpr std::size_t kMaxTreeInputs = 255;
/// Deeper trees are neither grown nor read: the operations on trees are recursive.
inline constexpr int kMaxTreeDepth = 1000;

/// One node of a tree in a flat array. A split sends x[feature] <= value to node `child` and the rest to
/// `child + 1`. A leaf has feature == inputs and itself as child: with a NaN after the last input, a descent
/// stays in it without a test. Its value is its constant, or the row of its linear model.
struct TreeNode {
  double value = 0;
  std::int32_t feature = 0;
  std::int32_t child = 0;
  friend bool operator==(const TreeNode&, const TreeNode&) = default;
};

/// What leaves hold: a constant, C(y), or a linear model, L(A, B) (thesis, 2.1.2).
enum class LeafModel { constant, linear };

/// A linear leaf model is a row of numbers: bias B, the slopes A (one for each input), and the range [low,
/// high] that its predictions are held in. Projection and averaging act on all of them; the range is applied
/// once, to the mean of a forest's models by the mean of their ranges. So both operations stay exact although
/// predictions are bounded.
constexpr std::size_t model_width(std::size_t inputs) {
  return inputs + 3;
}

/// A single tree; its root is node 0.
struct Tree {
  std::size_t inputs = 0;
  LeafModel leaf = LeafModel::constant;
  std::vector<TreeNode> nodes;
  std::vector<double> models;  ///< linear leaves: rows of model_width(inputs) numbers
};

/// A tree that somebody else holds.
struct TreeView {
  std::size_t inputs = 0;
  LeafModel leaf = LeafModel::constant;
  const TreeNode* nodes = nullptr;
  const double* models = nullptr;
  std::int32_t root = 0;

  TreeView() = default;
  TreeView(const Tree& tree)
      : inputs(tree.inputs), leaf(tree.leaf), nodes(tree.nodes.data()), models(tree.models.data()) {}

  bool is_leaf(std::int32_t node) const { return nodes[node].child == node; }
  const double* model(std::int32_t node) const {
    return models + static_cast<std::size_t>(nodes[node].value) * model_width(inputs);
  }
};

/// Regression forests for one or several outputs, one after the other, each the mean of its trees (thesis,
/// Eq. 2.2): all nodes in one array, children after their parents.
class Forest {
 public:
  Forest() = default;
  Forest(std::size_t inputs, std::size_t outputs, LeafModel leaf);

  /// Adds a tree for `output`; outputs in order, equally many trees each.
  void add(const Tree& tree);

  std::size_t inputs() const { return inputs_; }
  std::size_t outputs() const { return outputs_; }
  LeafModel leaf() const { return leaf_; }
  /// Trees of one output.
  std::size_t trees() const { return outputs_ == 0 ? 0 : roots_.size() / outputs_; }
  TreeView tree(std::size_t output, std::size_t index) const;
  std::size_t leaves() const;

  /// The values of all outputs at x. Does not allocate.
  void predict(std::span<const double> x, std::span<double> y) const;

  void save(Archive& archive) const;
  /// Throws std::runtime_error for anything but disjoint trees of finite numbers.
  static Forest load(const Archive& archive);

  friend bool operator==(const Forest&, const Forest&) = default;

 private:
  double constant_mean(const double* x, const std::int32_t* roots) const;
  double linear_mean(const double* x, const std::int32_t* roots) const;
  void check() const;

  std::size_t inputs_ = 0;
  std::size_t outputs_ = 0;
  LeafModel leaf_ = LeafModel::constant;
  std::vector<TreeNode> nodes_;
  std::vector<double> models_;
  std::vector<std::int32_t> roots_;
};

}  // namespace coppice
