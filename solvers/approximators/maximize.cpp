#include "solvers/approximators/maximize.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "solvers/approximators/ascent.h"
#include "solvers/approximators/tree_operations.h"
#include "solvers/approximators/tree_region.h"

namespace coppice {
namespace {

// What a subtree gives at most in its part of the box: its model, and the ends of its range (both the value
// itself for constants). `least` only serves to choose where to branch.
struct Bound {
  double model = 0;
  double low = 0;
  double high = 0;
  double least = 0;
};

// A sum of linear models, without their ranges.
struct LinearSum {
  double bias;
  std::array<double, kMaxActionSize> slopes;

  void add(const double* model, std::size_t inputs) {
    bias += model[0];
    for (std::size_t i = 0; i < inputs; ++i) slopes[i] += model[1 + i];
  }
};

// Branch and bound over the cells in which every tree of a projected forest is at a leaf. A branch is a
// region with the deepest node of each tree that covers it; no point of it exceeds the mean of these nodes'
// bounds.
class ExactMaximum {
 public:
  Maximum over(std::span<const Tree> trees, Aggregation aggregation, const Box& box) {
    trees_ = trees;
    trims_ = aggregation == Aggregation::trimmed_mean;
    box_ = &box;
    region_.reset(box, trees[0].directions);
    best_ = {};
    best_.at.resize(box.low.size());
    found_ = false;
    bounds_.clear();
    first_.clear();
    for (const Tree& tree : trees) {
      first_.push_back(bounds_.size());
      bounds_.resize(bounds_.size() + tree.nodes.size());
      bound(tree, 0);
    }
    at_.assign(trees.size(), 0);
    values_.resize(trees.size());
    search(0);
    return best_;
  }

 private:
  Bound& bound_of(std::size_t tree, std::int32_t node) { return bounds_[first_[tree] + node]; }

  const Bound& bound(const Tree& tree, std::int32_t node) {
    Bound& b = bounds_[first_.back() + node];
    const TreeNode& n = tree.nodes[node];
    if (n.child == node) return b = leaf_bound(tree, node);
    const auto axis = static_cast<std::size_t>(n.feature);
    Bound low;
    region_.in_low(axis, n.value, [&] { low = bound(tree, n.child); });
    Bound high;
    region_.in_high(axis, n.value, [&] { high = bound(tree, n.child + 1); });
    return b = {std::max(low.model, high.model), std::max(low.low, high.low), std::max(low.high, high.high),
                std::min(low.least, high.least)};
  }

  Bound leaf_bound(const Tree& tree, std::int32_t node) const {
    if (tree.leaf == LeafModel::constant) {
      const double value = tree.nodes[node].value;
      return {value, value, value, value};
    }
    const double* model = tree.model(node);
    double most = model[0];
    double least = model[0];
    for (std::size_t i = 0; i < tree.inputs; ++i) {
      const double a = model[1 + i] * std::max(region_.low(i), box_->low[i]);
      const double b = model[1 + i] * region_.high(i);
      most += std::max(a, b);
      least += std::min(a, b);
    }
    const double low = model[tree.inputs + 1];
    const double high = model[tree.inputs + 2];
    return {most, low, high, std::clamp(least, low, high)};
  }

  // Searches the region; its nodes are at_[level * trees ... ].
  void search(std::size_t level) {
    const std::size_t count = trees_.size();
    const std::size_t here = level * count;
    Bound sum;
    LinearSum leaves{};
    const bool linear = trees_[0].leaf == LeafModel::linear;
    std::size_t widest = count;
    double spread = -1;
    for (std::size_t t = 0; t < count; ++t) {
      const std::int32_t node = at_[here + t];
      const bool is_leaf = trees_[t].nodes[node].child == node;
      const Bound& b = bound_of(t, node);
      if (is_leaf && linear) {
        leaves.add(trees_[t].model(node), box_->low.size());
      } else {
        sum.model += b.model;
      }
      sum.low += b.low;
      sum.high += b.high;
      if (trims_) values_[t] = b.model;
      if (is_leaf) continue;
      if (const double s = b.high - b.least; s > spread) {
        spread = s;
        widest = t;
      }
    }
    if (linear) sum.model += most_of(leaves);
    const double most = trims_ ? trimmed_mean(values_)
                               : std::clamp(sum.model, sum.low, sum.high) / static_cast<double>(count);
    if (found_ && !(most > best_.value)) return;
    if (widest == count) return cell(here);
    const TreeNode& split = trees_[widest].nodes[at_[here + widest]];
    at_.resize((level + 2) * count);
    const double low_bound = bound_of(widest, split.child).model;
    const double high_bound = bound_of(widest, split.child + 1).model;
    branch(level, split, low_bound >= high_bound);
    branch(level, split, low_bound < high_bound);
  }

  // At most in the region: the leaves of a sum are largest in one corner of it, not each in its own of its
  // own box.
  double most_of(const LinearSum& sum) const {
    double most = sum.bias;
    for (std::size_t i = 0; i < box_->low.size(); ++i) {
      const double low = sum.slopes[i] * std::max(region_.low(i), box_->low[i]);
      most += std::max(low, sum.slopes[i] * region_.high(i));
    }
    return most;
  }

  void branch(std::size_t level, const TreeNode& split, bool low) {
    const auto axis = static_cast<std::size_t>(split.feature);
    const auto descend = [&] {
      const std::size_t count = trees_.size();
      for (std::size_t t = 0; t < count; ++t) at_[(level + 1) * count + t] = down(t, at_[level * count + t]);
      search(level + 1);
    };
    if (low) {
      region_.in_low(axis, split.value, descend);
    } else {
      region_.in_high(axis, split.value, descend);
    }
  }

