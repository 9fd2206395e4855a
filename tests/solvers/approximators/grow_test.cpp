#include "solvers/approximators/grow.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/solvers/approximators/random_trees.h"
#include "tests/support/threads.h"

namespace coppice::testing {
namespace {

const Draws kGrowDraws(2017, "grow", 0);

struct GrowSamples {
  Matrix x, y;
  std::vector<double> weights;
  GrowSamples(std::size_t rows, std::size_t inputs) : x(rows, inputs), y(rows, 1) {}
  TrainingSet set() const { return {x, y, weights}; }
};

/// Rows of noise; inputs on a grid of `levels` values (0: continuous), many of them equal.
GrowSamples random_samples(Stream& stream, std::size_t rows, std::size_t inputs, std::uint64_t levels) {
  GrowSamples samples(rows, inputs);
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t c = 0; c < inputs; ++c) {
      samples.x(i, c) =
          levels == 0 ? stream.uniform(-1, 1) : static_cast<double>(stream.below(levels)) / 4 - 1;
    }
    samples.y(i, 0) = stream.normal() + samples.x(i, 0);
  }
  return samples;
}

Forest grow(const GrowSamples& samples, const Growth& growth, std::size_t trees, const Draws& draws,
            const TreeKernels& kernels = tree_kernels()) {
  Serial serial;
  return grow_forest(samples.set(), growth, trees, draws, serial, kernels);
}

/// The tree of draws number `seed`.
Tree grow_tree(const GrowSamples& samples, const Growth& growth, std::uint64_t seed) {
  return unpacked(grow(samples, growth, 1, kGrowDraws.fork("tree", seed)).tree(0, 0));
}

/// The rows that a node is made of.
using Rows = std::vector<std::size_t>;

/// Calls visit(node, rows) for each node of the tree.
template <class Visit>
void for_each_node(const Tree& tree, const GrowSamples& samples, std::int32_t node, const Rows& rows,
                   const Visit& visit) {
  visit(node, rows);
  const TreeNode& split = tree.nodes[node];
  if (split.child == node) return;
  Rows low, high;
  for (const std::size_t row : rows) {
    (samples.x(row, static_cast<std::size_t>(split.feature)) <= split.value ? low : high).push_back(row);
  }
  for_each_node(tree, samples, split.child, low, visit);
  for_each_node(tree, samples, split.child + 1, high, visit);
}

Rows all_rows(const GrowSamples& samples) {
  Rows rows;
  for (std::size_t i = 0; i < samples.x.rows(); ++i) rows.push_back(i);
  return rows;
}

/// The n-th smallest and the n-th largest value of a column.
std::pair<double, double> order_statistics(const Matrix& x, std::size_t column, const Rows& rows,
                                           std::size_t n) {
  std::vector<double> values;
  for (const std::size_t row : rows) values.push_back(x(row, column));
  std::sort(values.begin(), values.end());
  return {values[n - 1], values[values.size() - n]};
}

double variance(const GrowSamples& samples, const Rows& rows) {
  double mean = 0, sum = 0;
  for (const std::size_t row : rows) mean += samples.y(row, 0) / static_cast<double>(rows.size());
  for (const std::size_t row : rows) sum += std::pow(samples.y(row, 0) - mean, 2);
  return sum / static_cast<double>(rows.size());
}

TEST(Grow, KeepsTheRulesOfAlgorithm6AtEachNode) {
  for (std::uint64_t trial = 0; trial < 400; ++trial) {
    Stream stream = kGrowDraws.stream("rules", trial);
    const std::size_t inputs = 1 + stream.below(4);
    const std::uint64_t levels = stream.below(3) * 3;
    const GrowSamples samples = random_samples(stream, 1 + stream.below(300), inputs, levels);
    Growth growth;
    growth.leaf = trial % 2 == 0 ? LeafModel::constant : LeafModel::linear;
    growth.candidates = inputs;
    growth.min_samples = 1 + stream.below(12);
    growth.min_variance = trial % 3 == 0 ? 0.5 : 0;
    const std::size_t n = growth.min_samples;
    const Tree tree = grow_tree(samples, growth, trial);
    for_each_node(tree, samples, 0, all_rows(samples), [&](std::int32_t node, const Rows& rows) {
      const TreeNode& split = tree.nodes[node];
      const double spread = variance(samples, rows);
      if (split.child == node) {  // a leaf for a reason
        EXPECT_TRUE(rows.size() >= n || node == 0);
        if (rows.size() < 2 * n || spread <= growth.min_variance + 1e-6) return;
        for (std::size_t c = 0; c < inputs; ++c) {
          const auto [low, high] = order_statistics(samples.x, c, rows, n);
          EXPECT_GE(low, high) << "axis " << c << " could have been split; trial " << trial;
        }
        return;
      }
      EXPECT_GE(rows.size(), 2 * n);
      EXPECT_GT(spread, growth.min_variance - 1e-6);
      const auto [low, high] = order_statistics(samples.x, static_cast<std::size_t>(split.feature), rows, n);
      EXPECT_TRUE(split.value >= low && split.value < high) << "trial " << trial;
    });
  }
}

