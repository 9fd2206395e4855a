// Pruning against the integral of Eq. 2.9 over all cells, over random trees.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/solvers/approximators/random_trees.h"

namespace coppice::testing {
namespace {

Stream prune_stream(std::uint64_t trial) {
  return Draws(2017, "prune", 0).stream("trial", trial);
}

/// Volume of a cell over the axes on which the box has any width.
double volume(const Cell& cell, const Box& box) {
  double volume = 1;
  for (std::size_t i = 0; i < box.low.size(); ++i) {
    if (box.high[i] > box.low[i]) volume *= (cell.high[i] - cell.low[i]) / (box.high[i] - box.low[i]);
  }
  return volume;
}

/// Mean of |m + sum_i r_i u_i| over u in [-1, 1]^n, exactly: differences of the n-th integral of |z|.
double mean_absolute(double m, std::vector<double> reach) {
  std::erase_if(reach, [](double r) { return r < 1e-9; });
  const std::size_t n = reach.size();
  double sum = 0;
  for (std::size_t corner = 0; corner < (1u << n); ++corner) {
    double z = m, sign = 1;
    for (std::size_t i = 0; i < n; ++i) {
      const bool low = (corner >> i & 1) != 0;
      z += low ? -reach[i] : reach[i];
      sign *= low ? -1 : 1;
    }
    sum += sign * std::pow(std::fabs(z), static_cast<double>(n + 1)) * (n % 2 == 1 && z < 0 ? -1.0 : 1.0);
  }
  for (std::size_t i = 0; i < n; ++i) sum /= 2 * reach[i] * static_cast<double>(i + 1);
  return n == 0 ? std::fabs(m) : sum / static_cast<double>(n + 1);
}

/// The integral of |a - b| over the box, by cells of both.
double loss(const Tree& a, const Tree& b, const Box& box) {
  double sum = 0;
  for (const Cell& cell : cells_of({&a, &b}, box)) {
    const double part = volume(cell, box);
    if (part == 0) continue;
    const std::int32_t la = leaf_at(a, cell.high), lb = leaf_at(b, cell.high);
    std::vector<double> centre, reach;
    for (std::size_t i = 0; i < cell.low.size(); ++i) {
      centre.push_back((cell.low[i] + cell.high[i]) / 2);
    }
    const double m = value_of_leaf(a, la, centre).model - value_of_leaf(b, lb, centre).model;
    for (std::size_t i = 0; i < cell.low.size() && a.leaf == LeafModel::linear; ++i) {
      const double* slopes_a = a.models.data() + static_cast<std::size_t>(a.nodes[la].value) * (a.inputs + 3);
      const double* slopes_b = b.models.data() + static_cast<std::size_t>(b.nodes[lb].value) * (b.inputs + 3);
      reach.push_back(std::fabs(slopes_a[1 + i] - slopes_b[1 + i]) * (cell.high[i] - cell.low[i]) / 2);
    }
    sum += part * mean_absolute(m, reach);
  }
  return sum;
}

/// Volume of the part of the box that leads to a node.
double volume_of_node(const Tree& tree, std::int32_t node, const Box& box) {
  Tree marked = tree;  // which cells pass through the node: mark the leaves below
  double sum = 0;
  const std::vector<std::int32_t> below = leaves_of(tree, node);
  for (const Cell& cell : cells_of({&marked}, box)) {
    const std::int32_t leaf = leaf_at(tree, cell.high);
    if (std::find(below.begin(), below.end(), leaf) != below.end()) sum += volume(cell, box);
  }
  return sum;
}

/// The tree with the preleaf replaced by the mean of its leaves by volume (Algorithm 10, line 8).
Tree without(const Tree& tree, std::int32_t preleaf, const Box& box) {
  Tree out = tree;
  const std::int32_t child = tree.nodes[preleaf].child;
  const double low = volume_of_node(tree, child, box), high = volume_of_node(tree, child + 1, box);
  const double w = low + high > 0 ? low / (low + high) : 0.5;
  double value = w * tree.nodes[child].value + (1 - w) * tree.nodes[child + 1].value;
  if (tree.leaf == LeafModel::linear) {
    const std::size_t width = tree.inputs + 3;
    const auto a = static_cast<std::size_t>(tree.nodes[child].value) * width;
    const auto b = static_cast<std::size_t>(tree.nodes[child + 1].value) * width;
    value = static_cast<double>(tree.models.size() / width);
    for (std::size_t i = 0; i < width; ++i) {
      out.models.push_back(w * tree.models[a + i] + (1 - w) * tree.models[b + i]);
    }
  }
  out.nodes[preleaf] = {value, static_cast<std::int32_t>(tree.inputs), preleaf};
  return out;
}

std::vector<std::int32_t> preleaves_of(const Tree& tree, std::int32_t node = 0) {
  const std::int32_t child = tree.nodes[node].child;
  if (child == node) return {};
  std::vector<std::int32_t> all = preleaves_of(tree, child);
  for (const std::int32_t other : preleaves_of(tree, child + 1)) all.push_back(other);
  if (all.empty()) all.push_back(node);  // both children are leaves
  return all;
}

/// Prunes leaf after leaf; each step loses no more than the best replacement of a preleaf, times `slack`.
void expect_greedy(Tree tree, const Box& box, double slack, std::uint64_t trial) {
  for (std::size_t leaves = leaves_of(tree).size(); leaves > 1; --leaves) {
    double least = 1e300;
    for (const std::int32_t preleaf : preleaves_of(tree)) {
      least = std::min(least, loss(tree, without(tree, preleaf, box), box));
    }
    const Tree before = tree;
    prune(tree, box, leaves - 1);
    ASSERT_EQ(leaves_of(tree).size(), leaves - 1);
    const double lost = loss(before, tree, box);
    ASSERT_LE(lost, least * slack + 1e-12) << "trial " << trial << ", " << leaves << " leaves";
    ASSERT_GE(lost, least - 1e-12) << "no replacement by a mean loses less; trial " << trial;
  }
}

TEST(Prune, TakesTheLeastLossOfEq29AtEachStep) {
  for (std::uint64_t trial = 0; trial < 10000; ++trial) {
    Stream stream = prune_stream(trial);
    const std::size_t inputs = 1 + stream.below(3);
    const Tree tree = random_tree(stream, {inputs, LeafModel::constant, 4});
    expect_greedy(tree, random_box(stream, inputs), 1, trial);
    if (HasFatalFailure()) return;
  }
}

TEST(Prune, TakesTheLeastLossOfLinearLeavesToo) {
  for (std::uint64_t trial = 0; trial < 2000; ++trial) {
    Stream stream = prune_stream(trial);
    const std::size_t inputs = 1 + trial % 3;
    const Tree tree = random_tree(stream, {inputs, LeafModel::linear, 4});
    // Along one axis the loss is exact; along the others by quadrature.
    expect_greedy(tree, random_box(stream, inputs), inputs == 1 ? 1 : 1.05, trial);
    if (HasFatalFailure()) return;
  }
}

TEST(Prune, InOneGoGivesWhatStepsGiveAndNeverMoreLeavesThanAsked) {
  for (std::uint64_t trial = 0; trial < 10000; ++trial) {
    Stream stream = prune_stream(trial);
    const std::size_t inputs = 1 + stream.below(4);
    const LeafModel leaf = trial % 2 == 0 ? LeafModel::constant : LeafModel::linear;
    Tree tree = random_tree(stream, {inputs, leaf, 7});
    const Box box = random_box(stream, inputs);
    const std::size_t leaves = leaves_of(tree).size();
    const std::size_t max_leaves = 1 + stream.below(leaves + 2);
    Tree steps = tree;
    for (std::size_t n = leaves; n-- > max_leaves;) prune(steps, box, n);
    prune(tree, box, max_leaves);
    ASSERT_EQ(leaves_of(tree).size(), std::min(leaves, max_leaves));
    for (int i = 0; i < 5; ++i) {
      const std::vector<double> x = random_point(stream, box);
      ASSERT_EQ(predict(tree, x), predict(steps, x)) << "trial " << trial;
    }
  }
}

TEST(Prune, KeepsATreeThatIsSmallEnough) {
  Stream stream = prune_stream(1);
  const Tree tree = random_tree(stream, {2, LeafModel::linear, 5});
  Tree pruned = tree;
  prune(pruned, {{-1, -1}, {1, 1}}, leaves_of(tree).size());
  EXPECT_EQ(pruned.nodes, tree.nodes);
  EXPECT_EQ(pruned.models, tree.models);
}

// As of a projected tree: sides without width do not make all volumes, and so all losses, 0.
TEST(Prune, CountsVolumesOverFreeAxesOnly) {
  Tree tree;  // x1: 0 below -1/2, 1 below 1/2, 0 below 3/4, then 2
  tree.inputs = 2;
  tree.nodes = {{0.5, 1, 1}, {-0.5, 1, 3}, {0.75, 1, 5}, {0, 2, 3}, {1, 2, 4}, {0, 2, 5}, {2, 2, 6}};
  const Box box = {{0, -1}, {0, 1}};  // x0 = 0
  const auto at = [&](double x1) { return predict(tree, std::vector<double>{0, x1}).model; };
  prune(tree, box, 3);  // losses: 1/3 of half the box on the left, 1/4 on the right
  EXPECT_EQ(at(-1), 0);
  EXPECT_EQ(at(0), 1);
  EXPECT_EQ(at(0.6), 1);
  EXPECT_EQ(at(1), 1);
  prune(tree, box, 2);
  EXPECT_DOUBLE_EQ(at(-1), 2.0 / 3) << "weights by volume";
  EXPECT_DOUBLE_EQ(at(0), 2.0 / 3);
  EXPECT_EQ(at(1), 1);
}

}  // namespace
}  // namespace coppice::testing
