#include "solvers/approximators/forest.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace coppice {
namespace {

// So many trees are descended at once: their loads overlap, where one tree after the other would wait for
// each.
constexpr std::size_t kAbreast = 8;

struct PaddedInput {
  std::array<double, kMaxTreeInputs + 1> values;
  PaddedInput(std::span<const double> x) {
    std::copy(x.begin(), x.end(), values.begin());
    values[x.size()] = std::numeric_limits<double>::quiet_NaN();
  }
};

// Calls visit(leaf) for the leaf of x in each of `count` trees, in their order.
template <class Visit>
void for_each_leaf(const TreeNode* nodes, const std::int32_t* roots, std::size_t count, const double* x,
                   Visit visit) {
  for (std::size_t first = 0; first < count; first += kAbreast) {
    const std::size_t width = std::min(kAbreast, count - first);
    std::array<std::int32_t, kAbreast> at;
    for (std::size_t i = 0; i < kAbreast; ++i) at[i] = roots[first + (i < width ? i : 0)];
    std::int32_t moved;
    do {
      moved = 0;
      for (std::int32_t& node : at) {
        const TreeNode& n = nodes[node];
        const std::int32_t next = n.child + (x[n.feature] > n.value ? 1 : 0);
        moved |= next ^ node;
        node = next;
      }
    } while (moved != 0);
    for (std::size_t i = 0; i < width; ++i) visit(at[i]);
  }
}

[[noreturn]] void invalid(std::string_view why) {
  throw std::runtime_error(fmt::format("not a valid forest: {}", why));
}

}  // namespace

Forest::Forest(std::size_t inputs, std::size_t outputs, LeafModel leaf)
    : inputs_(inputs), outputs_(outputs), leaf_(leaf) {
  if (inputs > kMaxTreeInputs) {
    throw std::invalid_argument(fmt::format("trees take at most {} inputs, not {}", kMaxTreeInputs, inputs));
  }
}

void Forest::add(const Tree& tree) {
  assert(tree.inputs == inputs_ && tree.leaf == leaf_);
  const std::size_t offset = nodes_.size();
  if (offset + tree.nodes.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    throw std::runtime_error("a forest can have at most 2^31 nodes");
  }
  const std::size_t models = models_.size() / model_width(inputs_);
  const auto first_model = static_cast<double>(models);
  roots_.push_back(static_cast<std::int32_t>(offset));
  for (TreeNode node : tree.nodes) {
    const bool is_leaf = node.feature == static_cast<std::int32_t>(inputs_);
    if (is_leaf && leaf_ == LeafModel::linear) node.value += first_model;
    node.child += static_cast<std::int32_t>(offset);
    nodes_.push_back(node);
  }
  models_.insert(models_.end(), tree.models.begin(), tree.models.end());
}

TreeView Forest::tree(std::size_t output, std::size_t index) const {
  TreeView view;
  view.inputs = inputs_;
  view.leaf = leaf_;
  view.nodes = nodes_.data();
  view.models = models_.data();
  view.root = roots_[output * trees() + index];
  return view;
}

std::size_t Forest::leaves() const {
  return (nodes_.size() + roots_.size()) / 2;
}

double Forest::constant_mean(const double* x, const std::int32_t* roots) const {
  double sum = 0;
  for_each_leaf(nodes_.data(), roots, trees(), x, [&](std::int32_t leaf) { sum += nodes_[leaf].value; });
  return sum / static_cast<double>(trees());
}

double Forest::linear_mean(const double* x, const std::int32_t* roots) const {
  double sum = 0;
  double low = 0;
  double high = 0;
  for_each_leaf(nodes_.data(), roots, trees(), x, [&](std::int32_t leaf) {
    const double* model =
        models_.data() + static_cast<std::size_t>(nodes_[leaf].value) * model_width(inputs_);
    double value = model[0];
    for (std::size_t i = 0; i < inputs_; ++i) value += model[1 + i] * x[i];
    sum += value;
    low += model[inputs_ + 1];
    high += model[inputs_ + 2];
  });
  return std::clamp(sum, low, high) / static_cast<double>(trees());
}

void Forest::predict(std::span<const double> x, std::span<double> y) const {
  assert(x.size() == inputs_ && y.size() == outputs_);
  const PaddedInput padded(x);
  for (std::size_t output = 0; output < outputs_; ++output) {
    const std::int32_t* roots = roots_.data() + output * trees();
    y[output] = leaf_ == LeafModel::constant ? constant_mean(padded.values.data(), roots)
                                             : linear_mean(padded.values.data(), roots);
  }
}

