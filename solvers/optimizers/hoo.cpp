#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/vocabulary/elementary.h"
#include "solvers/optimizers/box.h"
#include "solvers/optimizers/generations.h"

namespace coppice {
namespace {

/// Hierarchical optimistic optimization of a stochastic function (Bubeck, Munos, Stoltz and Szepesvari, JMLR
/// 12 (2011)): a binary tree of cells of the box scaled to the unit cube; the cell of the largest optimistic
/// bound is sampled and split. The confidence bound has the logarithm of the budget, not of the samples so
/// far, so that a sample changes bounds on its path only. The paper's values are in [0, 1]; here its
/// constants are multiplied by the range of the values seen.
class Hoo : public Optimizer {
 public:
  double nu = 1;
  std::optional<double> rho;
  double confidence = 0.1;

  std::unique_ptr<Search> start(const SearchTask& task) const override;
  std::vector<std::string> measures() const override { return {"cells", "depth"}; }

  static Parameters<Hoo> parameters() {
    return Parameters<Hoo>()
        .add(
            "nu", &Hoo::nu, "",
            "nu_1: a cell of depth h is taken to vary by nu rho^h, in units of the range of the values seen.",
            above(0))
        .automatic(
            "rho", &Hoo::rho, "",
            "Each split makes a cell vary by this factor less; auto: 2^(-2/n) for n axes, right near a "
            "smooth optimum.",
            between(0.01, 0.999))
        .add("confidence", &Hoo::confidence, "",
             "Factor of the confidence bound sqrt(2 ln N / T) of a cell sampled T times of N, in the same "
             "units; 1 "
             "as published, for values whose noise fills the range.",
             at_least(0));
  }
};

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class OptimisticSearch : public Generations {
 public:
  OptimisticSearch(const Hoo& method, const SearchTask& task) : Generations(task) {
    for (std::size_t i = 0; i < dimension(); ++i) {
      if (task.box[i].low < task.box[i].high) axes_.push_back(i);
    }
    const double n = static_cast<double>(std::max<std::size_t>(1, axes_.size()));
    const double rho = method.rho ? *method.rho : elementary::pow(2, -2 / n);
    const double log_budget = elementary::log(static_cast<double>(task.budget));
    confidence_ = method.confidence * std::sqrt(2 * log_budget);
    const auto most = static_cast<std::size_t>(50 * n);  // a side is halved 50 times at most
    variation_.push_back(method.nu);
    while (variation_.size() <= most) variation_.push_back(variation_.back() * rho);
  }

  std::vector<double> best() const override {
    if (!task().noisy && !best_.empty()) return best_;
    return descend(recommended_path()).centre;
  }
  double best_value() const override {
    if (!task().noisy || nodes_.empty()) return best_value_;
    return mean(nodes_[recommended_path().back()]);
  }
  std::vector<double> measures() const override {
    return {static_cast<double>(nodes_.size()), static_cast<double>(deepest_)};
  }

 protected:
  Candidates next_generation(std::int64_t) override {
    path_ = optimistic_path();
    const Cell cell = descend(path_);
    const Draws draws = task().draws.scenario(static_cast<std::uint64_t>(told_));
    Candidates generation{Matrix(1, dimension()), {static_cast<std::uint64_t>(told_)}};
    std::vector<double> x(dimension());
    for (std::size_t i = 0; i < dimension(); ++i) {
      x[i] = draws.uniform("hoo", cell.low[i], cell.high[i], static_cast<std::uint32_t>(i));
    }
    clip(task().box, x);
    generation.points.set_row(0, told_ == 0 ? first_point(task()) : x);
    return generation;
  }

  void learn(const Candidates& generation, std::span<const double> values) override {
    ++told_;
    double value = values[0];
    if (best_.empty() || value > best_value_) {
      best_.resize(dimension());
      generation.points.row(0, best_);
      best_value_ = value;
    }
    if (std::isfinite(value)) {
      lowest_ = any_ ? std::min(lowest_, value) : value;
      highest_ = any_ ? std::max(highest_, value) : value;
      any_ = true;
    } else {
      value = value > 0 ? highest_ : lowest_;  // means need numbers
    }
    for (const std::size_t node : path_) {
      nodes_[node].sum += value;
      ++nodes_[node].count;
    }
    if (highest_ - lowest_ > 1.1 * range_) {  // not at each new record: that costs a pass over the tree
      range_ = highest_ - lowest_;
      for (std::size_t node = nodes_.size(); node-- > 0;) bound(nodes_[node]);
    } else {
      for (std::size_t i = path_.size(); i-- > 0;) bound(nodes_[path_[i]]);
    }
  }

  void save_method(Archive& archive) const override;
  void load_method(Archive& archive) override;

 private:
  struct Node {
    std::int64_t depth = 0;
    std::int64_t child[2] = {-1, -1};  ///< created after it
    double count = 0;
    double sum = 0;
    double bound = kInfinity;  ///< B of the paper
  };
  struct Cell {
    std::vector<double> low, high, centre;
  };

  static double mean(const Node& node) { return node.sum / node.count; }
  double bound_of(std::int64_t node) const {
    return node < 0 ? kInfinity : nodes_[static_cast<std::size_t>(node)].bound;
  }

  void bound(Node& node) const {
    if (node.count == 0) return;
    const double variation = variation_[static_cast<std::size_t>(node.depth)];
    const double optimistic = mean(node) + range_ * (confidence_ / std::sqrt(node.count) + variation);
    node.bound = std::min(optimistic, std::max(bound_of(node.child[0]), bound_of(node.child[1])));
    if (static_cast<std::size_t>(node.depth) + 1 == variation_.size())
      node.bound = optimistic;  // has no children
  }

  /// From the root by the larger bound to a cell that was never sampled, which is created, or to the deepest.
  std::vector<std::size_t> optimistic_path() {
    const Draws draws = task().draws.scenario(static_cast<std::uint64_t>(told_));
    if (nodes_.empty()) nodes_.emplace_back();
    std::vector<std::size_t> path = {0};
    while (nodes_[path.back()].count > 0) {
      const std::size_t at = path.back();
      const auto depth = static_cast<std::size_t>(nodes_[at].depth);
      if (depth + 1 == variation_.size()) break;
      const double low = bound_of(nodes_[at].child[0]), high = bound_of(nodes_[at].child[1]);
      const std::size_t side = low > high   ? 0
                               : low < high ? 1
                                            : draws.below("tie", 2, static_cast<std::uint32_t>(depth));
      if (nodes_[at].child[side] < 0) {
        nodes_[at].child[side] = static_cast<std::int64_t>(nodes_.size());
        nodes_.push_back({.depth = nodes_[at].depth + 1});
        deepest_ = std::max(deepest_, nodes_.back().depth);
      }
      path.push_back(static_cast<std::size_t>(nodes_[at].child[side]));
    }
    return path;
  }

  /// By the more often sampled half, while it was sampled several times.
  std::vector<std::size_t> recommended_path() const {
    std::vector<std::size_t> path;
    if (nodes_.empty()) return path;
    const double enough = std::max(2.0, std::sqrt(nodes_[0].count) / 4);
    for (std::int64_t node = 0; node >= 0;) {
      path.push_back(static_cast<std::size_t>(node));
      const auto& child = nodes_[path.back()].child;
      const auto count = [&](std::int64_t c) {
        return c < 0 ? 0 : nodes_[static_cast<std::size_t>(c)].count;
      };
      node = count(child[1]) > count(child[0]) ? child[1] : child[0];
      if (count(node) < enough) break;
    }
    return path;
  }

  /// The axes are halved in turn.
  Cell descend(const std::vector<std::size_t>& path) const {
    Cell cell;
    for (const Axis& axis : task().box) {
      cell.low.push_back(axis.low);
      cell.high.push_back(axis.high);
    }
    for (std::size_t h = 1; h < path.size(); ++h) {
      const std::size_t axis = axes_.empty() ? 0 : axes_[(h - 1) % axes_.size()];
      const double middle = cell.low[axis] / 2 + cell.high[axis] / 2;
      const bool upper = nodes_[path[h - 1]].child[1] == static_cast<std::int64_t>(path[h]);
      (upper ? cell.low : cell.high)[axis] = middle;
    }
    for (std::size_t i = 0; i < dimension(); ++i) cell.centre.push_back(cell.low[i] / 2 + cell.high[i] / 2);
    clip(task().box, cell.centre);
    return cell;
  }

  std::vector<std::size_t> axes_;  ///< those that are not fixed
  double confidence_ = 0;          ///< of one sample
  std::vector<double> variation_;  ///< of a cell, by depth
  std::vector<Node> nodes_;        ///< the root first
  std::vector<std::size_t> path_;  ///< to the cell that is sampled
  std::int64_t told_ = 0, deepest_ = 0;
  bool any_ = false;
  double lowest_ = 0, highest_ = 0;  ///< finite values
  double range_ = 0;                 ///< that the bounds are made with
  std::vector<double> best_;         ///< sample
  double best_value_ = std::numeric_limits<double>::quiet_NaN();
};

void OptimisticSearch::save_method(Archive& archive) const {
  std::vector<std::int64_t> tree, path(path_.begin(), path_.end());
  std::vector<double> values;
  for (const Node& node : nodes_) {
    tree.insert(tree.end(), {node.depth, node.child[0], node.child[1]});
    values.insert(values.end(), {node.count, node.sum, node.bound});
  }
  archive.put("tree", tree);
  archive.put("node_values", values);
  archive.put("path", path);
  archive.put("counts", std::vector<std::int64_t>{told_, deepest_, any_ ? 1 : 0});
  archive.put("range", std::vector<double>{lowest_, highest_, range_, best_value_});
  archive.put("best", best_);
}

void OptimisticSearch::load_method(Archive& archive) {
  const auto& tree = archive.get<std::vector<std::int64_t>>("tree");
  const auto count = static_cast<std::int64_t>(tree.size() / 3);
  const std::vector<double> values = load_numbers(archive, "node_values", tree.size());
  const auto& path = archive.get<std::vector<std::int64_t>>("path");
  const auto valid = [&](std::int64_t node, std::int64_t above) { return node > above && node < count; };
  bool sound =
      tree.size() % 3 == 0 && std::all_of(path.begin(), path.end(), [&](auto i) { return valid(i, -1); });
  nodes_.clear();
  for (std::int64_t i = 0; i < count && sound; ++i) {
    const auto at = static_cast<std::size_t>(3 * i);
    nodes_.push_back({tree[at], {tree[at + 1], tree[at + 2]}, values[at], values[at + 1], values[at + 2]});
    sound = tree[at] >= 0 && static_cast<std::size_t>(tree[at]) < variation_.size();
    for (const std::int64_t child : nodes_.back().child) sound = sound && (child == -1 || valid(child, i));
  }
  const auto& counts = archive.get<std::vector<std::int64_t>>("counts");
  const std::vector<double> range = load_numbers(archive, "range", 4);
  if (!sound || counts.size() != 3) throw std::runtime_error("search: the tree of cells is damaged");
  path_.assign(path.begin(), path.end());
  told_ = counts[0];
  deepest_ = counts[1];
  any_ = counts[2] != 0;
  lowest_ = range[0];
  highest_ = range[1];
  range_ = range[2];
  best_value_ = range[3];
  best_ = archive.get<std::vector<double>>("best");
}

std::unique_ptr<Search> Hoo::start(const SearchTask& task) const {
  check_boxed_task(task, "hoo");
  return std::make_unique<OptimisticSearch>(*this, task);
}

const Component<Optimizer, Hoo> kHoo(
    "hoo", "Hierarchical optimistic optimization of a stochastic function: a tree of ever smaller cells.",
    "S. Bubeck, R. Munos, G. Stoltz and C. Szepesvari, JMLR 12 (2011)");

}  // namespace
}  // namespace coppice
