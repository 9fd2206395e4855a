#include <algorithm>
#include <array>
#include <cassert>

#include "solvers/approximators/tree_building.h"

namespace coppice {
namespace {

class Average {
 public:
  Average(const Tree& t1, const Tree& t2, double w1, double w2, const Box& box, Tree& out,
          std::vector<double>& shares)
      : trees_{&t1, &t2},
        nodes_{t1.nodes.data(), t2.nodes.data()},
        weights_{w1, w2},
        sum_(w1 + w2),
        box_(box),
        region_(scratch_region()),
        out_(out),
        shares_(shares) {
    const bool linear = t1.leaf == LeafModel::linear || t2.leaf == LeafModel::linear;
    begin_tree(out, t1.inputs, linear ? LeafModel::linear : LeafModel::constant);
    out.directions = t1.directions;
    if (t1.directions != t2.directions) shift_ = append(t2.directions, out.directions);
    region_.reset(box, out.directions);
    if (out.inputs == 1 && out.directions.empty()) {
      out.nodes.resize(t1.nodes.size() + t2.nodes.size());  // at most
      shares.resize(out.nodes.size());
      visit_line({nodes_[0], 0}, {nodes_[1], 0}, 0, region_.low(0), region_.high(0));
      out.nodes.resize(static_cast<std::size_t>(size_));
      shares.resize(out.nodes.size());
    } else {
      shares.assign(1, 0.0);
      visit({0, 0}, 0, 0);
    }
  }

 private:
  using Pair = std::array<std::int32_t, 2>;  // a node of each tree

  // Returns how many there were before.
  static std::int32_t append(const Directions& from, Directions& to) {
    const auto shift = static_cast<std::int32_t>(to.size());
    for (std::size_t j = 0; j < from.size(); ++j) {
      double* row = to.add();
      row[0] = from.offset(j);
      std::copy(from.weights(j).begin(), from.weights(j).end(), row + 1);
    }
    return shift;
  }

  bool is_leaf(const Pair& at, std::size_t tree) const { return nodes_[tree][at[tree]].child == at[tree]; }

  // Walks both trees at once, taking their splits in turn (Algorithm 9), those of tree `turn` next. The
  // thesis's line 18 has its inequality the wrong way round: the lower child is useless where the region
  // begins at or above the split.
  void visit(Pair at, std::size_t turn, std::int32_t to) {
    for (;; turn = 1 - turn) {
      if (is_leaf(at, turn)) {
        turn = 1 - turn;
        if (is_leaf(at, turn)) return leaf(at, to);
      }
      const TreeNode& split = nodes_[turn][at[turn]];
      const std::int32_t feature = split.feature + (is_shifted(turn, split.feature) ? shift_ : 0);
      const auto axis = static_cast<std::size_t>(feature);
      const bool high = region_.reaches_high(axis, split.value);
      if (high && region_.reaches_low(axis, split.value)) return branch(at, turn, to, feature);
      at[turn] = split.child + (high ? 1 : 0);
    }
  }

  struct Cursor {
    const TreeNode* nodes;
    std::int32_t at;
    const TreeNode& node() const { return nodes[at]; }
    bool is_leaf() const { return node().child == at; }
  };

  // The same along a line, low < x <= high, where it takes three quarters of the time; `first` is the tree
  // whose turn it is.
  void visit_line(Cursor first, Cursor second, std::int32_t to, double low, double high) {
    for (;; std::swap(first, second)) {
      if (first.is_leaf()) {
        std::swap(first, second);
        if (first.is_leaf()) break;
      }
      const TreeNode split = first.node();
      const bool is_high = high > split.value;
      if (is_high && low < split.value) {
        const std::int32_t child = size_;
        size_ += 2;
        out_.nodes[to] = {split.value, 0, child};
        shares_[to] = low_share(low, high, box_, 0, split.value);
        visit_line(second, {first.nodes, split.child}, child, low, split.value);
        return visit_line(second, {first.nodes, split.child + 1}, child + 1, split.value, high);
      }
      first.at = split.child + (is_high ? 1 : 0);
    }
    const bool in_order = first.nodes == nodes_[0];
    leaf({in_order ? first.at : second.at, in_order ? second.at : first.at}, to);
  }

  bool is_shifted(std::size_t tree, std::int32_t feature) const {
    return shift_ != 0 && tree == 1 && feature >= static_cast<std::int32_t>(out_.inputs);
  }

  void branch(Pair at, std::size_t turn, std::int32_t to, std::int32_t feature) {
    const TreeNode split = nodes_[turn][at[turn]];
    const auto axis = static_cast<std::size_t>(feature);
    const std::int32_t child = add_split(out_, to, feature, split.value);
    shares_.resize(out_.nodes.size());
    shares_[to] = low_share(region_.low(axis), region_.high(axis), box_, axis, split.value);
    at[turn] = split.child;
    region_.in_low(axis, split.value, [&] { visit(at, 1 - turn, child); });
    at[turn] = split.child + 1;
    region_.in_high(axis, split.value, [&] { visit(at, 1 - turn, child + 1); });
  }

  // Eqs. 2.6 to 2.8; a constant is a linear model without slopes (so its A is divided by w1 + w2 too, which
  // Eq. 2.8 forgets).
  void leaf(const Pair& at, std::int32_t to) {
    if (out_.leaf == LeafModel::constant) {
      const double a = nodes_[0][at[0]].value;
      const double b = nodes_[1][at[1]].value;
      add_leaf(out_, to, (a * weights_[0] + b * weights_[1]) / sum_);
      return;
    }
    double* model = add_leaf(out_, to, 0);
    for (std::size_t i = 0; i < model_width(out_.inputs); ++i) {
      model[i] = (term(at, 0, i) * weights_[0] + term(at, 1, i) * weights_[1]) / sum_;
    }
  }

  double term(const Pair& at, std::size_t tree, std::size_t i) const {
    if (trees_[tree]->leaf == LeafModel::linear) return trees_[tree]->model(at[tree])[i];
    const bool is_slope = i >= 1 && i <= out_.inputs;
    return is_slope ? 0.0 : nodes_[tree][at[tree]].value;
  }

  const std::array<const Tree*, 2> trees_;
  const std::array<const TreeNode*, 2> nodes_;
  const std::array<double, 2> weights_;
  const double sum_;
  const Box& box_;
  Region& region_;
  Tree& out_;
  std::vector<double>& shares_;
  std::int32_t size_ = 1;   // of a tree along a line
  std::int32_t shift_ = 0;  // of the numbers of the second tree's directions
};

}  // namespace

void weighted_average(const Tree& t1, const Tree& t2, double w1, double w2, const Box& box, Tree& out,
                      std::vector<double>& shares) {
  assert(t1.inputs == t2.inputs && box.low.size() == t1.inputs);
  Average(t1, t2, w1, w2, box, out, shares);
}

void weighted_average(const Tree& t1, const Tree& t2, double w1, double w2, const Box& box, Tree& out) {
  thread_local std::vector<double> shares;
  weighted_average(t1, t2, w1, w2, box, out, shares);
}

}  // namespace coppice
