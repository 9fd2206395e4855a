#include "solvers/approximators/grow.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/solvers/approximators/random_trees.h"

namespace coppice::testing {
namespace {

const Draws kDraws(2017, "grow", 0);

struct Samples {
  Matrix x, y;
  std::vector<double> weights;
  Samples(std::size_t rows, std::size_t inputs) : x(rows, inputs), y(rows, 1) {}
  TrainingSet set() const { return {x, y, weights}; }
};

/// Rows of noise; inputs on a grid of `levels` values (0: continuous), many of them equal.
Samples random_samples(Stream& stream, std::size_t rows, std::size_t inputs, std::uint64_t levels) {
  Samples samples(rows, inputs);
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t c = 0; c < inputs; ++c) {
      samples.x(i, c) =
          levels == 0 ? stream.uniform(-1, 1) : static_cast<double>(stream.below(levels)) / 4 - 1;
    }
    samples.y(i, 0) = stream.normal() + samples.x(i, 0);
  }
  return samples;
}

/// The rows that a node is made of.
using Rows = std::vector<std::size_t>;

/// Calls visit(node, rows) for each node of the tree.
template <class Visit>
void for_each_node(const Tree& tree, const Samples& samples, std::int32_t node, const Rows& rows,
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

Rows all_rows(const Samples& samples) {
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

double variance(const Samples& samples, const Rows& rows) {
  double mean = 0, sum = 0;
  for (const std::size_t row : rows) mean += samples.y(row, 0) / static_cast<double>(rows.size());
  for (const std::size_t row : rows) sum += std::pow(samples.y(row, 0) - mean, 2);
  return sum / static_cast<double>(rows.size());
}

TEST(Grow, KeepsTheRulesOfAlgorithm6AtEachNode) {
  for (std::uint64_t trial = 0; trial < 400; ++trial) {
    Stream stream = kDraws.stream("rules", trial);
    const std::size_t inputs = 1 + stream.below(4);
    const std::uint64_t levels = stream.below(3) * 3;
    const Samples samples = random_samples(stream, 1 + stream.below(300), inputs, levels);
    Growth growth;
    growth.leaf = trial % 2 == 0 ? LeafModel::constant : LeafModel::linear;
    growth.candidates = inputs;
    growth.min_samples = 1 + stream.below(12);
    growth.min_variance = trial % 3 == 0 ? 0.5 : 0;
    const std::size_t n = growth.min_samples;
    const Tree tree = grow_tree(samples.set(), 0, growth, stream);
    for_each_node(tree, samples, 0, all_rows(samples), [&](std::int32_t node, const Rows& rows) {
      const TreeNode& split = tree.nodes[node];
      const double spread = variance(samples, rows);
      if (split.child == node) {  // a leaf for a reason
        EXPECT_TRUE(rows.size() >= n || node == 0);
        if (rows.size() < 2 * n || spread <= growth.min_variance + 1e-12) return;
        for (std::size_t c = 0; c < inputs; ++c) {
          const auto [low, high] = order_statistics(samples.x, c, rows, n);
          EXPECT_GE(low, high) << "axis " << c << " could have been split; trial " << trial;
        }
        return;
      }
      EXPECT_GE(rows.size(), 2 * n);
      EXPECT_GT(spread, growth.min_variance - 1e-12);
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
    Samples samples(300, 1);
    Stream stream = kDraws.stream("thresholds", static_cast<std::uint64_t>(data));
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
      const Tree grown = grow_tree(samples.set(), 0, {.min_samples = kMinSamples, .min_variance = 0.3},
                                   kDraws.stream("tree", tree));
      ASSERT_NE(grown.nodes[0].child, 0);
      thresholds.push_back(grown.nodes[0].value);
    }
    EXPECT_LT(kolmogorov(thresholds, low, high), 1.95) << "one in a thousand is larger; data " << data;
    EXPECT_GT(kolmogorov(thresholds, low, high * 1.1 - 0.1 * low), 1.95) << "the test sees 10 %";
  }
}

// Output depends on input 1 alone, which wins whenever it is among the k candidates.
TEST(Grow, TriesKDistinctDimensions) {
  Stream stream = kDraws.stream("candidates");
  Samples samples = random_samples(stream, 200, 4, 0);
  for (std::size_t i = 0; i < 200; ++i) samples.y(i, 0) = samples.x(i, 1) > 0 ? 1 : 0;
  for (const std::size_t k : {1, 2, 3, 4}) {
    int wins = 0;
    constexpr int n = 1000;
    for (std::uint64_t tree = 0; tree < n; ++tree) {
      const Tree grown =
          grow_tree(samples.set(), 0, {.candidates = k, .min_samples = 40, .min_variance = 0.2},
                    kDraws.stream("tree", tree));
      wins += grown.nodes[0].feature == 1 ? 1 : 0;
    }
    const double p = static_cast<double>(k) / 4;
    EXPECT_NEAR(wins, n * p, 4 * std::sqrt(n * p * (1 - p))) << "k = " << k;
  }
}

TEST(Grow, StopsAtTheLeastVariance) {
  Samples samples(4, 1);
  for (std::size_t i = 0; i < 4; ++i) {
    samples.x(i, 0) = static_cast<double>(i);
    samples.y(i, 0) = i % 2 == 0 ? 1 : -1;  // variance 1
  }
  EXPECT_EQ(grow_tree(samples.set(), 0, {.min_variance = 1}, kDraws.stream("v")).nodes.size(), 1u);
  EXPECT_GT(grow_tree(samples.set(), 0, {.min_variance = 0.999}, kDraws.stream("v")).nodes.size(), 1u);
}

TEST(Grow, ConstantLeavesAreMeansAndLinearOnesLeastSquares) {
  for (std::uint64_t trial = 0; trial < 60; ++trial) {
    Stream stream = kDraws.stream("leaves", trial);
    const std::size_t inputs = 1 + trial % 3;
    Samples samples = random_samples(stream, 200, inputs, 0);
    for (std::size_t i = 0; i < 200; ++i) samples.weights.push_back(stream.uniform(0.1, 3));
    Growth growth{.candidates = 2, .min_samples = 15, .leaf_margin = 0.25};
    growth.leaf = trial % 2 == 0 ? LeafModel::constant : LeafModel::linear;
    const Tree tree = grow_tree(samples.set(), 0, growth, stream);
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
        EXPECT_NEAR(tree.nodes[node].value, expected(0), 1e-12);
        return;
      }
      const double* model =
          tree.models.data() + static_cast<std::size_t>(tree.nodes[node].value) * model_width(inputs);
      for (Eigen::Index c = 0; c < columns; ++c) EXPECT_NEAR(model[c], expected(c), 1e-9);
      EXPECT_DOUBLE_EQ(model[inputs + 1], low - 0.25 * (high - low));
      EXPECT_DOUBLE_EQ(model[inputs + 2], high + 0.25 * (high - low));
    });
  }
}

