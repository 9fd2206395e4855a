#include "solvers/approximators/forest.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <stdexcept>

#include "solvers/approximators/forest_descent.h"

namespace coppice {
namespace {

constexpr std::size_t kTreesAbreast = 8;

// Calls visit(leaf) for the leaf of x in each of `count` trees, in their order.
template <class Visit>
void for_each_leaf(const ForestNode* nodes, const std::uint32_t* roots, std::size_t count, const float* x,
                   Visit visit) {
  for (std::size_t first = 0; first < count; first += kTreesAbreast) {
    const std::size_t width = std::min(kTreesAbreast, count - first);
    std::array<std::uint32_t, kTreesAbreast> at;
    for (std::size_t i = 0; i < kTreesAbreast; ++i) at[i] = roots[first + (i < width ? i : 0)];
    descend(nodes, at, [x](std::size_t) { return x; });
    for (std::size_t i = 0; i < width; ++i) visit(at[i]);
  }
}

}  // namespace

Forest::Forest(std::size_t inputs, std::vector<OutputScale> outputs, LeafModel leaf)
    : inputs_(inputs), leaf_(leaf), scales_(std::move(outputs)) {
  if (inputs > kMaxTreeInputs) {
    throw std::invalid_argument(fmt::format("trees take at most {} inputs, not {}", kMaxTreeInputs, inputs));
  }
}

PackedTree pack(const Tree& tree) {
  PackedTree packed;
  packed.models = tree.models;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode& node = tree.nodes[i];
    const auto ahead = static_cast<std::uint32_t>(node.child) - static_cast<std::uint32_t>(i);
    if (ahead > ForestNode::kMaxAhead) throw std::runtime_error("a tree is too large to be packed");
    if (ahead != 0) {
      const auto feature = static_cast<std::uint32_t>(node.feature);
      packed.nodes.push_back(ForestNode::split(feature, static_cast<float>(node.value), ahead));
    } else if (tree.leaf == LeafModel::constant) {
      packed.nodes.push_back(ForestNode::leaf(tree.inputs, static_cast<float>(node.value)));
    } else {
      packed.nodes.push_back(ForestNode::linear_leaf(tree.inputs, static_cast<std::uint32_t>(node.value)));
    }
  }
  return packed;
}

OutputScale ValueRange::scale() const {
  const auto power_below = [](double value) { return std::ldexp(1.0, std::max(std::ilogb(value), -1000)); };
  if (!(least < most)) return {least, 1};
  OutputScale scale;
  const double half = most / 2 - least / 2;
  if (half < std::max(std::fabs(least), std::fabs(most)) / 16) {
    const double digit = power_below(half) / 256;
    scale.offset = std::round((least / 2 + most / 2) / digit) * digit;
  }
  scale.scale = power_below(std::max(std::fabs(least - scale.offset), std::fabs(most - scale.offset)));
  return scale;
}

void Forest::reserve(std::size_t trees, std::size_t nodes, std::size_t models) {
  roots_.reserve(trees);
  nodes_.reserve(nodes);
  models_.reserve(models);
}

// Models are stored in the order of their leaves.
void Forest::add(const PackedTree& tree) {
  if (nodes_.size() + tree.nodes.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::runtime_error("a forest can have at most 2^32 nodes");
  }
  const std::size_t width = model_width(inputs_);
  roots_.push_back(static_cast<std::uint32_t>(nodes_.size()));
  for (const ForestNode& node : tree.nodes) {
    if (leaf_ == LeafModel::constant || node.ahead() != 0) {
      nodes_.push_back(node);
      continue;
    }
    nodes_.push_back(ForestNode::linear_leaf(inputs_, static_cast<std::uint32_t>(models_.size() / width)));
    const auto row = tree.models.begin() + static_cast<std::ptrdiff_t>(node.row() * width);
    models_.insert(models_.end(), row, row + static_cast<std::ptrdiff_t>(width));
  }
}

ForestTree Forest::tree(std::size_t output, std::size_t index) const {
  return {inputs_, leaf_, nodes_.data(), models_.data(), roots_[output * trees() + index], scales_[output]};
}

double Forest::linear_value(std::uint32_t leaf, const double* x) const {
  const double* model = models_.data() + nodes_[leaf].row() * model_width(inputs_);
  double value = model[0];
  for (std::size_t i = 0; i < inputs_; ++i) value += model[1 + i] * x[i];
  return value;
}

void Forest::predict(std::span<const double> x, std::span<double> y) const {
  assert(x.size() == inputs_ && y.size() == outputs());
  std::array<float, kMaxTreeInputs + 1> rounded;
  std::transform(x.begin(), x.end(), rounded.begin(), rounded_up);
  rounded[inputs_] = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t output = 0; output < outputs(); ++output) {
    y[output] = aggregation_ == Aggregation::mean ? mean(output, x.data(), rounded.data())
                                                  : trimmed(output, x.data(), rounded.data());
  }
}

double Forest::mean(std::size_t output, const double* x, const float* rounded) const {
  const std::size_t count = trees();
  const std::uint32_t* roots = roots_.data() + output * count;
  double sum = 0;
  if (leaf_ == LeafModel::constant) {
    for_each_leaf(nodes_.data(), roots, count, rounded,
                  [&](std::uint32_t leaf) { sum += static_cast<double>(nodes_[leaf].value); });
    return scales_[output].offset + scales_[output].scale * (sum / static_cast<double>(count));
  }
  double low = 0;
  double high = 0;
  for_each_leaf(nodes_.data(), roots, count, rounded, [&](std::uint32_t leaf) {
    sum += linear_value(leaf, x);
    const double* range = models_.data() + nodes_[leaf].row() * model_width(inputs_) + inputs_ + 1;
    low += range[0];
    high += range[1];
  });
  return std::clamp(sum, low, high) / static_cast<double>(count);
}

double Forest::trimmed(std::size_t output, const double* x, const float* rounded) const {
  thread_local std::vector<double> values;
  values.clear();
  const std::size_t count = trees();
  for_each_leaf(nodes_.data(), roots_.data() + output * count, count, rounded, [&](std::uint32_t leaf) {
    if (leaf_ == LeafModel::constant) {
      values.push_back(static_cast<double>(nodes_[leaf].value));
    } else {
      const double* range = models_.data() + nodes_[leaf].row() * model_width(inputs_) + inputs_ + 1;
      values.push_back(std::clamp(linear_value(leaf, x), range[0], range[1]));
    }
  });
  const double value = trimmed_mean(values);
  return leaf_ == LeafModel::constant ? scales_[output].offset + scales_[output].scale * value : value;
}

}  // namespace coppice
