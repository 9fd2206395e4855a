#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

namespace coppice {

// What a policy computes, as plain numbers: what an export carries out of the program. Whoever follows the
// comments below in IEEE 754 double precision, each operation rounded by itself and sums from the first term
// to the last, gets the policy's actions bit for bit.

/// The same values everywhere.
struct ConstantModel {
  std::vector<double> values;
};

/// y[o] = bias[o] + slopes[o][0] x[0] + ..., summed from the left; with `bias_last`, 0 + slopes[o][0] x[0] +
/// ... first and then the bias.
struct LinearModel {
  std::vector<double> slopes;  ///< outputs x inputs, row after row
  std::vector<double> bias;    ///< one for each output
  bool bias_last = false;
};

/// Trees, equally many for each output, over the inputs and, behind them, the directions: weighted sums of
/// the inputs, each its offset + weights[0] x[0] + ..., summed from the left. x[i] below is feature i, of
/// inputs and directions.
struct ForestModel {
  /// A split leads to the node after `child` of its tree where x[index] > `value`, else (also for NaN) to
  /// `child`. Without a child it is a leaf: of `value`, or with the linear model number `index` of its tree.
  struct Node {
    float value = 0;
    std::uint32_t index = 0;
    std::uint32_t child = 0;
    bool is_leaf() const { return child == 0; }
  };
  struct Tree {
    std::vector<Node> nodes;     ///< the root first, children after their parents
    std::vector<double> models;  ///< rows of inputs + 3 numbers: bias, slopes, lowest and highest value
    std::size_t leaves() const { return (nodes.size() + 1) / 2; }
  };
  /// Constant leaves: offset + scale * m, where m is the mean of the leaves that x falls into. Linear leaves:
  /// m, the sum of their values (bias + slopes x, summed from the left), held between the sums of their
  /// lowest and of their highest values, divided by the number of trees.
  struct Output {
    double offset = 0;
    double scale = 1;
    std::vector<Tree> trees;
  };

  std::size_t inputs = 0;
  std::vector<double> directions;  ///< rows of inputs + 1 numbers: offset, weights
  bool linear_leaves = false;
  /// Given, and not 0: m is the mean of the trees' values, each linear one held in its own range, without the
  /// n lowest and the n highest. With the n-th lowest of them, a, and the n-th highest, b: a where they are
  /// equal; else (s + p a + q b) / (trees - 2 n), where s sums the values between a and b (0 for the others),
  /// p is the number of those that are not above a, and q of those that are not below b, each less n. The sum
  /// is in the trees' order, with n > 6 from the lowest value. NaN when the sum of all values is. 0: m is the
  /// values' mean.
  std::optional<std::size_t> trimmed;
  std::vector<Output> outputs;

  std::size_t width() const { return inputs + 3; }  ///< of a row of models
  std::size_t direction_count() const { return directions.size() / (inputs + 1); }
  std::size_t features() const { return inputs + direction_count(); }
  std::size_t trees() const { return outputs.front().trees.size(); }
};

using FunctionModel = std::variant<ConstantModel, LinearModel, ForestModel>;

/// Always the action of this id. Its parameters are the function's outputs at the state, moved into their box
/// (clamp_in_place in space.h).
struct PolicyModel {
  int action = 0;
  FunctionModel function;
};

}  // namespace coppice
