#include "solvers/approximators/forest_function.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "solvers/approximators/forest_model.h"
#include "solvers/approximators/maximize.h"

namespace coppice {
namespace {

/// Splits on the longest way from the root to a leaf.
std::size_t depth_of(const ForestTree& tree) {
  std::size_t deepest = 0;
  std::vector<std::pair<std::uint32_t, std::size_t>> open{{tree.root, 0}};
  while (!open.empty()) {
    const auto [node, depth] = open.back();
    open.pop_back();
    deepest = std::max(deepest, depth);
    if (tree.is_leaf(node)) continue;
    const std::uint32_t child = node + tree.nodes[node].ahead();
    open.emplace_back(child, depth + 1);
    open.emplace_back(child + 1, depth + 1);
  }
  return deepest;
}

}  // namespace

Maximum ForestFunction::maximize(std::span<const double> prefix, const Space& box,
                                 const Maximization& how) const {
  return coppice::maximize(forest_, prefix, box, how);
}

void ForestFunction::predict_batch(const Matrix& x, Matrix& y) const {
  check_batch(x, y);
  forest_.predict_batch(x, y);
}

std::vector<std::pair<std::string, double>> ForestFunction::facts() const {
  std::size_t deepest = 0;
  std::size_t visits = 0;
  for (std::size_t output = 0; output < forest_.outputs(); ++output) {
    for (std::size_t i = 0; i < forest_.trees(); ++i) {
      const std::size_t depth = depth_of(forest_.tree(output, i));
      deepest = std::max(deepest, depth);
      visits += depth + 1;
    }
  }
  return {{"trees", static_cast<double>(forest_.trees() * forest_.outputs())},
          {"depth", static_cast<double>(deepest)},
          {"visits", static_cast<double>(visits)},
          {"leaves", static_cast<double>(forest_.leaves())}};
}

FunctionModel ForestFunction::exported() const {
  return exported_forest(forest_);
}

namespace {
const Component<Function, ForestFunction> kForestFunction(ForestFunction::kName,
                                                          "The mean of regression trees.",
                                                          "L. Hofer's thesis (2017), 2.1.4", 2);
}  // namespace

}  // namespace coppice