// The values are multiples of 1/8, so that sums in another order are the same.
TEST(Grow, AWeightOf2IsTheSampleTwiceAndOneOf0NoSample) {
  for (std::uint64_t trial = 0; trial < 100; ++trial) {
    Stream stream = kDraws.stream("weights", trial);
    std::vector<std::array<double, 4>> rows(2 + stream.below(60));  // inputs, output, weight
    Samples weighted(rows.size(), 2);
    std::size_t copies = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto weight = static_cast<double>(i < 2 ? 1 : stream.below(3));
      rows[i] = {eighth(stream, -1, 1), eighth(stream, -1, 1), eighth(stream, -1, 1), weight};
      weighted.x.set_row(i, std::span(rows[i]).first(2));
      weighted.y(i, 0) = rows[i][2];
      weighted.weights.push_back(weight);
      copies += static_cast<std::size_t>(weight);
    }
    Samples repeated(copies, 2);
    std::size_t at = 0;
    for (const auto& row : rows) {
      for (int i = 0; i < static_cast<int>(row[3]); ++i, ++at) {
        repeated.x.set_row(at, std::span(row).first(2));
        repeated.y(at, 0) = row[2];
      }
    }
    const auto grow = [&](const Samples& samples, std::size_t candidates) {
      return grow_tree(samples.set(), 0, {.candidates = candidates}, kDraws.stream("tree", trial));
    };
    const Tree a = grow(weighted, 1), b = grow(repeated, 1);
    ASSERT_EQ(leaves_of(a).size(), leaves_of(b).size()) << "trial " << trial;
    for (int i = 0; i < 20; ++i) {
      const std::array<double, 2> x = {eighth(stream, -1, 1), eighth(stream, -1, 1)};
      ASSERT_EQ(predict(a, x), predict(b, x)) << "trial " << trial;
    }
    if (rows.size() < 30) continue;  // few samples may be split along either axis with equal scores
    EXPECT_EQ(grow(weighted, 2).nodes[0].feature, grow(repeated, 2).nodes[0].feature) << "trial " << trial;
    EXPECT_EQ(grow(weighted, 2).nodes[0].value, grow(repeated, 2).nodes[0].value) << "trial " << trial;
  }
}

TEST(Grow, OneSampleOrEqualInputsOrEqualOutputsGiveOneLeaf) {
  for (const LeafModel leaf : {LeafModel::constant, LeafModel::linear}) {
    Samples one(1, 3), same_inputs(20, 3), same_outputs(20, 3);
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
    const auto expect_leaf = [&](const Samples& samples, double value, double tolerance) {
      const Tree tree = grow_tree(samples.set(), 0, growth, kDraws.stream("tree"));
      ASSERT_EQ(tree.nodes.size(), 1u);
      std::array<double, 3> x;
      samples.x.row(0, x);
      EXPECT_NEAR(predict(tree, x).value(), value, tolerance);
      EXPECT_NEAR(predict(tree, std::array{5.0, 5.0, 5.0}).value(), value, tolerance);
    };
    expect_leaf(one, 2.5, 0);
    expect_leaf(same_inputs, mean, 1e-10);
    expect_leaf(same_outputs, -4.25, 1e-12);
  }
}

// Doubles next to each other: the threshold must separate them although rounding may move it.
TEST(Grow, SeparatesNeighbours) {
  Samples samples(2, 1);
  samples.x(0, 0) = 1;
  samples.x(1, 0) = std::nextafter(1.0, 2.0);
  samples.y(1, 0) = 1;
  for (std::uint64_t tree = 0; tree < 20; ++tree) {
    const Tree grown = grow_tree(samples.set(), 0, {}, kDraws.stream("tree", tree));
    ASSERT_EQ(leaves_of(grown).size(), 2u);
    EXPECT_EQ(grown.nodes[0].value, 1);
  }
}

}  // namespace
}  // namespace coppice::testing
