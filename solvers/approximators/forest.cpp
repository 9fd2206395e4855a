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
void find_leaves(const ForestNode* nodes, const std::uint32_t* roots, const float* x, Leaves& leaves) {
  std::array<std::uint64_t, kSize> at;
  std::copy(roots, roots + kSize, at.begin());
  descend(nodes, at, [x](std::size_t, std::uint32_t feature) { return x[feature]; });
  std::copy(at.begin(), at.end(), leaves.begin());
}

template <std::size_t... kSizes>
constexpr auto finders(std::index_sequence<kSizes...>) {
  return std::array{find_leaves<1 + kSizes>...};
}
constexpr auto kFindLeaves = finders(std::make_index_sequence<kTreesAbreast>());

// Calls visit(leaf) for the leaf of x, which a NaN follows, in each tree, in their order.
template <class Visit>
void for_each_leaf(const ForestNode* nodes, std::span<const std::uint32_t> roots, std::span<const float> x,
                   const Visit& visit) {
  Leaves leaves;
  std::size_t groups = (roots.size() + kTreesAbreast - 1) / kTreesAbreast;
  for (std::size_t first = 0; groups > 0; --groups) {  // of about equal size
    const std::size_t size = (roots.size() - first + groups - 1) / groups;
    kFindLeaves[size - 1](nodes, roots.data() + first, x.data(), leaves);
    for (std::size_t i = 0; i < size; ++i) visit(static_cast<std::uint32_t>(leaves[i]));
    first += size;
  }
}

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
  roots_.push_back(static_cast<std::uint32_t>(nodes_.size()));
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

double Forest::linear_value(std::uint32_t leaf, const double* x) const {
  const double* model = models_.data() + nodes_[leaf].row() * model_width(inputs_);
  double value = model[0];
  for (std::size_t i = 0; i < inputs_; ++i) value += model[1 + i] * x[i];
  return value;
}

void Forest::predict(std::span<const double> x, std::span<double> y) const {
  assert(x.size() == inputs_ && y.size() == outputs());
  if (trees() == 1) return predict_alone(x, y);
  std::array<float, kMaxTreeInputs + 1> rounded;
  std::transform(x.begin(), x.end(), rounded.begin(), rounded_up);
  for (std::size_t j = 0; j < directions_.size(); ++j)
    rounded[inputs_ + j] = rounded_up(directions_.value(j, x.data()));
  rounded[features()] = std::numeric_limits<float>::quiet_NaN();
  const std::span<const float> inputs(rounded.data(), features());
  for (std::size_t output = 0; output < outputs(); ++output) {
    y[output] = aggregation_ == Aggregation::mean ? mean(output, x.data(), inputs)
                                                  : trimmed(output, x.data(), inputs);
  }
}

void Forest::predict_alone(std::span<const double> x, std::span<double> y) const {
  std::array<std::uint32_t, kMaxTreeInputs> keys;
  std::transform(x.begin(), x.end(), keys.begin(), key_of);
  for (std::size_t j = 0; j < directions_.size(); ++j)
    keys[inputs_ + j] = key_of(directions_.value(j, x.data()));
  for (std::size_t output = 0; output < outputs(); ++output) {
    const std::uint32_t leaf = descend_alone(nodes_.data(), roots_[output], keys.data());
    if (leaf_ == LeafModel::constant) {
      y[output] = scales_[output].offset + scales_[output].scale * nodes_[leaf].value;
    } else {
      const double* range = models_.data() + nodes_[leaf].row() * model_width(inputs_) + inputs_ + 1;
      y[output] = std::clamp(linear_value(leaf, x.data()), range[0], range[1]) + 0.0;  // -0 is 0, as in a sum
    }
  }
}

std::span<const std::uint32_t> Forest::roots_of(std::size_t output) const {
  return std::span(roots_).subspan(output * trees(), trees());
}

double Forest::mean(std::size_t output, const double* x, std::span<const float> rounded) const {
  const auto count = static_cast<double>(trees());
  double sum = 0;
  if (leaf_ == LeafModel::constant) {
    for_each_leaf(nodes_.data(), roots_of(output), rounded,
                  [&](std::uint32_t leaf) { sum += static_cast<double>(nodes_[leaf].value); });
    return scales_[output].offset + scales_[output].scale * (sum / count);
  }
  double low = 0;
  double high = 0;
  for_each_leaf(nodes_.data(), roots_of(output), rounded, [&](std::uint32_t leaf) {
    sum += linear_value(leaf, x);
    const double* range = models_.data() + nodes_[leaf].row() * model_width(inputs_) + inputs_ + 1;
    low += range[0];
    high += range[1];
  });
  return std::clamp(sum, low, high) / count;
}

double Forest::trimmed(std::size_t output, const double* x, std::span<const float> rounded) const {
  thread_local std::vector<double> values;
  values.clear();
  for_each_leaf(nodes_.data(), roots_of(output), rounded, [&](std::uint32_t leaf) {
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
