// Splits by weighted sums of inputs: trees that have them against evaluation point by point.

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "solvers/approximators/forest_function.h"
#include "solvers/approximators/grow.h"
#include "solvers/approximators/maximize.h"
#include "tests/solvers/approximators/random_trees.h"
#include "tests/support/make.h"
#include "tests/support/threads.h"

namespace coppice::testing {
namespace {

constexpr std::array kLeafModels = {LeafModel::constant, LeafModel::linear};

Stream oblique_stream(std::uint64_t trial) {
  return Draws(2017, "oblique", 0).stream("trial", trial);
}

/// Trees of one table of directions.
std::vector<Tree> random_trees(Stream& stream, std::size_t inputs, LeafModel leaf, std::size_t count) {
  const Directions directions = random_directions(stream, inputs, 1 + stream.below(6));
  std::vector<Tree> trees(count);
  for (Tree& tree : trees) tree = random_tree(stream, {inputs, leaf, 6, &directions});
  return trees;
}

Prediction mean_at(const std::vector<Tree>& trees, std::span<const double> x) {
  Prediction sum;
  for (const Tree& tree : trees) {
    const Prediction p = predict(tree, x);
    sum = {sum.model + p.model, sum.low + p.low, sum.high + p.high};
  }
  return sum;
}

// One call, a batch and the trees themselves agree to the bit, also beside thresholds.
TEST(ObliqueForest, PredictsWhatItsTreesSay) {
  for (std::uint64_t trial = 0; trial < 1000; ++trial) {
    Stream stream = oblique_stream(trial);
    const std::size_t inputs = 1 + stream.below(5);
    const std::vector<Tree> trees =
        random_trees(stream, inputs, kLeafModels[trial % 2], 1 + stream.below(12));
    const Forest forest = forest_of(trees);
    Matrix x(20, inputs), y(20, 1);
    std::vector<double> row(inputs);
    for (std::size_t i = 0; i < x.rows(); ++i) {
      for (double& value : row) value = i % 2 == 0 ? eighth(stream, -2, 2) : stream.uniform(-2, 2);
      x.set_row(i, row);
    }
    forest.predict_batch(x, y);
    for (std::size_t i = 0; i < x.rows(); ++i) {
      for (std::size_t c = 0; c < inputs; ++c) row[c] = x(i, c);
      double value = 0;
      forest.predict(row, {&value, 1});
      ASSERT_EQ(value, y(i, 0)) << "trial " << trial;
      const Prediction sum = mean_at(trees, row);
      ASSERT_NEAR(value, sum.value() / static_cast<double>(trees.size()), 1e-14) << "trial " << trial;
    }
  }
}

TEST(ObliqueForest, IsReadAsItWasWritten) {
  Stream stream = oblique_stream(0);
  const Forest forest = forest_of(random_trees(stream, 3, LeafModel::linear, 5));
  Archive archive;
  forest.save(archive);
  EXPECT_EQ(Forest::load(archive), forest);
  for (const std::size_t size : {0, 3, 4 * 253}) {
    Archive changed = archive;
    changed.put("directions", std::vector<double>(size, 0.5));
    EXPECT_THROW(Forest::load(changed), std::runtime_error) << size << " numbers";
  }
  std::vector<double> rows = forest.directions().rows();
  rows[1] = std::numeric_limits<double>::infinity();
  Archive changed = archive;
  changed.put("directions", rows);
  EXPECT_THROW(Forest::load(changed), std::runtime_error);
}

// Exact in any box, on thresholds as well as between them; with one input left, splits of that input are
// left.
TEST(ObliqueProjection, IsTheTreeAsAFunctionOfItsLastInputs) {
  Tree projected;
  for (std::uint64_t trial = 0; trial < 10000; ++trial) {
    Stream stream = oblique_stream(trial);
    const std::size_t inputs = 1 + stream.below(4);
    const std::size_t fixed = stream.below(inputs + 1);
    const std::vector<Tree> trees = random_trees(stream, inputs, kLeafModels[trial % 2], 1);
    const Box box = random_box(stream, inputs - fixed);
    std::vector<double> x = random_point(stream, random_box(stream, fixed));
    for (double& value : x) value += trial % 3 == 0 ? stream.uniform(-1, 1) : 0;
    const Forest forest = forest_of(trees);
    project(forest.tree(0, 0), x, box, projected);
    ASSERT_LE(projected.nodes.size(), trees[0].nodes.size());
    ASSERT_TRUE(inputs - fixed > 1 || projected.directions.empty());
    for (int i = 0; i < 20; ++i) {
      const std::vector<double> last = random_point(stream, box);
      x.resize(fixed);
      x.insert(x.end(), last.begin(), last.end());
      const Prediction whole = predict(trees[0], x), part = predict(projected, last);
      ASSERT_EQ(part.low, whole.low) << "trial " << trial;
      ASSERT_EQ(part.high, whole.high) << "trial " << trial;
      ASSERT_EQ(part.model, whole.model) << "trial " << trial;
    }
  }
}

// A split of the input that is left lies between neighbouring doubles, just where the rounded sum passes the
// threshold.
TEST(ObliqueProjection, KeepsTheBitsOfPredictions) {
  for (std::uint64_t trial = 0; trial < 2000; ++trial) {
    Stream stream = oblique_stream(trial);
    Tree tree;
    tree.inputs = 2;
    tree.directions = Directions(2);
    double* row = tree.directions.add();
    row[0] = stream.normal() * (trial % 2 == 0 ? 1 : 1e6);
    row[1] = stream.normal();
    row[2] = stream.normal() * (trial % 3 == 0 ? 1 : 1e-3);
    const double state = stream.normal();
    const auto threshold = static_cast<float>(row[0] + row[1] * state + row[2] * stream.uniform(-0.9, 0.9));
    tree.nodes = {{static_cast<double>(threshold), 2, 1}, {0, 3, 1}, {1, 3, 2}};
    const Forest forest = forest_of({tree});
    Tree projected;
    project(forest.tree(0, 0), {&state, 1}, {{-1}, {1}}, projected);
    if (projected.is_leaf(0)) continue;  // rounded to single precision, the threshold is out of reach
    double x = projected.nodes[0].value;
    for (int i = 0; i < 5; ++i) x = std::nextafter(x, -2.0);
    for (int i = 0; i < 10; ++i, x = std::nextafter(x, 2.0)) {
      const std::vector<double> both = {state, x};
      double value = 0;
      forest.predict(both, {&value, 1});
      ASSERT_EQ(predict(projected, {&x, 1}).model, value) << "trial " << trial << ", step " << i;
    }
  }
}

TEST(ObliqueAverage, IsExact) {
  Tree average;
  for (std::uint64_t trial = 0; trial < 2000; ++trial) {
    Stream stream = oblique_stream(trial);
    const std::size_t inputs = 1 + stream.below(3);
    std::vector<Tree> trees = random_trees(stream, inputs, kLeafModels[trial % 2], 2);
    if (trial % 4 < 2)
      trees[1] = random_trees(stream, inputs, kLeafModels[trial / 4 % 2], 1)[0];  // other table
    const Box box = random_box(stream, inputs);
    weighted_average(trees[0], trees[1], 3, 1, box, average);
    for (int i = 0; i < 50; ++i) {
      const std::vector<double> x = random_point(stream, box);
      const Prediction a = predict(trees[0], x), b = predict(trees[1], x), mean = predict(average, x);
      ASSERT_NEAR(mean.model, (3 * a.model + b.model) / 4, 1e-12) << "trial " << trial;
      ASSERT_NEAR(mean.low, (3 * a.low + b.low) / 4, 1e-12) << "trial " << trial;
      ASSERT_NEAR(mean.high, (3 * a.high + b.high) / 4, 1e-12) << "trial " << trial;
    }
  }
}

/// Where a forest of these trees may change along its last input: splits of it, and both sides of where
/// directions cross their thresholds.
std::vector<double> places(const std::vector<Tree>& trees, const std::vector<double>& prefix, double low,
                           double high) {
  std::vector<double> found = {low, high};
  for (const Tree& tree : trees) {
    for (const TreeNode& node : tree.nodes) {
      const auto feature = static_cast<std::size_t>(node.feature);
      double at = node.value;
      if (feature > prefix.size() && feature < tree.features()) {
        std::vector<double> x = prefix;
        x.push_back(0);
        const std::size_t j = feature - tree.inputs;
        at = (node.value - tree.directions.value(j, x.data())) / tree.directions.weights(j)[prefix.size()];
      }
      const auto add = [&](double x) {
        if (x >= low && x <= high) found.push_back(x);
      };
      add(at - 1e-12);
      add(at + 1e-12);
      for (int i = 0; i < 4; ++i) at = std::nextafter(at, -9.0);
      for (int i = 0; i < 8; ++i, at = std::nextafter(at, 9.0)) add(at);  // where rounding decides
    }
  }
  return found;
}

TEST(ObliqueMaximum, OfOneFreeInputIsTheLargestValue) {
  for (std::uint64_t trial = 0; trial < 3000; ++trial) {
    Stream stream = oblique_stream(trial);
    const std::vector<double> prefix = random_point(stream, random_box(stream, 1 + stream.below(2)));
    const LeafModel leaf = kLeafModels[trial % 2];
    const std::vector<Tree> trees = random_trees(stream, prefix.size() + 1, leaf, 1 + stream.below(4));
    const Box box = random_box(stream, 1);
    const Space axis = {{"a", "", box.low[0], box.high[0]}};
    const Forest forest = forest_of(trees);
    const auto value_at = [&](double a) {
      std::vector<double> x = prefix;
      x.push_back(a);
      double value = 0;
      forest.predict(x, {&value, 1});
      return value;
    };
    double largest = -1e300;
    for (const double a : places(trees, prefix, box.low[0], box.high[0]))
      largest = std::max(largest, value_at(a));
    const Maximum exact = maximize(forest, prefix, axis, {Maximization::Method::exact, 1});
    ASSERT_NEAR(exact.value, largest, 1e-9) << "trial " << trial;
    ASSERT_NEAR(value_at(exact.at[0]), largest, 1e-9) << "trial " << trial;
    const Maximum merged = maximize(forest, prefix, axis, {Maximization::Method::merge, 100000});
    ASSERT_NEAR(value_at(merged.at[0]), largest, 1e-9) << "trial " << trial;
  }
}

TEST(ObliqueTree, OfSeveralInputsIsNeitherPrunedNorMaximized) {
  Stream stream = oblique_stream(1);
  Tree tree;
  tree.inputs = 2;
  tree.directions = random_directions(stream, 2, 1);
  double* row = tree.directions.add();
  row[1] = row[2] = 1;
  tree.nodes = {{0.5, 3, 1}, {0.25, 0, 3}, {1, 4, 2}, {2, 4, 3}, {3, 4, 4}};
  const Box box = {{-1, -1}, {1, 1}};
  prune(tree, box, 3);  // as it is
  EXPECT_EQ(count_leaves(tree), 3u);
  EXPECT_THROW(prune(tree, box, 2), std::invalid_argument);
  const Forest forest = forest_of({tree});
  const Space axes(2, {"a", "", -1, 1});
  using enum Maximization::Method;
  for (const auto method : {exact, merge, ascent}) {
    try {
      maximize(forest, {}, axes, {method, 50});
      FAIL();
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("valid are axis-aligned splits"), std::string::npos);
    }
  }
}

struct WaveSamples {
  Matrix x, y;
};

/// A wave along the diagonal of the unit cube: smooth, and flat in all other directions.
WaveSamples rotated_wave(std::size_t inputs, std::size_t rows, std::uint64_t seed, double noise) {
  WaveSamples samples{Matrix(rows, inputs), Matrix(rows, 1)};
  Stream stream = Draws(2017, "wave", 0).stream("samples", seed);
  for (std::size_t i = 0; i < rows; ++i) {
    double along = 0;
    for (std::size_t c = 0; c < inputs; ++c) {
      samples.x(i, c) = stream.uniform(-1, 1);
      along += samples.x(i, c) * (c % 2 == 0 ? 1 : -1) / std::sqrt(static_cast<double>(inputs));
    }
    samples.y(i, 0) = std::sin(5 * along) + noise * stream.normal();
  }
  return samples;
}

MadeFunction fit(const std::string& xml, const WaveSamples& samples, Parallel& parallel) {
  return make_from_xml<Approximator>(xml)->fit({samples.x, samples.y, {}}, Draws(5, "fit", 0), parallel);
}
MadeFunction fit(const std::string& xml, const WaveSamples& samples) {
  Serial serial;
  return fit(xml, samples, serial);
}

double test_error(const MadeFunction& function, const WaveSamples& test) {
  Matrix predicted(test.x.rows(), 1);
  function->predict_batch(test.x, predicted);
  double sum = 0;
  for (std::size_t i = 0; i < test.x.rows(); ++i) {
    const double error = predicted(i, 0) - test.y(i, 0);
    sum += error * error;
  }
  return std::sqrt(sum / static_cast<double>(test.x.rows()));
}

const Forest& forest_in(const MadeFunction& function) {
  return dynamic_cast<const ForestFunction&>(*function.object).forest();
}

// Leaves hold at least n_min samples, and n / n_min of them at most: about as many in both forests.
TEST(ObliqueGrowth, FitsRotatedFunctionsBetterThanAxisAlignedSplits) {
  for (const std::size_t inputs : {2, 4}) {
    const WaveSamples samples = rotated_wave(inputs, 4000, 1, 0.1), test = rotated_wave(inputs, 4000, 2, 0);
    for (const std::string leaves : {"leaves=\"pwc\" n_min=\"10\"", "leaves=\"pwl\" n_min=\"40\""}) {
      const MadeFunction axis = fit("<extra_trees " + leaves + "/>", samples);
      const MadeFunction oblique = fit("<extra_trees splits=\"oblique\" " + leaves + "/>", samples);
      EXPECT_LE(forest_in(oblique).leaves(), forest_in(axis).leaves() * 21 / 20);
      EXPECT_LT(test_error(oblique, test), 0.9 * test_error(axis, test)) << inputs << " inputs, " << leaves;
    }
  }
}

TEST(ObliqueGrowth, GivesTheSameBitsWithAllKernelsAndThreads) {
  const WaveSamples samples = rotated_wave(5, 3000, 3, 0.2);
  std::vector<double> weights;
  for (std::size_t i = 0; i < 3000; ++i) weights.push_back(static_cast<double>(i % 4));
  for (const bool weighted : {false, true}) {
    for (const LeafModel leaf : kLeafModels) {
      Growth growth;
      growth.leaf = leaf;
      growth.candidates = 7;
      growth.directions = 12;
      growth.min_samples = leaf == LeafModel::constant ? 1 : 20;
      const TrainingSet set{samples.x, samples.y,
                            weighted ? std::span<const double>(weights) : std::span<double>()};
      Serial serial;
      const Forest first =
          grow_forest(set, growth, 3, Draws(1, "kernels", 0), serial, portable_tree_kernels());
      ASSERT_EQ(first.directions().size(), 12u);
      Threads threads(4);
      for (const TreeKernels* kernels : usable_tree_kernels())
        EXPECT_EQ(grow_forest(set, growth, 3, Draws(1, "kernels", 0), threads, *kernels), first)
            << kernels->name;
    }
  }
}

// Every leaf, for both kinds of splits, by sending the samples down.
TEST(ObliqueGrowth, KeepsSamplesInEachLeaf) {
  const WaveSamples samples = rotated_wave(3, 1000, 4, 0.2);
  const Forest forest = forest_in(fit("<extra_trees trees=\"5\" splits=\"oblique\" n_min=\"7\"/>", samples));
  std::size_t oblique = 0;
  for (std::size_t t = 0; t < forest.trees(); ++t) {
    const Tree tree = unpacked(forest.tree(0, t));
    std::vector<std::size_t> counts(tree.nodes.size());
    for (std::size_t i = 0; i < samples.x.rows(); ++i) {
      const std::vector<double> x = {samples.x(i, 0), samples.x(i, 1), samples.x(i, 2)};
      ++counts[static_cast<std::size_t>(leaf_at(tree, x))];
    }
    for (const std::int32_t leaf : leaves_of(tree)) EXPECT_GE(counts[static_cast<std::size_t>(leaf)], 7u);
    for (const TreeNode& node : tree.nodes) oblique += node.feature >= 3 && node.feature < 51 ? 1 : 0;
  }
  EXPECT_GT(oblique, 100u);
}

// Units do not matter: directions are of standardized inputs, rounding apart.
TEST(ObliqueGrowth, DrawsDirectionsOfStandardizedInputs) {
  WaveSamples samples = rotated_wave(3, 2000, 5, 0);
  for (std::size_t i = 0; i < samples.x.rows(); ++i) {
    samples.x(i, 1) = 1e6 + 1e3 * samples.x(i, 1);
    samples.x(i, 2) = 4;  // does not vary
  }
  const Directions directions = draw_directions({samples.x, samples.y, {}}, 50, Draws(1, "directions", 0));
  ASSERT_EQ(directions.size(), 50u);
  double share = 0;
  for (std::size_t j = 0; j < directions.size(); ++j) {
    EXPECT_EQ(directions.weights(j)[2], 0);
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < samples.x.rows(); ++i) {
      const std::vector<double> x = {samples.x(i, 0), samples.x(i, 1), samples.x(i, 2)};
      const double value = directions.value(j, x.data());
      sum += value / 2000;
      squares += value * value / 2000;
    }
    EXPECT_NEAR(sum, 0, 1e-6);
    EXPECT_NEAR(squares, 1, 0.1);
    share += std::pow(directions.weights(j)[0] / std::sqrt(3.0), 2) / 50;  // deviation 1 / sqrt(3)
  }
  EXPECT_NEAR(share, 0.5, 0.2) << "half of the squared length, on average";
}

