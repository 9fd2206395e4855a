// The maximum of forests over boxes of one to three action axes, against all cells.

#include "solvers/approximators/maximize.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "solvers/approximators/line_maximum.h"
#include "tests/solvers/approximators/random_trees.h"

namespace coppice::testing {
namespace {

constexpr Maximization kExact{Maximization::Method::exact, 1};
constexpr Maximization kAscent{Maximization::Method::ascent, 1};

struct Case {
  std::vector<Tree> trees;
  std::vector<double> prefix;
  Space axes;
  Box box;
};

Case random_case(std::uint64_t trial) {
  Stream stream = Draws(2017, "maximize", 0).stream("trial", trial);
  Case made;
  const std::size_t states = stream.below(3);
  const std::size_t actions = 1 + trial % 3;
  const LeafModel leaf = trial / 3 % 2 == 0 ? LeafModel::constant : LeafModel::linear;
  made.trees.resize(1 + stream.below(5));
  for (Tree& tree : made.trees) tree = random_tree(stream, {states + actions, leaf, actions == 1 ? 6 : 5});
  made.prefix = random_point(stream, random_box(stream, states));
  made.box = random_box(stream, actions);
  for (std::size_t i = 0; i < actions; ++i) made.axes.push_back({"a", "", made.box.low[i], made.box.high[i]});
  return made;
}

/// The mean of the trees' leaves at `in` (which chooses the leaves), taken at x.
double mean_at(const std::vector<Tree>& trees, Aggregation aggregation, const std::vector<double>& in,
               const std::vector<double>& x) {
  if (aggregation == Aggregation::trimmed_mean) {
    std::vector<double> values;
    for (const Tree& tree : trees) values.push_back(value_of_leaf(tree, leaf_at(tree, in), x).value());
    return trimmed_mean(values);
  }
  Prediction sum;
  for (const Tree& tree : trees) {
    const Prediction p = value_of_leaf(tree, leaf_at(tree, in), x);
    sum = {sum.model + p.model, sum.low + p.low, sum.high + p.high};
  }
  return sum.value() / static_cast<double>(trees.size());
}

double largest(const Case& test, Aggregation aggregation = Aggregation::mean) {
  std::vector<Tree> shifted = test.trees;  // cells of the action axes only
  for (Tree& tree : shifted) {
    for (TreeNode& node : tree.nodes) node.feature -= static_cast<std::int32_t>(test.prefix.size());
  }
  std::vector<const Tree*> pointers;
  for (const Tree& tree : shifted) pointers.push_back(&tree);
  double best = -1e300;
  for (const Cell& cell : cells_of(pointers, test.box)) {
    std::vector<double> in = test.prefix;
    in.insert(in.end(), cell.high.begin(), cell.high.end());
    for (std::size_t corner = 0; corner < (1u << test.axes.size()); ++corner) {
      std::vector<double> x = in;
      for (std::size_t i = 0; i < test.axes.size(); ++i) {
        if ((corner >> i & 1) != 0) x[test.prefix.size() + i] = cell.low[i];
      }
      best = std::max(best, mean_at(test.trees, aggregation, in, x));
    }
  }
  return best;
}

double predicted(const Forest& forest, const Case& test, const Maximum& maximum) {
  std::vector<double> x = test.prefix;
  x.insert(x.end(), maximum.at.begin(), maximum.at.end());
  double value = 0;
  forest.predict(x, {&value, 1});
  return value;
}

TEST(Maximize, ExactIsTheLargestOverAllCellsAndIsTakenWhereItSays) {
  for (std::uint64_t trial = 0; trial < 12000; ++trial) {
    const Case test = random_case(trial);
    const Forest forest = forest_of(test.trees);
    const Maximum best = maximize(forest, test.prefix, test.axes, kExact);
    ASSERT_NEAR(best.value, largest(test), 1e-12) << "trial " << trial;
    ASSERT_EQ(best.at.size(), test.axes.size());
    for (std::size_t i = 0; i < test.axes.size(); ++i) {
      ASSERT_TRUE(best.at[i] >= test.axes[i].low && best.at[i] <= test.axes[i].high) << "trial " << trial;
    }
    ASSERT_NEAR(predicted(forest, test, best), best.value, 1e-12) << "trial " << trial;
  }
}

/// As above, with a hundred thousand breaks and numbers whose sums are rounded: no prediction at an end of a
/// piece exceeds the maximum, and the maximum is a prediction.
TEST(Maximize, ExactAlongALineIsTheLargestPredictionAtTheEndsOfItsPieces) {
  for (const LeafModel leaf : {LeafModel::constant, LeafModel::linear}) {
    Stream stream = Draws(2017, "line", 0).stream("trees", leaf == LeafModel::linear ? 1 : 0);
    std::vector<Tree> trees(40);
    for (Tree& tree : trees) {
      tree = random_tree(stream, {2, leaf, 14});
      for (TreeNode& node : tree.nodes) {
        if (node.child == &node - tree.nodes.data()) {
          if (leaf == LeafModel::constant) node.value = stream.uniform(-1, 1);
        } else {
          node.value = static_cast<float>(stream.uniform(-1, 1));
        }
      }
      for (double& number : tree.models) number *= stream.uniform(0.9, 1.1);
      for (std::size_t row = 0; row < tree.models.size(); row += model_width(2)) {
        if (tree.models[row + 3] > tree.models[row + 4])
          std::swap(tree.models[row + 3], tree.models[row + 4]);
      }
    }
    const Forest forest = forest_of(trees);
    const auto value = [&](double state, double action) {
      double y = 0;
      forest.predict(std::array{state, action}, {&y, 1});
      return y;
    };
    for (const double state : {-0.9, -0.3, 0.1, 0.77}) {
      const Maximum best = maximize(forest, {&state, 1}, {{"a", "", -0.95, 0.9}}, kExact);
      EXPECT_EQ(best.value, value(state, best.at[0]));
      double most = std::max(value(state, -0.95), value(state, 0.9));
      for (const Tree& tree : trees) {
        for (const TreeNode& node : tree.nodes) {
          if (node.feature != 1 || node.value < -0.95 || node.value >= 0.9) continue;
          const double above = std::nextafter(node.value, std::numeric_limits<double>::infinity());
          most = std::max({most, value(state, node.value), value(state, above)});
        }
      }
      EXPECT_NEAR(best.value, most, 1e-12) << state;
    }
  }
}

TEST(Maximize, ExactIsTheLargestTrimmedMeanOfConstants) {
  for (std::uint64_t trial = 0; trial < 6000; ++trial) {
    const Case test = random_case(trial);
    if (test.trees[0].leaf == LeafModel::linear) continue;
    Forest forest = forest_of(test.trees);
    forest.aggregate_by(Aggregation::trimmed_mean);
    const Maximum best = maximize(forest, test.prefix, test.axes, kExact);
    ASSERT_NEAR(best.value, largest(test, Aggregation::trimmed_mean), 1e-12) << "trial " << trial;
    ASSERT_NEAR(predicted(forest, test, best), best.value, 1e-12) << "trial " << trial;
  }
}

TEST(Maximize, RefusesTrimmedMeansThatItCannotExpress) {
  for (std::uint64_t trial = 0; trial < 6; ++trial) {
    const Case test = random_case(trial);
    Forest forest = forest_of(test.trees);
    forest.aggregate_by(Aggregation::trimmed_mean);
    EXPECT_THROW(maximize(forest, test.prefix, test.axes, {Maximization::Method::merge, 50}),
                 std::invalid_argument);
    if (test.axes.size() > 1) {
      EXPECT_THROW(maximize(forest, test.prefix, test.axes, kAscent), std::invalid_argument);
    }
    if (forest.leaf() == LeafModel::constant) continue;
    EXPECT_THROW(maximize(forest, test.prefix, test.axes, kExact), std::invalid_argument);
    EXPECT_THROW(maximize(forest, test.prefix, test.axes, kAscent), std::invalid_argument);
  }
}

TEST(Maximize, MergeIsNeverBetterThanExactAndEqualToItWithoutPruning) {
  int worse = 0;
  for (std::uint64_t trial = 0; trial < 6000; ++trial) {
    const Case test = random_case(trial);
    const Forest forest = forest_of(test.trees);
    const Maximum exact = maximize(forest, test.prefix, test.axes, kExact);
    const Maximum whole = maximize(forest, test.prefix, test.axes, {Maximization::Method::merge, 1000000});
    ASSERT_NEAR(whole.value, exact.value, 1e-12) << "trial " << trial;
    ASSERT_NEAR(predicted(forest, test, whole), exact.value, 1e-12) << "trial " << trial;
    const Maximum pruned = maximize(forest, test.prefix, test.axes, {Maximization::Method::merge, 3});
    ASSERT_LE(predicted(forest, test, pruned), exact.value + 1e-12) << "trial " << trial;
    worse += predicted(forest, test, pruned) < exact.value - 1e-6 ? 1 : 0;
  }
  EXPECT_GT(worse, 500) << "three leaves lose something";
}

TEST(Maximize, AscentEndsWhereNoAxisGivesMoreMostlyAtTheMaximum) {
  int largest = 0, several = 0;
  LineMaximum line;
  for (std::uint64_t trial = 0; trial < 6000; ++trial) {
    const Case test = random_case(trial);
    const Forest forest = forest_of(test.trees);
    const Maximum exact = maximize(forest, test.prefix, test.axes, kExact);
    const Maximum found = maximize(forest, test.prefix, test.axes, kAscent);
    ASSERT_EQ(found.value, predicted(forest, test, found)) << "trial " << trial;
    if (test.axes.size() == 1) {
      ASSERT_EQ(found.value, exact.value) << "trial " << trial;
      ASSERT_EQ(found.at[0], exact.at[0]) << "trial " << trial;
      continue;
    }
    std::vector<double> x = test.prefix;
    x.insert(x.end(), found.at.begin(), found.at.end());
    for (std::size_t i = 0; i < test.axes.size(); ++i) {
      ASSERT_TRUE(found.at[i] >= test.axes[i].low && found.at[i] <= test.axes[i].high) << "trial " << trial;
      std::vector<double> moved = x;
      const std::size_t along = test.prefix.size() + i;
      const double most = line.over(forest, moved, along, test.axes[i].low, test.axes[i].high);
      ASSERT_LE(most, found.value + 1e-12) << "trial " << trial;
    }
    ++several;
    largest += found.value > exact.value - 1e-12 ? 1 : 0;
  }
  EXPECT_GT(largest, several * 9 / 10);
}

TEST(Maximize, WithoutActionAxesIsThePredictionByEachMethod) {
  for (std::uint64_t trial = 0; trial < 60; ++trial) {
    const Forest forest = forest_of(random_case(trial).trees);
    const std::vector<double> prefix(forest.inputs(), 0.25);
    double value = 0;
    forest.predict(prefix, {&value, 1});
    using enum Maximization::Method;
    for (const auto method : {merge, exact, ascent}) {
      const Maximum found = maximize(forest, prefix, {}, {method, 50});
      EXPECT_EQ(found.at.size(), 0U);
      EXPECT_NEAR(found.value, value, 1e-12) << "trial " << trial;
    }
  }
}

TEST(Maximize, AscentGoesAlongAxesWithoutAnEnd) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (std::uint64_t trial = 0; trial < 300; ++trial) {
    Case test = random_case(trial);
    if (test.trees[0].leaf == LeafModel::linear) continue;  // has no maximum there
    for (Axis& axis : test.axes) axis = {"a", "", -kInfinity, kInfinity};
    const Forest forest = forest_of(test.trees);
    const Maximum found = maximize(forest, test.prefix, test.axes, kAscent);
    ASSERT_EQ(found.value, predicted(forest, test, found)) << "trial " << trial;
    ASSERT_LE(found.value, maximize(forest, test.prefix, test.axes, kExact).value + 1e-12);
  }
}

TEST(Maximize, RefusesABoxThatDoesNotFit) {
  const Forest forest = forest_of({random_case(0).trees});
  const std::vector<double> prefix(forest.inputs());
  EXPECT_THROW(maximize(forest, prefix, {{"a", "", 0, 1}}, kExact), std::invalid_argument);
}

}  // namespace
}  // namespace coppice::testing
