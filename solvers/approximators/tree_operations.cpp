#include "solvers/approximators/tree_operations.h"

#include <algorithm>
#include <cassert>

#include "solvers/approximators/tree_region.h"

namespace coppice {
namespace {

// Makes `tree` a single root, to be filled.
void begin_tree(Tree& tree, std::size_t inputs, LeafModel leaf) {
  tree.inputs = inputs;
  tree.leaf = leaf;
  tree.nodes.assign(1, {});
  tree.models.clear();
}

// Makes node `at` a split and returns its low child; the high one follows it.
std::int32_t add_split(Tree& tree, std::int32_t at, std::int32_t feature, double threshold) {
  const auto child = static_cast<std::int32_t>(tree.nodes.size());
  tree.nodes.resize(tree.nodes.size() + 2);
  tree.nodes[at] = {threshold, feature, child};
  return child;
}

// Makes node `at` a leaf; for a linear one the caller fills the row that is returned.
double* add_leaf(Tree& tree, std::int32_t at, double constant) {
  tree.nodes[at] = {constant, static_cast<std::int32_t>(tree.inputs), at};
  if (tree.leaf == LeafModel::constant) return nullptr;
  const std::size_t width = model_width(tree.inputs);
  const std::size_t first = tree.models.size(), number = first / width;
  tree.nodes[at].value = static_cast<double>(number);
  tree.models.resize(first + width);
  return tree.models.data() + first;
}

class Projection {
 public:
  Projection(const ForestTree& tree, std::span<const double> prefix, const Box& box, Region& region,
             Tree& out)
      : tree_(tree), prefix_(prefix), region_(region), out_(out) {
    region.reset(box);
    begin_tree(out, tree.inputs - prefix.size(), tree.leaf);
    visit(tree.root, 0);
  }

 private:
  void visit(std::uint32_t from, std::int32_t to) {
    while (!tree_.is_leaf(from)) {
      const ForestNode& node = tree_.nodes[from];
      const std::uint32_t below = from + node.ahead();
      const std::size_t feature = node.feature();
      const double threshold = node.value;
      if (feature < prefix_.size()) {
        from = below + (prefix_[feature] > threshold ? 1 : 0);
        continue;
      }
      const std::size_t axis = feature - prefix_.size();
      const bool low = region_.reaches_low(axis, threshold);
      const bool high = region_.reaches_high(axis, threshold);
      if (low && high) {
        const std::int32_t child = add_split(out_, to, static_cast<std::int32_t>(axis), threshold);
        region_.in_low(axis, threshold, [&] { visit(below, child); });
        region_.in_high(axis, threshold, [&] { visit(below + 1, child + 1); });
        return;
      }
      from = below + (low ? 0 : 1);
    }
    leaf(from, to);
  }

  // P(L(A, B), i) = L(A_j, B + A_i i), summed in the order of a prediction.
  void leaf(std::uint32_t from, std::int32_t to) {
    double* model = add_leaf(out_, to, tree_.leaf == LeafModel::constant ? tree_.constant(from) : 0);
    if (model == nullptr) return;
    const double* whole = tree_.model(from);
    model[0] = whole[0];
    for (std::size_t i = 0; i < prefix_.size(); ++i) model[0] += whole[1 + i] * prefix_[i];
    std::copy(whole + 1 + prefix_.size(), whole + model_width(tree_.inputs), model + 1);
  }

  const ForestTree tree_;
  const std::span<const double> prefix_;
  Region& region_;
  Tree& out_;
};

class Average {
 public:
  Average(const Tree& t1, const Tree& t2, double w1, double w2, const Box& box, Region& region, Tree& out)
      : region_(region), out_(out) {
    const bool linear = t1.leaf == LeafModel::linear || t2.leaf == LeafModel::linear;
    region.reset(box);
    begin_tree(out, t1.inputs, linear ? LeafModel::linear : LeafModel::constant);
    visit({t1, 0, w1}, {t2, 0, w2}, 0);
  }

 private:
  struct Part {
    const Tree& tree;
    std::int32_t node;
    double weight;
    Part child(std::int32_t side) const { return {tree, tree.nodes[node].child + side, weight}; }
  };

  // Walks both trees at once, taking their splits in turn (Algorithm 9). The thesis's line 18 has its
  // inequality the wrong way round: the lower child is useless where the region begins at or above the split.
  void visit(const Part& first, const Part& second, std::int32_t to) {
    if (first.tree.is_leaf(first.node)) {
      if (second.tree.is_leaf(second.node)) return leaf(first, second, to);
      return visit(second, first, to);
    }
    const TreeNode& split = first.tree.nodes[first.node];
    const auto axis = static_cast<std::size_t>(split.feature);
    if (!region_.reaches_high(axis, split.value)) return visit(second, first.child(0), to);
    if (!region_.reaches_low(axis, split.value)) return visit(second, first.child(1), to);
    const std::int32_t child = add_split(out_, to, split.feature, split.value);
    region_.in_low(axis, split.value, [&] { visit(second, first.child(0), child); });
    region_.in_high(axis, split.value, [&] { visit(second, first.child(1), child + 1); });
  }

  // Eqs. 2.6 to 2.8; a constant is a linear model without slopes (so its A is divided by w1 + w2 too, which
  // Eq. 2.8 forgets).
  void leaf(const Part& first, const Part& second, std::int32_t to) {
    const double sum = first.weight + second.weight;
    if (out_.leaf == LeafModel::constant) {
      const double a = first.tree.nodes[first.node].value;
      const double b = second.tree.nodes[second.node].value;
      add_leaf(out_, to, (a * first.weight + b * second.weight) / sum);
      return;
    }
    double* model = add_leaf(out_, to, 0);
    for (std::size_t i = 0; i < model_width(out_.inputs); ++i) {
      model[i] = (term(first, i) * first.weight + term(second, i) * second.weight) / sum;
    }
  }

  static double term(const Part& part, std::size_t i) {
    if (part.tree.leaf == LeafModel::linear) return part.tree.model(part.node)[i];
    const bool is_slope = i >= 1 && i <= part.tree.inputs;
    return is_slope ? 0.0 : part.tree.nodes[part.node].value;
  }

  Region& region_;
  Tree& out_;
};

class BestLeaf {
 public:
  BestLeaf(const Tree& tree, const Box& box, Region& region) : tree_(tree), box_(box), region_(region) {
    region.reset(box);
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

// Regions of operations that do not run at the same time in one thread.
Region& scratch_region() {
  thread_local Region region;
  return region;
}

}  // namespace

Box Box::everything(std::size_t inputs) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {std::vector<double>(inputs, -kInfinity), std::vector<double>(inputs, kInfinity)};
}

void project(const ForestTree& tree, std::span<const double> prefix, const Box& box, Tree& out) {
  assert(prefix.size() + box.low.size() == tree.inputs);
  Projection(tree, prefix, box, scratch_region(), out);
}

void weighted_average(const Tree& t1, const Tree& t2, double w1, double w2, const Box& box, Tree& out) {
  assert(t1.inputs == t2.inputs && box.low.size() == t1.inputs);
  Average(t1, t2, w1, w2, box, scratch_region(), out);
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
  out = trees[0];
  prune(out, box, max_leaves);
  for (std::size_t i = 1; i < trees.size(); ++i) {
    pruned = trees[i];
    prune(pruned, box, max_leaves);
    weighted_average(out, pruned, static_cast<double>(i), 1, box, sum);
    prune(sum, box, max_leaves);
    std::swap(out, sum);
  }
}

Maximum best_leaf(const Tree& tree, const Box& box) {
  assert(tree.inputs <= kMaxActionSize);
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
