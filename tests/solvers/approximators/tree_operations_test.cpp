// Projection, weighted average, merge and the best leaf against evaluation point by point, over random trees.

#include "solvers/approximators/tree_operations.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/solvers/approximators/random_trees.h"

namespace coppice::testing {
namespace {

constexpr std::array kModels = {LeafModel::constant, LeafModel::linear};

Stream operations_stream(std::uint64_t trial) {
  return Draws(2017, "tree operations", 0).stream("trial", trial);
}

/// The leaves' part of the box is not empty: low < x <= high, and x in the box.
void expect_all_leaves_are_reached(const Tree& tree, const Box& box, std::int32_t node, Box region) {
  const TreeNode& split = tree.nodes[node];
  if (split.child == node) return;
  const auto axis = static_cast<std::size_t>(split.feature);
  const bool begins = region.low[axis] == box.low[axis];  // then the side itself is in the region
  EXPECT_TRUE(begins ? region.low[axis] <= split.value : region.low[axis] < split.value);
  EXPECT_LT(split.value, region.high[axis]);
  Box low = region, high = region;
  low.high[axis] = high.low[axis] = split.value;
  if (split.value == box.low[axis]) high.low[axis] = std::nextafter(split.value, box.high[axis]);
  expect_all_leaves_are_reached(tree, box, split.child, low);
  expect_all_leaves_are_reached(tree, box, split.child + 1, high);
}

TEST(Projection, IsTheTreeAsAFunctionOfItsLastInputs) {
  Tree projected;
  for (std::uint64_t trial = 0; trial < 10000; ++trial) {
    Stream stream = operations_stream(trial);
    const std::size_t inputs = 1 + stream.below(4);
    const std::size_t fixed = stream.below(inputs + 1);
    const Tree tree = random_tree(stream, {inputs, kModels[trial % 2], 6});
    const Box box = random_box(stream, inputs - fixed);
    const std::vector<double> prefix = random_point(stream, random_box(stream, fixed));
    const Forest forest = forest_of({tree});
    project(forest.tree(0, 0), prefix, box, projected);
    ASSERT_EQ(projected.inputs, inputs - fixed);
    ASSERT_LE(projected.nodes.size(), tree.nodes.size());
    expect_all_leaves_are_reached(projected, box, 0, box);
    for (int i = 0; i < 20; ++i) {
      const std::vector<double> last = random_point(stream, box);
      std::vector<double> x = prefix;
      x.insert(x.end(), last.begin(), last.end());
      ASSERT_EQ(predict(projected, last), predict(tree, x)) << "trial " << trial;
    }
  }
}

TEST(WeightedAverage, IsTheWeightedAverageAtEveryPoint) {
  constexpr std::array<std::array<double, 2>, 5> kWeights = {{{1, 1}, {3, 1}, {1, 7}, {0, 4}, {0.5, 1.5}}};
  Tree average;
  for (std::uint64_t trial = 0; trial < 5000; ++trial) {
    Stream stream = operations_stream(trial);
    const std::size_t inputs = 1 + stream.below(3);
    const Tree a = random_tree(stream, {inputs, kModels[stream.below(2)], 5});
    const Tree b = random_tree(stream, {inputs, kModels[stream.below(2)], 5});
    const std::array<double, 2> weights = kWeights[stream.below(kWeights.size())];
    const double wa = weights[0], wb = weights[1];  // clang 14 captures no structured bindings
    const Box box = random_box(stream, inputs);
    weighted_average(a, b, wa, wb, box, average);
    expect_all_leaves_are_reached(average, box, 0, box);
    for (int i = 0; i < 1000; ++i) {
      const std::vector<double> x = random_point(stream, box);
      const Prediction pa = predict(a, x), pb = predict(b, x);
      const auto mean = [&](double va, double vb) { return (va * wa + vb * wb) / (wa + wb); };
      const Prediction expected = {mean(pa.model, pb.model), mean(pa.low, pb.low), mean(pa.high, pb.high)};
      ASSERT_EQ(predict(average, x), expected) << "trial " << trial;
    }
  }
}

TEST(WeightedAverage, HoldsInAllOfSpace) {
  Tree average;
  for (std::uint64_t trial = 0; trial < 500; ++trial) {
    Stream stream = operations_stream(trial);
    const Tree a = random_tree(stream, {2, LeafModel::constant, 4});
    const Tree b = random_tree(stream, {2, LeafModel::constant, 4});
    weighted_average(a, b, 1, 1, Box::everything(2), average);
    for (int i = 0; i < 20; ++i) {
      const std::array<double, 2> x = {eighth(stream, -1000, 1000), eighth(stream, -2, 2)};
      ASSERT_EQ(predict(average, x).model, (predict(a, x).model + predict(b, x).model) / 2);
    }
  }
}

// Neither child of a repeated split can be reached twice: the average has a leaf for each cell at most.
TEST(WeightedAverage, OfATreeWithItselfHasItsLeaves) {
  Tree average;
  for (std::uint64_t trial = 0; trial < 1000; ++trial) {
    Stream stream = operations_stream(trial);
    const Box box = random_box(stream, 2);
    Tree tree;
    const Forest forest = forest_of({random_tree(stream, {2, LeafModel::constant, 5})});
    project(forest.tree(0, 0), {}, box, tree);  // drops what is never reached
    weighted_average(tree, tree, 2, 1, box, average);
    EXPECT_EQ(average.nodes.size(), tree.nodes.size());
  }
}

TEST(Merge, PrunesEachTreeAndEachAverageInOrder) {
  Tree merged;
  for (std::uint64_t trial = 0; trial < 2000; ++trial) {
    Stream stream = operations_stream(trial);
    const std::size_t inputs = 1 + stream.below(3);
    const LeafModel leaf = kModels[trial % 2];
    std::vector<Tree> trees(1 + stream.below(6));
    for (Tree& tree : trees) tree = random_tree(stream, {inputs, leaf, 5});
    const Box box = random_box(stream, inputs);
    const std::size_t max_leaves = 1 + stream.below(12);
    merge(trees, box, max_leaves, merged);

    Tree expected = trees[0];  // Algorithm 12, line by line
    prune(expected, box, max_leaves);
    for (std::size_t i = 1; i < trees.size(); ++i) {
      Tree next = trees[i];
      prune(next, box, max_leaves);
      Tree average;
      weighted_average(expected, next, static_cast<double>(i), 1, box, average);
      prune(average, box, max_leaves);
      expected = average;
    }
    EXPECT_LE(leaves_of(merged).size(), max_leaves);
    EXPECT_EQ(merged.nodes, expected.nodes);
    EXPECT_EQ(merged.models, expected.models);
  }
}

TEST(Merge, IsTheForestsMeanWhereNothingIsPruned) {
  Tree merged;
  for (std::uint64_t trial = 0; trial < 1000; ++trial) {
    Stream stream = operations_stream(trial);
    std::vector<Tree> trees(1 + stream.below(5));
    for (Tree& tree : trees) tree = random_tree(stream, {2, kModels[trial % 2], 3});
    const Box box = random_box(stream, 2);
    merge(trees, box, 100000, merged);
    for (int i = 0; i < 20; ++i) {
      const std::vector<double> x = random_point(stream, box);
      Prediction sum;
      for (const Tree& tree : trees) {
        const Prediction p = predict(tree, x);
        sum = {sum.model + p.model, sum.low + p.low, sum.high + p.high};
      }
      const auto n = static_cast<double>(trees.size());
      EXPECT_NEAR(predict(merged, x).value(), Prediction({sum.model / n, sum.low / n, sum.high / n}).value(),
                  1e-13);
    }
  }
}

TEST(BestLeaf, IsTheLargestValueOverAllCells) {
  for (std::uint64_t trial = 0; trial < 10000; ++trial) {
    Stream stream = operations_stream(trial);
    const std::size_t inputs = 1 + stream.below(3);
    const Tree tree = random_tree(stream, {inputs, kModels[trial % 2], 5});
    const Box box = random_box(stream, inputs);
    double largest = -1e300;
    for (const Cell& cell : cells_of({&tree}, box)) {
      const std::int32_t leaf = leaf_at(tree, cell.high);
      for (std::size_t corner = 0; corner < (1u << inputs); ++corner) {
        std::vector<double> x = cell.high;
        for (std::size_t i = 0; i < inputs; ++i) x[i] = (corner >> i & 1) != 0 ? cell.low[i] : x[i];
        largest = std::max(largest, value_of_leaf(tree, leaf, x).value());
      }
    }
    const Maximum best = best_leaf(tree, box);
    ASSERT_NEAR(best.value, largest, 1e-12) << "trial " << trial;
    ASSERT_EQ(best.at.size(), inputs);
    for (std::size_t i = 0; i < inputs; ++i) {
      ASSERT_TRUE(best.at[i] >= box.low[i] && best.at[i] <= box.high[i]) << "trial " << trial;
    }
    ASSERT_NEAR(predict(tree, std::span(best.at.begin(), inputs)).value(), best.value, 1e-12)
        << "the best value is not taken at the place that is told; trial " << trial;
  }
}

// Algorithm 14: the centre of a constant leaf; of equal ones the first from the low side.
TEST(BestLeaf, OfAConstantIsTheCentre) {
  Tree tree;
  tree.inputs = 1;
  tree.nodes = {{0.5, 0, 1}, {1, 1, 1}, {0.75, 0, 3}, {2, 1, 3}, {2, 1, 4}};
  EXPECT_EQ(best_leaf(tree, {{-1}, {1}}).at[0], 0.625);
  EXPECT_EQ(best_leaf(tree, {{-1}, {1}}).value, 2);
  EXPECT_EQ(best_leaf(tree, {{-1}, {0.25}}).at[0], -0.375) << "only the part in the box counts";
}

TEST(DropUnused, KeepsTheTreeAndNothingElse) {
  for (std::uint64_t trial = 0; trial < 1000; ++trial) {
    Stream stream = operations_stream(trial);
    Tree tree = random_tree(stream, {2, kModels[trial % 2], 6});
    const Box box = random_box(stream, 2);
    prune(tree, box, 1 + stream.below(6));
    const Tree before = tree;
    drop_unused(tree);
    const std::size_t leaves = leaves_of(before).size();
    ASSERT_EQ(tree.nodes.size(), 2 * leaves - 1);
    ASSERT_EQ(tree.models.size(), tree.leaf == LeafModel::linear ? leaves * model_width(2) : 0);
    for (int i = 0; i < 20; ++i) {
      const std::vector<double> x = random_point(stream, box);
      ASSERT_EQ(predict(tree, x), predict(before, x)) << "trial " << trial;
    }
  }
}

TEST(CountLeaves, CountsThem) {
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    Stream stream = operations_stream(trial);
    const Tree tree = random_tree(stream, {2, LeafModel::constant, 6});
    EXPECT_EQ(count_leaves(tree), leaves_of(tree).size());
  }
}

}  // namespace
}  // namespace coppice::testing
