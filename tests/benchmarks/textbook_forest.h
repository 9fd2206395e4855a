#pragma once

#include <memory>
#include <span>
#include <vector>

#include "solvers/approximators/forest.h"

namespace coppice {

/// A forest as textbooks write it: nodes on the heap, double precision, a virtual function for what a leaf
/// says. What prediction is compared with.
class TextbookForest {
 public:
  /// A copy of output 0.
  explicit TextbookForest(const Forest& forest) {
    for (std::size_t i = 0; i < forest.trees(); ++i) {
      const ForestTree tree = forest.tree(0, i);
      trees_.push_back(copy(tree, tree.root));
    }
  }

  double predict(std::span<const double> x) const {
    double sum = 0;
    for (const std::unique_ptr<Node>& tree : trees_) {
      const Node* node = tree.get();
      while (node->model == nullptr) node = (x[node->input] <= node->value ? node->low : node->high).get();
      sum += node->model->predict(x);
    }
    return sum / static_cast<double>(trees_.size());
  }

 private:
  struct Model {
    virtual ~Model() = default;
    virtual double predict(std::span<const double> x) const = 0;
  };
  struct Constant : Model {
    double value = 0;
    double predict(std::span<const double>) const override { return value; }
  };
  struct Linear : Model {
    double bias = 0;
    std::vector<double> slopes;
    double predict(std::span<const double> x) const override {
      double value = bias;
      for (std::size_t i = 0; i < x.size(); ++i) value += slopes[i] * x[i];
      return value;
    }
  };
  struct Node {
    std::size_t input = 0;
    double value = 0;
    std::unique_ptr<Node> low;
    std::unique_ptr<Node> high;
    std::unique_ptr<Model> model;
  };

  static std::unique_ptr<Node> copy(const ForestTree& tree, std::uint32_t at) {
    auto node = std::make_unique<Node>();
    const ForestNode& from = tree.nodes[at];
    if (!tree.is_leaf(at)) {
      node->input = from.feature();
      node->value = static_cast<double>(from.value);
      node->low = copy(tree, at + from.ahead());
      node->high = copy(tree, at + from.ahead() + 1);
    } else if (tree.leaf == LeafModel::constant) {
      auto model = std::make_unique<Constant>();
      model->value = tree.constant(at);
      node->model = std::move(model);
    } else {
      auto model = std::make_unique<Linear>();
      model->bias = tree.model(at)[0];
      model->slopes.assign(tree.model(at) + 1, tree.model(at) + 1 + tree.inputs);
      node->model = std::move(model);
    }
    return node;
  }

  std::vector<std::unique_ptr<Node>> trees_;
};

}  // namespace coppice
