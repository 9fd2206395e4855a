#include "solvers/approximators/forest_model.h"

namespace coppice {
namespace {

/// Nodes in breadth-first order, children side by side; linear models in the order of their leaves.
ForestModel::Tree exported_tree(const ForestTree& tree) {
  ForestModel::Tree copy;
  std::vector<std::uint32_t> sources = {tree.root};
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const ForestNode& node = tree.nodes[sources[i]];
    if (!tree.is_leaf(sources[i])) {
      copy.nodes.push_back({node.value, node.feature(), static_cast<std::uint32_t>(sources.size())});
      sources.push_back(sources[i] + node.ahead());
      sources.push_back(sources[i] + node.ahead() + 1);
    } else if (tree.leaf == LeafModel::constant) {
      copy.nodes.push_back({node.value, 0, 0});
    } else {
      const std::size_t width = model_width(tree.inputs);
      copy.nodes.push_back({0, static_cast<std::uint32_t>(copy.models.size() / width), 0});
      const double* model = tree.model(sources[i]);
      copy.models.insert(copy.models.end(), model, model + width);
    }
  }
  return copy;
}

}  // namespace

ForestModel exported_forest(const Forest& forest) {
  ForestModel model;
  model.inputs = forest.inputs();
  model.directions = forest.directions().rows();
  model.linear_leaves = forest.leaf() == LeafModel::linear;
  if (forest.aggregation() == Aggregation::trimmed_mean) model.trimmed = trimmed_on_each_side(forest.trees());
  for (std::size_t output = 0; output < forest.outputs(); ++output) {
    ForestModel::Output copy;
    for (std::size_t i = 0; i < forest.trees(); ++i) {
      const ForestTree tree = forest.tree(output, i);
      copy.offset = tree.scale.offset;
      copy.scale = tree.scale.scale;
      copy.trees.push_back(exported_tree(tree));
    }
    model.outputs.push_back(std::move(copy));
  }
  return model;
}

}  // namespace coppice