/// Kolmogorov-Smirnov: the largest distance of the values' distribution from the uniform one on [low, high),
/// times the root of their number.
double kolmogorov(std::vector<double> values, double low, double high) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double distance = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double u = (values[i] - low) / (high - low);
    distance = std::max({distance, static_cast<double>(i + 1) / n - u, u - static_cast<double>(i) / n});
  }
  return distance * std::sqrt(n);
}

TEST(Grow, ThresholdsAreUniformBetweenTheOrderStatistics) {
  constexpr std::size_t kMinSamples = 20;
  enum Data { spread_out, outliers, tied };
  for (const Data data : {spread_out, outliers, tied}) {
    GrowSamples samples(300, 1);
    Stream stream = kGrowDraws.stream("thresholds", static_cast<std::uint64_t>(data));
    for (std::size_t i = 0; i < 300; ++i) {
      const double u = stream.uniform(-1, 1);
      samples.x(i, 0) = data == spread_out ? u * u * u : data == tied ? std::round(4 * u) : u;
      // So far out that nearly all first draws leave too few samples on one side.
      if (data == outliers && i < 15) samples.x(i, 0) = std::pow(2.0, 10 + 2 * static_cast<double>(i));
      samples.y(i, 0) = stream.normal();
    }
    const auto [low, high] = order_statistics(samples.x, 0, all_rows(samples), kMinSamples);
    std::vector<double> thresholds;
    for (std::uint64_t tree = 0; tree < 4000; ++tree) {
      const Tree grown = grow_tree(samples, {.min_samples = kMinSamples, .min_variance = 0.3}, tree);
      ASSERT_NE(grown.nodes[0].child, 0);
      thresholds.push_back(grown.nodes[0].value);
    }
    EXPECT_LT(kolmogorov(thresholds, low, high), 1.95) << "one in a thousand is larger; data " << data;
    EXPECT_GT(kolmogorov(thresholds, low, high * 1.1 - 0.1 * low), 1.95) << "the test sees 10 %";
  }
}

// Output depends on input 1 alone, which wins whenever it is among the k candidates.
TEST(Grow, TriesKDistinctDimensions) {
  Stream stream = kGrowDraws.stream("candidates");
  GrowSamples samples = random_samples(stream, 200, 4, 0);
  for (std::size_t i = 0; i < 200; ++i) samples.y(i, 0) = samples.x(i, 1) > 0 ? 1 : 0;
  for (const std::size_t k : {1, 2, 3, 4}) {
    int wins = 0;
    constexpr int n = 1000;
    for (std::uint64_t tree = 0; tree < n; ++tree) {
      const Tree grown = grow_tree(samples, {.candidates = k, .min_samples = 40, .min_variance = 0.2}, tree);
      wins += grown.nodes[0].feature == 1 ? 1 : 0;
    }
    const double p = static_cast<double>(k) / 4;
    EXPECT_NEAR(wins, n * p, 4 * std::sqrt(n * p * (1 - p))) << "k = " << k;
  }
}

TEST(Grow, StopsAtTheLeastVariance) {
  GrowSamples samples(4, 1);
  for (std::size_t i = 0; i < 4; ++i) {
    samples.x(i, 0) = static_cast<double>(i);
    samples.y(i, 0) = i % 2 == 0 ? 1 : -1;  // variance 1
  }
  EXPECT_EQ(grow_tree(samples, {.min_variance = 1}, 0).nodes.size(), 1u);
  EXPECT_GT(grow_tree(samples, {.min_variance = 0.999}, 0).nodes.size(), 1u);
}

