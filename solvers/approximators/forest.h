#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/vocabulary/archive.h"
#include "engine/vocabulary/matrix.h"
#include "solvers/approximators/aggregation.h"
#include "solvers/approximators/forest_tops.h"
#include "solvers/approximators/tree.h"

namespace coppice {

/// The least single-precision number that is not below x. Thresholds are in single precision, so that
/// x <= threshold and rounded_up(x) <= threshold say the same: training and prediction compare in single
/// precision and still send every x where its double-precision value belongs. What training cannot see is
/// inputs that differ by less than 1 part in 2^23 of themselves.
inline float rounded_up(double x) {
  const auto nearest = static_cast<float>(x);
  const auto bits = std::bit_cast<std::int32_t>(nearest);
  const std::int32_t is_below = static_cast<double>(nearest) < x ? 1 : 0;
  const std::int32_t next = bits >= 0 ? 1 : -1;
  return std::bit_cast<float>(bits + is_below * next) + 0.0F;  // makes 0 of -0
}

/// One node of a packed tree, 8 bytes. A split sends x[feature] <= value to the node `ahead` places after it
/// and the rest to the one behind that; features are the inputs, then the forest's directions, by which
/// oblique splits go. A leaf has the feature after the last and 0 ahead: with a NaN there, a descent stays in
/// it without a test. Its value is its constant in units of its output's scale, or the number of its linear
/// model.
struct ForestNode {
  float value = 0;
  std::uint32_t link = 0;

  static constexpr std::uint32_t kMaxAhead = (1u << 24) - 1;
  static constexpr ForestNode split(std::uint32_t feature, float threshold, std::uint32_t ahead) {
    return {threshold, feature << 24 | ahead};
  }
  static constexpr ForestNode leaf(std::size_t features, float value) {
    return {value, static_cast<std::uint32_t>(features) << 24};
  }
  static constexpr ForestNode linear_leaf(std::size_t features, std::uint32_t row) {
    return {std::bit_cast<float>(kFirstRow + row), static_cast<std::uint32_t>(features) << 24};
  }
  constexpr std::uint32_t feature() const { return link >> 24; }
  constexpr std::uint32_t ahead() const { return link & kMaxAhead; }
  constexpr std::uint32_t row() const { return std::bit_cast<std::uint32_t>(value) - kFirstRow; }

  friend bool operator==(const ForestNode& a, const ForestNode& b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
  }

 private:
  static constexpr std::uint32_t kFirstRow = 0x00800000;  // below, slow denormal numbers; above 2^31, NaNs
};
static_assert(sizeof(ForestNode) == 8);

/// What the constants of one output's leaves mean: offset + scale * value. It keeps single precision relative
/// to how much the output varies.
struct OutputScale {
  double offset = 0;
  double scale = 1;
  float packed(double value) const { return static_cast<float>((value - offset) / scale) + 0.0F; }
  friend bool operator==(const OutputScale&, const OutputScale&) = default;
};

/// The least and the largest of some outputs, and the scale to pack them with: a power of 2, and an offset
/// only where they are far from 0 for their range, a number with few digits. So short numbers are packed
/// exactly.
struct ValueRange {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();

  void include(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  OutputScale scale() const;
};

struct RoundedPoint;

/// A tree as a forest holds it.
struct PackedTree {
  std::vector<ForestNode> nodes;
  std::vector<double> models;  ///< linear leaves: rows of model_width(inputs) numbers
};
/// Constants and thresholds that are not in single precision are rounded to it.
PackedTree pack(const Tree& tree);

/// A tree of a forest.
struct ForestTree {
  std::size_t inputs = 0;
  LeafModel leaf = LeafModel::constant;
  const ForestNode* nodes = nullptr;  ///< of the whole forest
  const double* models = nullptr;
  std::uint32_t root = 0;
  OutputScale scale;
  const Directions* directions = nullptr;

  bool is_leaf(std::uint32_t node) const { return nodes[node].ahead() == 0; }
  double constant(std::uint32_t node) const { return scale.offset + scale.scale * nodes[node].value; }
  const double* model(std::uint32_t node) const { return models + nodes[node].row() * model_width(inputs); }
};

/// Regression forests for one or several outputs, one after the other, each the mean of its trees (thesis,
/// Eq. 2.2) or their trimmed mean: all nodes in one array, children after their parents. The mean of linear
/// models is held in the mean of their ranges; a trimmed mean is one of models that are held in their own.
/// Trees share one table of directions, which a prediction computes once, so that an oblique split costs as
/// much as any other.
class Forest {
 public:
  Forest() = default;
  Forest(std::size_t inputs, std::vector<OutputScale> outputs, LeafModel leaf, Directions directions = {});

  /// Adds a tree of `leaf()` models; outputs in order, equally many trees each.
  void add(const PackedTree& tree);
  void reserve(std::size_t trees, std::size_t nodes, std::size_t models);

  std::size_t inputs() const { return inputs_; }
  std::size_t outputs() const { return scales_.size(); }
  LeafModel leaf() const { return leaf_; }
  Aggregation aggregation() const { return aggregation_; }
  void aggregate_by(Aggregation aggregation) { aggregation_ = aggregation; }
  const Directions& directions() const { return directions_; }
  /// What nodes can split by: inputs, then directions.
  std::size_t features() const { return inputs_ + directions_.size(); }
  /// Trees of one output.
  std::size_t trees() const { return scales_.empty() ? 0 : roots_.size() / scales_.size(); }
  ForestTree tree(std::size_t output, std::size_t index) const;
  std::size_t leaves() const { return (nodes_.size() + roots_.size()) / 2; }

  /// The values of all outputs at x. Does not allocate; for trimmed means, a thread's first call may.
  void predict(std::span<const double> x, std::span<double> y) const;
  /// The same for rows of x, to rows of y; faster. Allocates as little.
  void predict_batch(const Matrix& x, Matrix& y) const;

  /// Throws std::runtime_error for numbers that are not finite, which outputs near the largest can lead to.
  void save(Archive& archive) const;
  /// Throws std::runtime_error for anything but disjoint trees of finite numbers.
  static Forest load(const Archive& archive);

  friend bool operator==(const Forest&, const Forest&) = default;

 private:
  void load_directions(const Archive& archive);
  static Forest load_first_format(const Archive& archive, std::size_t inputs, std::size_t outputs,
                                  LeafModel leaf);
  double linear_value(ForestNode leaf, const double* x) const;
  void predict_alone(std::span<const double> x, std::span<double> y) const;  // a tree an output
  double mean(std::size_t output, const double* x, const RoundedPoint& point) const;
  double trimmed(std::size_t output, const double* x, const RoundedPoint& point) const;
  template <class Visit>
  void for_each_leaf(std::size_t output, const RoundedPoint& point, const Visit& visit) const;
  void check() const;
  void make_tops();
  void check_numbers() const;

  std::size_t inputs_ = 0;
  LeafModel leaf_ = LeafModel::constant;
  Aggregation aggregation_ = Aggregation::mean;
  std::vector<OutputScale> scales_;
  Directions directions_;
  std::vector<ForestNode> nodes_;
  std::vector<double> models_;
  std::vector<std::uint32_t> roots_;
  std::vector<TreeTop> tops_;  // of the trees in their order
};

}  // namespace coppice
