#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "solvers/approximators/forest_function.h"
#include "solvers/approximators/tree_operations.h"

namespace coppice {
namespace {

/// A forest merged into one tree for each output (thesis, 2.1.7 to 2.1.9).
class MergedTree : public Approximator {
 public:
  static constexpr const char* kExample = "<merged_tree max_leaves=\"200\"><extra_trees/></merged_tree>";

  int max_leaves = 1000;
  Sub<Approximator> forest;

  /// Over the range of the samples, outside of which nothing was learned.
  MadeFunction fit(const TrainingSet& set, const Draws& draws, Parallel& parallel) const override {
    const MadeFunction fitted = forest->fit(set, draws, parallel);
    const auto* made_of = dynamic_cast<const ForestFunction*>(fitted.object.get());
    if (made_of == nullptr) {
      throw std::invalid_argument(
          fmt::format("only forests can be merged into a tree, and <{}> makes none", forest.resolved.name));
    }
    if (made_of->forest().aggregation() != Aggregation::mean) {
      throw std::invalid_argument(
          "trees cannot be merged to their trimmed mean; choose the mean as aggregation");
    }
    return made<Function>(ForestFunction(merged(made_of->forest(), range(set.x))), ForestFunction::kName);
  }

  /// What cannot be maximized over several inputs by merging cannot be merged.
  void check_maximization(const Maximization&, std::size_t free_inputs) const override {
    forest->check_maximization({Maximization::Method::merge, max_leaves}, free_inputs + 1);
  }

  static Parameters<MergedTree> parameters() {
    using This = MergedTree;
    return Parameters<This>()
        .add("max_leaves", &This::max_leaves, "",
             "Leaves of the tree at most; with fewer than merging gives, it is pruned as it grows.",
             between(1, 10000000))
        .direct(&This::forest, "What makes the forest.");
  }

 private:
  static Box range(const Matrix& x) {
    Box box;
    for (std::size_t c = 0; c < x.columns(); ++c) {
      const auto [least, most] = std::minmax_element(x.column(c).begin(), x.column(c).end());
      box.low.push_back(*least);
      box.high.push_back(*most);
    }
    return box;
  }

  Forest merged(const Forest& from, const Box& box) const {
    std::vector<Tree> trees(from.trees());
    std::vector<Tree> results(from.outputs());
    std::vector<OutputScale> scales(from.outputs());
    for (std::size_t output = 0; output < from.outputs(); ++output) {
      for (std::size_t i = 0; i < trees.size(); ++i) project(from.tree(output, i), {}, box, trees[i]);
      merge(trees, box, static_cast<std::size_t>(max_leaves), results[output]);
      drop_unused(results[output]);
      if (from.leaf() == LeafModel::constant) scales[output] = scale_constants(results[output]);
    }
    Forest result(from.inputs(), scales, from.leaf(), results[0].directions);
    for (const Tree& tree : results) result.add(pack(tree));
    return result;
  }

  /// Forests hold constants in single precision, in units of how much they vary.
  static OutputScale scale_constants(Tree& tree) {
    ValueRange values;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
      if (tree.is_leaf(static_cast<std::int32_t>(i))) values.include(tree.nodes[i].value);
    }
    const OutputScale scale = values.scale();
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
      TreeNode& node = tree.nodes[i];
      if (tree.is_leaf(static_cast<std::int32_t>(i)))
        node.value = static_cast<double>(scale.packed(node.value));
    }
    return scale;
  }
};

const Component<Approximator, MergedTree> kMergedTree(
    "merged_tree", "A forest merged into a single tree of a bounded number of leaves.",
    "L. Hofer's thesis (2017), Algorithms 9 to 12, Fig. 2.3");

}  // namespace
}  // namespace coppice