TEST(Grow, ConstantLeavesAreMeansAndLinearOnesLeastSquares) {
  for (std::uint64_t trial = 0; trial < 60; ++trial) {
    Stream stream = kGrowDraws.stream("leaves", trial);
    const std::size_t inputs = 1 + trial % 3;
    GrowSamples samples = random_samples(stream, 200, inputs, 0);
    for (std::size_t i = 0; i < 200; ++i) samples.weights.push_back(stream.uniform(0.1, 3));
    Growth growth{.candidates = 2, .min_samples = 15, .leaf_margin = 0.25};
    growth.leaf = trial % 2 == 0 ? LeafModel::constant : LeafModel::linear;
    const Tree tree = grow_tree(samples, growth, trial);
    ASSERT_GT(leaves_of(tree).size(), 3u);
    for_each_node(tree, samples, 0, all_rows(samples), [&](std::int32_t node, const Rows& rows) {
      if (tree.nodes[node].child != node) return;
      const auto n = static_cast<Eigen::Index>(rows.size());
      const auto columns = static_cast<Eigen::Index>(growth.leaf == LeafModel::linear ? inputs + 1 : 1);
      Eigen::MatrixXd a(n, columns);
      Eigen::VectorXd b(n);
      double low = 1e300, high = -1e300;
      for (Eigen::Index i = 0; i < n; ++i) {
        const std::size_t row = rows[static_cast<std::size_t>(i)];
        const double root = std::sqrt(samples.weights[row]);
        a(i, 0) = root;
        for (Eigen::Index c = 1; c < columns; ++c) {
          a(i, c) = root * samples.x(row, static_cast<std::size_t>(c - 1));
        }
        b(i) = root * samples.y(row, 0);
        low = std::min(low, samples.y(row, 0));
        high = std::max(high, samples.y(row, 0));
      }
      const Eigen::VectorXd expected = a.colPivHouseholderQr().solve(b);
      if (growth.leaf == LeafModel::constant) {
        EXPECT_NEAR(tree.nodes[node].value, expected(0), 1e-6);
        return;
      }
      const double* model =
          tree.models.data() + static_cast<std::size_t>(tree.nodes[node].value) * model_width(inputs);
      for (Eigen::Index c = 0; c < columns; ++c) EXPECT_NEAR(model[c], expected(c), 1e-4);
      EXPECT_NEAR(model[inputs + 1], low - 0.25 * (high - low), 1e-6);
      EXPECT_NEAR(model[inputs + 2], high + 0.25 * (high - low), 1e-6);
    });
  }
}

// At the root, since other nodes are made in an order that depends on numbers of samples. The values are
// multiples of 1/8, so that sums in another order are the same.
TEST(Grow, AWeightOf2IsTheSampleTwiceAndOneOf0NoSample) {
  for (std::uint64_t trial = 0; trial < 100; ++trial) {
    Stream stream = kGrowDraws.stream("weights", trial);
    std::vector<std::array<double, 4>> rows(30 + stream.below(60));  // inputs, output, weight
    GrowSamples weighted(rows.size(), 2);
    std::size_t copies = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto weight = static_cast<double>(i < 2 ? 1 : stream.below(3));
      rows[i] = {eighth(stream, -1, 1), eighth(stream, -1, 1), eighth(stream, -1, 1), weight};
      weighted.x.set_row(i, std::span(rows[i]).first(2));
      weighted.y(i, 0) = rows[i][2];
      weighted.weights.push_back(weight);
      copies += static_cast<std::size_t>(weight);
    }
    GrowSamples repeated(copies, 2);
    std::size_t at = 0;
    for (const auto& row : rows) {
      for (int i = 0; i < static_cast<int>(row[3]); ++i, ++at) {
        repeated.x.set_row(at, std::span(row).first(2));
        repeated.y(at, 0) = row[2];
      }
    }
    const auto grow = [&](const GrowSamples& samples, std::size_t candidates) {
      return grow_tree(samples, {.candidates = candidates}, trial);
    };
    for (const std::size_t k : {std::size_t{1}, std::size_t{2}}) {
      const Tree a = grow(weighted, k), b = grow(repeated, k);
      EXPECT_EQ(a.nodes[0].feature, b.nodes[0].feature) << "trial " << trial;
      EXPECT_EQ(a.nodes[0].value, b.nodes[0].value) << "trial " << trial;
    }
  }
}