  // The deepest node below `node` that covers the region.
  std::int32_t down(std::size_t tree, std::int32_t node) const {
    for (;;) {
      const TreeNode& n = trees_[tree].nodes[node];
      if (n.child == node) return node;
      const auto axis = static_cast<std::size_t>(n.feature);
      if (!region_.reaches_high(axis, n.value)) {
        node = n.child;
      } else if (!region_.reaches_low(axis, n.value)) {
        node = n.child + 1;
      } else {
        return node;
      }
    }
  }

  // All trees are at leaves: the mean of the models is constant or linear.
  void cell(std::size_t here) {
    const std::size_t count = trees_.size();
    const std::size_t inputs = box_->low.size();
    double value = 0;
    double low = 0;
    double high = 0;
    slopes_.assign(inputs, 0.0);
    for (std::size_t t = 0; t < count; ++t) {
      const std::int32_t node = at_[here + t];
      if (trees_[t].leaf == LeafModel::constant) {
        value += trees_[t].nodes[node].value;
        if (trims_) values_[t] = trees_[t].nodes[node].value;
        continue;
      }
      const double* model = trees_[t].model(node);
      value += model[0];
      for (std::size_t i = 0; i < inputs; ++i) slopes_[i] += model[1 + i];
      low += model[inputs + 1];
      high += model[inputs + 2];
    }
    Vec<kMaxActionSize> at;
    at.resize(inputs);
    for (std::size_t i = 0; i < inputs; ++i) {
      at[i] = best_place(region_, *box_, i, slopes_[i]);
      value += slopes_[i] * at[i];
    }
    if (trees_[0].leaf == LeafModel::linear) value = std::clamp(value, low, high);
    value = trims_ ? trimmed_mean(values_) : value / static_cast<double>(count);
    if (found_ && !(value > best_.value)) return;
    found_ = true;
    best_ = {at, value};
  }

  std::span<const Tree> trees_;
  const Box* box_ = nullptr;
  Region region_;
  std::vector<Bound> bounds_;       // of all nodes of all trees
  std::vector<std::size_t> first_;  // where a tree's bounds begin
  std::vector<std::int32_t> at_;    // the branch at each level: a node of each tree
  std::vector<double> slopes_;
  std::vector<double> values_;  // of each tree, to be trimmed
  bool trims_ = false;
  Maximum best_;
  bool found_ = false;
};

// A tree is merged of others as their weighted mean; along a line each tree has pieces, and a trimmed mean of
// linear models has more.
void check_trimmed(LeafModel leaf, Maximization::Method method, bool is_exact) {
  if (leaf == LeafModel::linear) {
    throw std::invalid_argument(
        "the maximum of a trimmed mean of linear leaves is not known; choose leaves=\"pwc\" or "
        "aggregation=\"mean\"");
  }
  if (is_exact) return;
  throw std::invalid_argument(
      fmt::format("{}; choose maximization=\"exact\" or aggregation=\"mean\"",
                  method == Maximization::Method::merge
                      ? "trees cannot be merged to their trimmed mean"
                      : "a trimmed mean of trees is not maximized by ascent over several action axes"));
}

// Along a single axis ascent is exact; without any there is one value.
bool finds_exact(const Maximization& how, std::size_t free_inputs) {
  return how.method == Maximization::Method::exact ||
         (how.method == Maximization::Method::ascent && free_inputs <= 1);
}

}  // namespace

void check_maximization(const ForestKind& forest, std::size_t free_inputs, const Maximization& how) {
  if (forest.aggregation == Aggregation::trimmed_mean) {
    check_trimmed(forest.leaf, how.method, finds_exact(how, free_inputs));
  }
  if (forest.is_oblique && free_inputs > 1) {
    throw std::invalid_argument(fmt::format(
        "forests with oblique splits cannot be maximized over {} inputs: their leaves are no boxes; "
        "valid are axis-aligned splits (splits=\"axis\"), or a single input that is left free (one action "
        "axis)",
        free_inputs));
  }
}

Maximum maximize(const Forest& forest, std::span<const double> prefix, const Space& box,
                 const Maximization& how) {
  if (prefix.size() + box.size() != forest.inputs() || box.size() > kMaxActionSize) {
    throw std::invalid_argument(
        fmt::format("a function of {} inputs has no maximum over {} of them with {} given", forest.inputs(),
                    box.size(), prefix.size()));
  }
  check_maximization({forest.leaf(), forest.aggregation(), !forest.directions().empty()}, box.size(), how);
  const bool is_exact = finds_exact(how, box.size());
  const bool is_plain = forest.aggregation() == Aggregation::mean && forest.directions().empty();
  if (is_plain && (is_exact ? box.size() == 1 : how.method == Maximization::Method::ascent)) {
    thread_local Ascent ascent;
    return ascent.over(forest, prefix, box);
  }
  thread_local Box bounds;
  thread_local std::vector<Tree> projected;
  bounds.low.resize(box.size());
  bounds.high.resize(box.size());
  for (std::size_t i = 0; i < box.size(); ++i) {
    bounds.low[i] = box[i].low;
    bounds.high[i] = box[i].high;
  }
  if (projected.size() < forest.trees()) projected.resize(forest.trees());
  const std::span<Tree> trees(projected.data(), forest.trees());
  for (std::size_t i = 0; i < trees.size(); ++i) project(forest.tree(0, i), prefix, bounds, trees[i]);
  if (is_exact) {
    thread_local ExactMaximum exact;
    return exact.over(trees, forest.aggregation(), bounds);
  }
  thread_local Tree merged;
  merge(trees, bounds, static_cast<std::size_t>(std::max(how.leaves, 1)), merged);
  return best_leaf(merged, bounds);
}

}  // namespace coppice