TEST(ObliqueGrowth, RefusesDirectionsThatTreesCannotHold) {
  EXPECT_ANY_THROW(make_from_xml<Approximator>("<extra_trees directions=\"5\"/>"));
  const WaveSamples samples = rotated_wave(2, 50, 6, 0);
  EXPECT_THROW(fit("<extra_trees splits=\"oblique\" directions=\"254\"/>", samples), std::invalid_argument);
  EXPECT_EQ(forest_in(fit("<extra_trees splits=\"oblique\" directions=\"253\"/>", samples)).features(), 255u);
  EXPECT_TRUE(
      forest_in(fit("<extra_trees splits=\"oblique\"/>", rotated_wave(1, 50, 7, 0))).directions().empty())
      << "one input has no other direction";
}

// With as many leaves as it takes, merging is exact: it need not prune.
TEST(ObliqueTree, IsMergedWhereNothingIsPruned) {
  const WaveSamples samples = rotated_wave(2, 60, 8, 0.1), test = rotated_wave(2, 500, 9, 0);
  const std::string trees = "<extra_trees trees=\"3\" splits=\"oblique\" n_min=\"10\"/>";
  const MadeFunction forest = fit(trees, samples);
  const MadeFunction merged = fit("<merged_tree max_leaves=\"100000\">" + trees + "</merged_tree>", samples);
  EXPECT_EQ(forest_in(merged).trees(), 1u);
  for (std::size_t i = 0; i < test.x.rows(); ++i) {
    const std::vector<double> x = {0.9 * test.x(i, 0), 0.9 * test.x(i, 1)};
    double a = 0, b = 0;
    forest->predict(x, {&a, 1});
    merged->predict(x, {&b, 1});
    EXPECT_NEAR(a, b, 1e-6);
  }
  EXPECT_THROW(fit("<merged_tree max_leaves=\"10\">" + trees + "</merged_tree>", samples),
               std::invalid_argument);
}

}  // namespace
}  // namespace coppice::testing