TEST(Grow, OneSampleOrEqualInputsOrEqualOutputsGiveOneLeaf) {
  for (const LeafModel leaf : {LeafModel::constant, LeafModel::linear}) {
    GrowSamples one(1, 3), same_inputs(20, 3), same_outputs(20, 3);
    one.y(0, 0) = 2.5;
    double mean = 0;
    for (std::size_t i = 0; i < 20; ++i) {
      same_inputs.x.set_row(i, std::array{0.3, -0.7, 1e9});
      same_inputs.y(i, 0) = static_cast<double>(i * i);
      mean += same_inputs.y(i, 0) / 20;
      same_outputs.x.set_row(i, std::array{std::sin(i), std::cos(i), static_cast<double>(i)});
      same_outputs.y(i, 0) = -4.25;
    }
    const Growth growth{.leaf = leaf, .candidates = 3};
    const auto expect_leaf = [&](const GrowSamples& samples, double value, double tolerance) {
      const Tree tree = grow_tree(samples, growth, 0);
      ASSERT_EQ(tree.nodes.size(), 1u);
      std::array<double, 3> x;
      samples.x.row(0, x);
      EXPECT_NEAR(predict(tree, x).value(), value, tolerance);
      EXPECT_NEAR(predict(tree, std::array{5.0, 5.0, 5.0}).value(), value, tolerance);
    };
    expect_leaf(one, 2.5, 0);
    expect_leaf(same_inputs, mean, 1e-5);
    expect_leaf(same_outputs, -4.25, 1e-12);
  }
}

// Inputs that differ in single precision, above a threshold or at it.
TEST(Grow, SeparatesNeighbours) {
  GrowSamples samples(2, 1);
  samples.x(0, 0) = 1;
  samples.x(1, 0) = std::nextafter(1.0, 2.0);
  samples.y(1, 0) = 1;
  for (std::uint64_t tree = 0; tree < 20; ++tree) {
    const Tree grown = grow_tree(samples, {}, tree);
    ASSERT_EQ(leaves_of(grown).size(), 2u);
    EXPECT_EQ(grown.nodes[0].value, 1);
  }
  samples.x(0, 0) = std::nextafter(samples.x(1, 0), 2.0);  // rounded up to the same
  EXPECT_EQ(leaves_of(grow_tree(samples, {}, 0)).size(), 1u);
}

// Trees of one sample in a leaf, where leaves are made at once, and of any other rule: all samples find their
// own leaf.
TEST(Grow, LearnsItsSamplesByHeart) {
  for (const std::uint64_t levels : {0, 40}) {
    Stream stream = kGrowDraws.stream("heart", levels);
    const GrowSamples samples = random_samples(stream, 3000, 2, levels);
    for (const std::size_t k : {1, 2}) {
      const Tree tree = grow_tree(samples, {.candidates = k}, k);
      EXPECT_GT(leaves_of(tree).size(), levels == 0 ? 2990u : k == 1 ? 500u : 1000u);
      for_each_node(tree, samples, 0, all_rows(samples), [&](std::int32_t node, const Rows& rows) {
        if (tree.nodes[node].child != node) return;
        double mean = 0;
        for (const std::size_t row : rows) mean += samples.y(row, 0) / static_cast<double>(rows.size());
        ASSERT_NEAR(tree.nodes[node].value, mean, 1e-6);
        if (k < 2) return;
        for (const std::size_t row : rows) {  // a leaf of several has equal inputs
          ASSERT_EQ(rounded_up(samples.x(row, 0)), rounded_up(samples.x(rows[0], 0)));
          ASSERT_EQ(rounded_up(samples.x(row, 1)), rounded_up(samples.x(rows[0], 1)));
        }
      });
    }
  }
}

// scikit-learn's rule: of the thresholds between the ends, those that leave too few are no candidates.
TEST(Grow, RejectsThresholdsThatLeaveTooFew) {
  GrowSamples samples(100, 1);
  for (std::size_t i = 0; i < 100; ++i) {
    samples.x(i, 0) = static_cast<double>(i) / 99;
    samples.y(i, 0) = i % 2 == 0 ? 1 : -1;
  }
  std::vector<double> thresholds;
  constexpr int n = 4000;
  for (std::uint64_t tree = 0; tree < n; ++tree) {
    const Tree grown = grow_tree(
        samples, {.min_samples = 26, .too_few = Growth::Short::reject, .min_variance = 0.999}, tree);
    if (grown.nodes.size() > 1) thresholds.push_back(grown.nodes[0].value);
  }
  constexpr double p = 49.0 / 99;  // thresholds from the 26th to the 75th
  EXPECT_NEAR(static_cast<double>(thresholds.size()), n * p, 4 * std::sqrt(n * p * (1 - p)));
  EXPECT_LT(kolmogorov(thresholds, 25.0 / 99, 74.0 / 99), 1.95);
}

