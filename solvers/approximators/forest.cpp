#include "solvers/approximators/forest.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <stdexcept>
#include <utility>

#include "solvers/approximators/forest_descent.h"

namespace coppice {
namespace {

// More than registers hold: what a descent waits for is memory, and processors see far ahead.
constexpr std::size_t kTreesAbreast = 25;
using Leaves = std::array<std::uint64_t, kTreesAbreast>;

template <std::size_t kSize>
void find_leaves(const ForestNode* nodes, const TreeTop* tops, DescendTops descend_tops,
                 const RoundedPoint& point, Leaves& leaves) {
  std::array<std::uint64_t, kSize> at;
  descend_tops(tops, kSize, point.x.data(), at.data());
  descend_all(nodes, at, point.keys.data());
  std::copy(at.begin(), at.end(), leaves.begin());
}

template <std::size_t... kSizes>
constexpr auto finders(std::index_sequence<kSizes...>) {
  return std::array{find_leaves<1 + kSizes>...};
}
constexpr auto kFindLeaves = finders(std::make_index_sequence<kTreesAbreast>());

// For memory that is not in use yet: it is filled with fewer page faults, and addresses in it are found
// faster.
void prefer_large_pages(void* memory, std::size_t bytes) {
  constexpr std::size_t kWorthIt = std::size_t{16} << 20;
  if (bytes < kWorthIt) return;
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t before = (page - reinterpret_cast<std::uintptr_t>(memory) % page) % page;
  madvise(static_cast<std::byte*>(memory) + before, (bytes - before) / page * page, MADV_HUGEPAGE);  // a wish
}

}  // namespace

Forest::Forest(std::size_t inputs, std::vector<OutputScale> outputs, LeafModel leaf, Directions directions)
    : inputs_(inputs), leaf_(leaf), scales_(std::move(outputs)), directions_(std::move(directions)) {
  if (inputs > kMaxTreeInputs) {
    throw std::invalid_argument(fmt::format("trees take at most {} inputs, not {}", kMaxTreeInputs, inputs));
  }
  if (features() > kMaxTreeInputs) {
    throw std::invalid_argument(fmt::format("trees of {} inputs take at most {} directions, not {}", inputs,
                                            kMaxTreeInputs - inputs, directions_.size()));
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
      packed.nodes.push_back(ForestNode::leaf(tree.features(), static_cast<float>(node.value)));
    } else {
      const auto row = static_cast<std::uint32_t>(node.value);
      packed.nodes.push_back(ForestNode::linear_leaf(tree.features(), row));
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
  tops_.reserve(trees);
  nodes_.reserve(nodes);
  models_.reserve(models);
  prefer_large_pages(nodes_.data(), nodes_.capacity() * sizeof(ForestNode));
}

// Models are stored in the order of their leaves.
void Forest::add(const PackedTree& tree) {
  if (nodes_.size() + tree.nodes.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::runtime_error("a forest can have at most 2^32 nodes");
  }
  const std::size_t width = model_width(inputs_);
  const auto root = static_cast<std::uint32_t>(nodes_.size());
  roots_.push_back(root);
  tops_.push_back(make_top(tree.nodes.data(), 0));
  for (std::uint32_t& exit : tops_.back().exits) exit += root;
  if (leaf_ == LeafModel::constant) {
    nodes_.insert(nodes_.end(), tree.nodes.begin(), tree.nodes.end());
    return;
  }
  for (const ForestNode& node : tree.nodes) {
    if (node.ahead() != 0) {
      nodes_.push_back(node);
      continue;
    }
    nodes_.push_back(ForestNode::linear_leaf(features(), static_cast<std::uint32_t>(models_.size() / width)));
    const auto row = tree.models.begin() + static_cast<std::ptrdiff_t>(node.row() * width);
    models_.insert(models_.end(), row, row + static_cast<std::ptrdiff_t>(width));
  }
}

ForestTree Forest::tree(std::size_t output, std::size_t index) const {
  return {inputs_,         leaf_,       nodes_.data(), models_.data(), roots_[output * trees() + index],
          scales_[output], &directions_};
}

double Forest::linear_value(ForestNode leaf, const double* x) const {
  const double* model = models_.data() + leaf.row() * model_width(inputs_);
  double value = model[0];
  for (std::size_t i = 0; i < inputs_; ++i) value += model[1 + i] * x[i];
  return value;
}

void Forest::predict(std::span<const double> x, std::span<double> y) const {
  assert(x.size() == inputs_ && y.size() == outputs());
  if (trees() == 1) return predict_alone(x, y);
  RoundedPoint point;
  for (std::size_t i = 0; i < inputs_; ++i) point.set(i, x[i]);
  for (std::size_t j = 0; j < directions_.size(); ++j) point.set(inputs_ + j, directions_.value(j, x.data()));
  point.keys[features()] = InputKey::of_leaf();
  for (std::size_t output = 0; output < outputs(); ++output) {
    y[output] =
        aggregation_ == Aggregation::mean ? mean(output, x.data(), point) : trimmed(output, x.data(), point);
  }
}

// Calls visit(leaf) for the leaf of the point in each tree, in their order.
template <class Visit>
void Forest::for_each_leaf(std::size_t output, const RoundedPoint& point, const Visit& visit) const {
  const DescendTops descend_tops = top_descent(features());
  Leaves leaves;
  const TreeTop* tops = tops_.data() + output * trees();
  std::size_t left = trees();
  for (std::size_t groups = (left + kTreesAbreast - 1) / kTreesAbreast; groups > 0; --groups) {
    const std::size_t size = (left + groups - 1) / groups;  // of about equal size
    kFindLeaves[size - 1](nodes_.data(), tops, descend_tops, point, leaves);
    for (std::size_t i = 0; i < size; ++i) visit(static_cast<std::uint32_t>(leaves[i]));
    tops += size;
    left -= size;
  }
}

void Forest::predict_alone(std::span<const double> x, std::span<double> y) const {
  std::array<std::uint32_t, kMaxTreeInputs> keys;
  std::transform(x.begin(), x.end(), keys.begin(), key_of);
  for (std::size_t j = 0; j < directions_.size(); ++j)
    keys[inputs_ + j] = key_of(directions_.value(j, x.data()));
  for (std::size_t output = 0; output < outputs(); ++output) {
    const ForestNode leaf = descend_alone(nodes_.data(), roots_[output], keys.data());
    if (leaf_ == LeafModel::constant) {
      y[output] = scales_[output].offset + scales_[output].scale * leaf.value;
    } else {
      const double* range = models_.data() + leaf.row() * model_width(inputs_) + inputs_ + 1;
      y[output] = std::clamp(linear_value(leaf, x.data()), range[0], range[1]) + 0.0;  // -0 is 0, as in a sum
    }
  }
}

double Forest::mean(std::size_t output, const double* x, const RoundedPoint& point) const {
  const auto count = static_cast<double>(trees());
  double sum = 0;
  if (leaf_ == LeafModel::constant) {
    for_each_leaf(output, point, [&](std::uint32_t leaf) { sum += static_cast<double>(nodes_[leaf].value); });
    return scales_[output].offset + scales_[output].scale * (sum / count);
  }
  double low = 0;
  double high = 0;
  for_each_leaf(output, point, [&](std::uint32_t leaf) {
    sum += linear_value(nodes_[leaf], x);
    const double* range = models_.data() + nodes_[leaf].row() * model_width(inputs_) + inputs_ + 1;
    low += range[0];
    high += range[1];
  });
  return std::clamp(sum, low, high) / count;
}

double Forest::trimmed(std::size_t output, const double* x, const RoundedPoint& point) const {
  thread_local std::vector<double> values;
  values.clear();
  for_each_leaf(output, point, [&](std::uint32_t leaf) {
    if (leaf_ == LeafModel::constant) {
      values.push_back(static_cast<double>(nodes_[leaf].value));
    } else {
      const double* range = models_.data() + nodes_[leaf].row() * model_width(inputs_) + inputs_ + 1;
      values.push_back(std::clamp(linear_value(nodes_[leaf], x), range[0], range[1]));
    }
  });
  const double value = trimmed_mean(values);
  return leaf_ == LeafModel::constant ? scales_[output].offset + scales_[output].scale * value : value;
}

}  // namespace coppice
