#pragma once

#include <algorithm>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "engine/vocabulary/random.h"
#include "solvers/approximators/tree_operations.h"

namespace coppice::testing {

// Random trees, and slow and simple ways to say what they are worth. All numbers are small multiples of 1/8:
// sums and products of a few of them are exact, and thresholds, points and sides of boxes often coincide.

inline double eighth(Stream& stream, int low, int high) {
  return (low * 8 + static_cast<int>(stream.below(static_cast<std::uint64_t>(high - low) * 8 + 1))) / 8.0;
}

struct TreeShape {
  std::size_t inputs = 2;
  LeafModel leaf = LeafModel::constant;
  int depth = 4;  ///< at most
  const Directions* directions = nullptr;

  std::size_t features() const { return inputs + (directions == nullptr ? 0 : directions->size()); }
};

/// Weights and offsets in [-1, 1]; some weights are 0.
inline Directions random_directions(Stream& stream, std::size_t inputs, std::size_t size) {
  Directions directions(inputs);
  for (std::size_t j = 0; j < size; ++j) {
    double* row = directions.add();
    for (std::size_t i = 0; i <= inputs; ++i) row[i] = stream.below(4) == 0 ? 0 : eighth(stream, -1, 1);
  }
  return directions;
}

inline void grow_at_random(Stream& stream, const TreeShape& shape, Tree& tree, std::int32_t at, int depth) {
  if (depth == 0 || stream.below(4) == 0) {
    tree.nodes[at] = {eighth(stream, -2, 2), static_cast<std::int32_t>(shape.features()), at};
    if (shape.leaf == LeafModel::constant) return;
    tree.nodes[at].value = static_cast<double>(tree.models.size() / model_width(shape.inputs));
    for (std::size_t i = 0; i <= shape.inputs; ++i) tree.models.push_back(eighth(stream, -2, 2));
    const double low = eighth(stream, -4, 1);
    tree.models.push_back(low);
    tree.models.push_back(low + eighth(stream, 0, 6));
    return;
  }
  const auto child = static_cast<std::int32_t>(tree.nodes.size());
  tree.nodes.resize(tree.nodes.size() + 2);
  tree.nodes[at] = {eighth(stream, -1, 1), static_cast<std::int32_t>(stream.below(shape.features())), child};
  grow_at_random(stream, shape, tree, child, depth - 1);
  grow_at_random(stream, shape, tree, child + 1, depth - 1);
}

/// Splits in [-1, 1], some of which are never reached; leaves' ranges cut some of their models.
inline Tree random_tree(Stream& stream, const TreeShape& shape) {
  Tree tree;
  tree.inputs = shape.inputs;
  tree.leaf = shape.leaf;
  tree.nodes.resize(1);
  if (shape.directions != nullptr) tree.directions = *shape.directions;
  grow_at_random(stream, shape, tree, 0, shape.depth);
  return tree;
}

/// Sides in [-1, 1]; some have no width, some reach just to a threshold.
inline Box random_box(Stream& stream, std::size_t inputs) {
  Box box;
  for (std::size_t i = 0; i < inputs; ++i) {
    const double a = eighth(stream, -1, 1);
    const double b = stream.below(6) == 0 ? a : eighth(stream, -1, 1);
    box.low.push_back(std::min(a, b));
    box.high.push_back(std::max(a, b));
  }
  return box;
}

/// A point of the box: on its sides and on thresholds as well as between them.
inline std::vector<double> random_point(Stream& stream, const Box& box) {
  std::vector<double> x;
  for (std::size_t i = 0; i < box.low.size(); ++i) {
    const auto steps = static_cast<std::uint64_t>((box.high[i] - box.low[i]) * 16);
    x.push_back(box.low[i] + static_cast<double>(stream.below(steps + 1)) / 16);
  }
  return x;
}

/// Node of the leaf at x: x <= threshold goes low.
inline std::int32_t leaf_at(const Tree& tree, std::span<const double> x) {
  std::int32_t node = 0;
  while (tree.nodes[node].child != node) {
    const TreeNode& split = tree.nodes[node];
    const auto feature = static_cast<std::size_t>(split.feature);
    const double at =
        feature < tree.inputs ? x[feature] : tree.directions.value(feature - tree.inputs, x.data());
    node = at <= split.value ? split.child : split.child + 1;
  }
  return node;
}

/// What a tree says at a point: its model's value, and the range that the value is held in (for a constant
/// both are the constant).
struct Prediction {
  double model = 0, low = 0, high = 0;
  double value() const { return std::clamp(model, low, high); }
  friend bool operator==(const Prediction&, const Prediction&) = default;
};

inline Prediction value_of_leaf(const Tree& tree, std::int32_t leaf, std::span<const double> x) {
  const double constant = tree.nodes[leaf].value;
  if (tree.leaf == LeafModel::constant) return {constant, constant, constant};
  const double* model = tree.models.data() + static_cast<std::size_t>(constant) * (tree.inputs + 3);
  double value = model[0];
  for (std::size_t i = 0; i < tree.inputs; ++i) value += model[1 + i] * x[i];
  return {value, model[tree.inputs + 1], model[tree.inputs + 2]};
}

inline Prediction predict(const Tree& tree, std::span<const double> x) {
  return value_of_leaf(tree, leaf_at(tree, x), x);
}

inline std::vector<std::int32_t> leaves_of(const Tree& tree, std::int32_t node = 0) {
  if (tree.nodes[node].child == node) return {node};
  std::vector<std::int32_t> leaves = leaves_of(tree, tree.nodes[node].child);
  const std::vector<std::int32_t> high = leaves_of(tree, tree.nodes[node].child + 1);
  leaves.insert(leaves.end(), high.begin(), high.end());
  return leaves;
}

/// A forest of one output, without rounding for the trees above.
inline Forest forest_of(const std::vector<Tree>& trees) {
  Forest forest(trees[0].inputs, {OutputScale{}}, trees[0].leaf, trees[0].directions);
  for (const Tree& tree : trees) forest.add(pack(tree));
  return forest;
}

/// A forest's tree in double precision.
inline Tree unpacked(const ForestTree& tree) {
  Tree out;
  project(tree, {}, Box::everything(tree.inputs), out);
  return out;
}

/// A cell of a box: no threshold lies inside. Its high corner belongs to it, its low one only where the box
/// begins.
struct Cell {
  std::vector<double> low, high;
};

/// All cells that the thresholds of `trees` cut the box into.
inline std::vector<Cell> cells_of(const std::vector<const Tree*>& trees, const Box& box) {
  std::vector<Cell> cells = {{}};
  for (std::size_t axis = 0; axis < box.low.size(); ++axis) {
    std::set<double> cuts = {box.high[axis]};
    for (const Tree* tree : trees) {
      for (const TreeNode& node : tree->nodes) {
        const bool cuts_here = node.feature == static_cast<std::int32_t>(axis);
        if (cuts_here && node.value >= box.low[axis] && node.value < box.high[axis]) cuts.insert(node.value);
      }
    }
    std::vector<Cell> finer;
    for (const Cell& cell : cells) {
      double low = box.low[axis];
      for (const double high : cuts) {
        finer.push_back(cell);
        finer.back().low.push_back(low);
        finer.back().high.push_back(high);
        low = high;
      }
    }
    cells = std::move(finer);
  }
  return cells;
}

}  // namespace coppice::testing
