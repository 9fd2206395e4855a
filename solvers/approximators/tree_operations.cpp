#include "solvers/approximators/tree_operations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <stdexcept>

#include "solvers/approximators/tree_building.h"

namespace coppice {
namespace {

class BestLeaf {
 public:
  BestLeaf(const Tree& tree, const Box& box, Region& region) : tree_(tree), box_(box), region_(region) {
    region.reset(box, tree.directions);
    best_.at.resize(tree.inputs);
    visit(0);
  }
  const Maximum& best() const { return best_; }

 private:
  void visit(std::int32_t at) {
    if (tree_.is_leaf(at)) return leaf(at);
    const TreeNode& split = tree_.nodes[at];
    const auto axis = static_cast<std::size_t>(split.feature);
    if (region_.reaches_low(axis, split.value)) {
      region_.in_low(axis, split.value, [&] { visit(split.child); });
    }
    if (region_.reaches_high(axis, split.value)) {
      region_.in_high(axis, split.value, [&] { visit(split.child + 1); });
    }
  }

  void leaf(std::int32_t at) {
    const double* model = tree_.leaf == LeafModel::linear ? tree_.model(at) : nullptr;
    double value = model == nullptr ? tree_.nodes[at].value : model[0];
    for (std::size_t i = 0; model != nullptr && i < tree_.inputs; ++i)
      value += model[1 + i] * place(model, i);
    if (model != nullptr) value = std::clamp(value, model[tree_.inputs + 1], model[tree_.inputs + 2]);
    if (found_ && !(value > best_.value)) return;
    found_ = true;
    best_.value = value;
    for (std::size_t i = 0; i < tree_.inputs; ++i) best_.at[i] = place(model, i);
  }

  double place(const double* model, std::size_t axis) const {
    return best_place(region_, box_, axis, model == nullptr ? 0.0 : model[1 + axis]);
  }

  const Tree& tree_;
  const Box& box_;
  Region& region_;
  Maximum best_;
  bool found_ = false;
};

}  // namespace

Box Box::everything(std::size_t inputs) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {std::vector<double>(inputs, -kInfinity), std::vector<double>(inputs, kInfinity)};
}

// Children follow their parents, in pairs, so that what is used can be moved to the front in its order.
void drop_unused(Tree& tree) {
  std::vector<std::int32_t> place(tree.nodes.size(), -1);  // of what is used; else -1
  std::vector<double> models;
  const auto width = static_cast<std::ptrdiff_t>(model_width(tree.inputs));
  place[0] = 0;
  std::int32_t size = 1;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode node = tree.nodes[i];
    if (place[i] < 0 || tree.is_leaf(static_cast<std::int32_t>(i))) continue;
    place[node.child] = size++;
    place[node.child + 1] = size++;
  }
  std::vector<TreeNode> nodes(static_cast<std::size_t>(size));
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    if (place[i] < 0) continue;
    TreeNode node = tree.nodes[i];
    if (tree.leaf == LeafModel::linear && tree.is_leaf(static_cast<std::int32_t>(i))) {
      const double* model = tree.model(static_cast<std::int32_t>(i));
      const std::size_t row = models.size() / static_cast<std::size_t>(width);
      node.value = static_cast<double>(row);
      models.insert(models.end(), model, model + width);
    }
    node.child = place[node.child];
    nodes[place[i]] = node;
  }
  tree.nodes = std::move(nodes);
  tree.models = std::move(models);
}

void merge(std::span<const Tree> trees, const Box& box, std::size_t max_leaves, Tree& out) {
  thread_local Tree pruned;
  thread_local Tree sum;
  thread_local std::vector<double> shares;
  out = trees[0];
  prune(out, box, max_leaves);
  for (std::size_t i = 1; i < trees.size(); ++i) {
    pruned = trees[i];
    prune(pruned, box, max_leaves);
    weighted_average(out, pruned, static_cast<double>(i), 1, box, sum, shares);
    prune(sum, box, max_leaves, shares);
    std::swap(out, sum);
  }
}

void check_boxes(const Tree& tree) {
  if (tree.directions.empty()) return;
  const auto inputs = static_cast<std::int32_t>(tree.inputs);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    if (tree.is_leaf(static_cast<std::int32_t>(i)) || tree.nodes[i].feature < inputs) continue;
    throw std::invalid_argument(fmt::format(
        "trees with oblique splits of {} inputs can be neither pruned nor maximized: their leaves "
        "are no boxes; valid are axis-aligned splits (splits=\"axis\"), or a single input that is "
        "left free (one action axis)",
        tree.inputs));
  }
}

Maximum best_leaf(const Tree& tree, const Box& box) {
  assert(tree.inputs <= kMaxActionSize);
  check_boxes(tree);
  return BestLeaf(tree, box, scratch_region()).best();
}

std::size_t count_leaves(const Tree& tree) {
  std::vector<std::int32_t> open{0};
  std::size_t leaves = 0;
  while (!open.empty()) {
    const std::int32_t node = open.back();
    open.pop_back();
    if (tree.is_leaf(node)) {
      ++leaves;
      continue;
    }
    open.push_back(tree.nodes[node].child);
    open.push_back(tree.nodes[node].child + 1);
  }
  return leaves;
}

}  // namespace coppice