TEST(Grow, GivesEqualSplitsEqualChances) {
  GrowSamples samples(40, 3);
  for (std::size_t i = 0; i < 40; ++i) {
    for (std::size_t c = 0; c < 3; ++c) samples.x(i, c) = i < 17 ? 0 : 1;
    samples.y(i, 0) = i < 17 ? 0.25 : 3;
  }
  for (const std::size_t rows : {std::size_t{40}, std::size_t{2}}) {
    GrowSamples some(rows, 3);
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t c = 0; c < 3; ++c) some.x(i, c) = samples.x(rows == 2 ? 16 + i : i, c);
      some.y(i, 0) = samples.y(rows == 2 ? 16 + i : i, 0);
    }
    std::array<int, 3> wins{};
    constexpr int n = 3000;
    for (std::uint64_t tree = 0; tree < n; ++tree) {
      ++wins.at(static_cast<std::size_t>(grow_tree(some, {.candidates = 3}, tree).nodes[0].feature));
    }
    for (const int won : wins) EXPECT_NEAR(won, n / 3.0, 4 * std::sqrt(n * 2 / 9.0)) << rows << " samples";
  }
}

// The magnitude and the offset of outputs and weights change nothing but the outputs.
TEST(Grow, KeepsPrecisionAtAnyMagnitude) {
  Stream stream = kGrowDraws.stream("magnitude");
  GrowSamples samples = random_samples(stream, 300, 2, 0);
  for (std::size_t i = 0; i < 300; ++i) samples.weights.push_back(stream.uniform(0.5, 2));
  for (const LeafModel leaf : {LeafModel::constant, LeafModel::linear}) {
    const Growth growth{.leaf = leaf, .candidates = 2, .min_samples = 10};
    const Tree tree = grow_tree(samples, growth, 0);
    for (const auto& [offset, unit] :
         {std::pair{1e6, 1.0}, {0.0, 0x1p900}, {0.0, 0x1p-900}, {-1e250, 0x1p800}}) {
      GrowSamples other = samples;
      for (double& y : other.y.values()) y = offset + unit * y;
      for (double& weight : other.weights) weight *= unit;
      const Tree grown = grow_tree(other, growth, 0);
      for (int i = 0; i < 100; ++i) {
        const std::array<double, 2> x{stream.uniform(-1, 1), stream.uniform(-1, 1)};
        const double expected = predict(tree, x).value();
        EXPECT_NEAR((predict(grown, x).value() - offset) / unit, expected, 1e-5) << offset << ", " << unit;
      }
    }
  }
}

TEST(Grow, DropsWeightsThatVanishBesideTheLargest) {
  GrowSamples samples(4, 1);
  for (std::size_t i = 0; i < 4; ++i) samples.x(i, 0) = samples.y(i, 0) = static_cast<double>(i);
  samples.weights = {1, 1e-300, 0, 1};
  const Tree tree = grow_tree(samples, {}, 0);
  EXPECT_EQ(leaves_of(tree).size(), 2u);
  EXPECT_EQ(predict(tree, std::array{0.0}).value(), 0);
  EXPECT_EQ(predict(tree, std::array{3.0}).value(), 3);
}

// The processor and the number of threads change no bit.
TEST(Grow, IsTheSameOnAllProcessorsAndThreads) {
  for (std::uint64_t trial = 0; trial < 48; ++trial) {
    Stream stream = kGrowDraws.stream("kernels", trial);
    const std::size_t rows = trial % 8 == 0 ? 9000 : 1 + stream.below(700);
    const std::size_t inputs = 1 + stream.below(12);
    GrowSamples samples = random_samples(stream, rows, inputs, stream.below(3) * 10);
    if (trial % 3 == 0) {
      for (std::size_t i = 0; i < rows; ++i) samples.weights.push_back(static_cast<double>(stream.below(4)));
      samples.weights[0] = 1.5;
    }
    Growth growth;
    growth.leaf = trial % 2 == 0 ? LeafModel::constant : LeafModel::linear;
    growth.candidates = 1 + stream.below(inputs);
    growth.min_samples =
        growth.leaf == LeafModel::constant ? 1 + stream.below(20) : inputs + 1 + stream.below(30);
    growth.too_few = trial % 5 == 0 ? Growth::Short::reject : Growth::Short::redraw;
    growth.min_variance = trial % 7 == 0 ? 0.1 : 0;
    const Draws draws = kGrowDraws.fork("trial", trial);
    const Forest forest = grow(samples, growth, 4, draws, portable_tree_kernels());
    for (const TreeKernels* kernels : usable_tree_kernels())
      ASSERT_EQ(grow(samples, growth, 4, draws, *kernels), forest) << kernels->name << ", trial " << trial;
    Threads threads(3);
    ASSERT_EQ(grow_forest(samples.set(), growth, 4, draws, threads), forest) << "trial " << trial;
  }
}

}  // namespace
}  // namespace coppice::testing