void Forest::save(Archive& archive) const {
  std::vector<double> values(nodes_.size());
  std::vector<std::int32_t> features(nodes_.size());
  std::vector<std::int32_t> children(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    values[i] = nodes_[i].value;
    features[i] = nodes_[i].feature;
    children[i] = nodes_[i].child;
  }
  archive.put("shape", std::vector<std::int64_t>{static_cast<std::int64_t>(inputs_),
                                                 static_cast<std::int64_t>(outputs_),
                                                 static_cast<std::int64_t>(leaf_)});
  archive.put("roots", roots_);
  archive.put("values", std::move(values));
  archive.put("features", std::move(features));
  archive.put("children", std::move(children));
  archive.put("models", models_);
}

Forest Forest::load(const Archive& archive) {
  const auto& shape = archive.get<std::vector<std::int64_t>>("shape");
  if (shape.size() != 3) invalid("its shape needs three numbers");
  if (shape[0] < 0 || shape[0] > static_cast<std::int64_t>(kMaxTreeInputs)) invalid("number of inputs");
  if (shape[1] < 1 || shape[1] > std::numeric_limits<std::int32_t>::max()) invalid("number of outputs");
  if (shape[2] != 0 && shape[2] != 1) invalid("unknown kind of leaf");
  Forest forest(static_cast<std::size_t>(shape[0]), static_cast<std::size_t>(shape[1]),
                static_cast<LeafModel>(shape[2]));
  const auto& values = archive.get<std::vector<double>>("values");
  const auto& features = archive.get<std::vector<std::int32_t>>("features");
  const auto& children = archive.get<std::vector<std::int32_t>>("children");
  if (features.size() != values.size() || children.size() != values.size())
    invalid("arrays differ in length");
  if (values.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    invalid("too many nodes");
  for (std::size_t i = 0; i < values.size(); ++i)
    forest.nodes_.push_back({values[i], features[i], children[i]});
  forest.roots_ = archive.get<std::vector<std::int32_t>>("roots");
  forest.models_ = archive.get<std::vector<double>>("models");
  forest.check();
  return forest;
}

// Every node must be a root or the child of exactly one node before it, so that nothing can loop or grow when
// it is walked; depth is bounded for the sake of recursion.
void Forest::check() const {
  if (roots_.empty() || roots_.size() % outputs_ != 0) invalid("number of trees");
  const auto size = static_cast<std::int32_t>(nodes_.size());
  const std::size_t rows = models_.size() / model_width(inputs_);
  std::vector<std::int32_t> depth(nodes_.size(), -1);
  const auto reach = [&](std::int32_t node, std::int32_t at_depth) {
    if (node < 0 || node >= size) invalid("a node that does not exist");
    if (depth[node] >= 0) invalid("a node is used twice");
    if (at_depth > kMaxTreeDepth) invalid("too deep");
    depth[node] = at_depth;
  };
  for (const std::int32_t root : roots_) reach(root, 0);
  for (std::int32_t i = 0; i < size; ++i) {
    const TreeNode& node = nodes_[i];
    if (depth[i] < 0) invalid("a node that no tree reaches");
    if (!std::isfinite(node.value)) invalid("a value that is not finite");
    if (node.feature == static_cast<std::int32_t>(inputs_)) {
      if (node.child != i) invalid("a leaf with children");
      if (leaf_ == LeafModel::linear && !(node.value >= 0 && node.value < static_cast<double>(rows) &&
                                          node.value == std::floor(node.value))) {
        invalid("a leaf without its model");
      }
      continue;
    }
    if (node.feature < 0 || node.feature > static_cast<std::int32_t>(inputs_)) invalid("a split of no input");
    if (node.child <= i || node.child >= size - 1) invalid("children that do not follow their parent");
    reach(node.child, depth[i] + 1);
    reach(node.child + 1, depth[i] + 1);
  }
  if (leaf_ == LeafModel::constant ? !models_.empty() : models_.size() % model_width(inputs_) != 0) {
    invalid("size of its leaf models");
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const double* model = models_.data() + row * model_width(inputs_);
    if (!std::all_of(model, model + model_width(inputs_), [](double v) { return std::isfinite(v); })) {
      invalid("a leaf model that is not finite");
    }
    if (model[inputs_ + 1] > model[inputs_ + 2]) invalid("a leaf model with an empty range");
  }
}

}  // namespace coppice
