#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solvers/approximators/forest_function.h"
#include "tests/support/make.h"
#include "tests/support/threads.h"

namespace coppice {
namespace {

const Draws kExtraTreesDraws(2017, "extra_trees", 0);

struct TwoOutputs {
  Matrix x, y;
  std::vector<double> weights;
  TwoOutputs(std::size_t rows, std::size_t inputs) : x(rows, inputs), y(rows, 2) {
    Stream stream = kExtraTreesDraws.stream("samples", rows);
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t c = 0; c < inputs; ++c) x(i, c) = stream.uniform(-1, 1);
      y(i, 0) = x(i, 0) * x(i, inputs - 1) + 0.1 * stream.normal();
      y(i, 1) = x(i, 0);
    }
  }
};

MadeFunction fit(const std::string& xml, const TwoOutputs& samples, const Draws& draws = kExtraTreesDraws) {
  Serial serial;
  return make_from_xml<Approximator>(xml)->fit({samples.x, samples.y, samples.weights}, draws, serial);
}
const Forest& forest(const MadeFunction& function) {
  return dynamic_cast<const ForestFunction&>(*function).forest();
}

// Aggregation changes what is made of the trees, not the trees.
TEST(ExtraTrees, CanTrimItsMean) {
  const TwoOutputs samples(500, 2);
  Forest mean = forest(fit("<extra_trees/>", samples));
  const Forest trimmed = forest(fit("<extra_trees aggregation=\"trimmed_mean\"/>", samples));
  EXPECT_EQ(trimmed.aggregation(), Aggregation::trimmed_mean);
  EXPECT_NE(mean, trimmed);
  mean.aggregate_by(Aggregation::trimmed_mean);
  EXPECT_EQ(mean, trimmed);
}

// What is left automatic, against the same said in full (N samples of D inputs).
TEST(ExtraTrees, WorksOutItsParameters) {
  const auto expect_same = [](std::size_t n, std::size_t d, const std::string& automatic,
                              const std::string& explicitly) {
    const TwoOutputs samples(n, d);
    const std::string trees = " trees=\"3\" ";
    EXPECT_EQ(forest(fit("<extra_trees" + trees + automatic + "/>", samples)),
              forest(fit("<extra_trees" + trees + explicitly + "/>", samples)))
        << n << " samples of " << d << " inputs: " << automatic;
  };
  expect_same(1000, 3, "",
              "k=\"3\" n_min=\"6\" leaves=\"pwc\" v_min=\"0\" too_few=\"redraw\"");  // floor(ln 1000) = 6
  expect_same(1000, 3, "leaves=\"pwl\"", "leaves=\"pwl\" k=\"3\" n_min=\"18\" margin=\"0\"");
  expect_same(2, 3, "", "n_min=\"1\"");  // floor(ln 2) = 0
  expect_same(1, 1, "", "n_min=\"1\"");
  expect_same(6, 4, "leaves=\"pwl\"", "leaves=\"pwl\" n_min=\"5\"");  // D + 1 > D floor(ln 6)
  expect_same(4, 4, "leaves=\"pwl\"", "leaves=\"pwc\"");              // N < D + 1
  expect_same(100, 2, "k=\"7\"", "k=\"2\"");
  const TwoOutputs samples(1000, 3);
  EXPECT_EQ(forest(fit("<extra_trees/>", samples)).trees(), 25u);
  EXPECT_NE(forest(fit("<extra_trees n_min=\"7\"/>", samples)), forest(fit("<extra_trees/>", samples)));
  EXPECT_NE(forest(fit("<extra_trees k=\"2\"/>", samples)), forest(fit("<extra_trees/>", samples)));
  EXPECT_NE(forest(fit("<extra_trees too_few=\"reject\"/>", samples)),
            forest(fit("<extra_trees/>", samples)));
}

TEST(ExtraTrees, SamplesOfWeight0DoNotCount) {
  TwoOutputs samples(40, 3);
  samples.weights.assign(40, 0);
  for (std::size_t i = 0; i < 3; ++i) samples.weights[i] = 1;
  EXPECT_EQ(forest(fit("<extra_trees leaves=\"pwl\"/>", samples)).leaf(), LeafModel::constant);
  EXPECT_EQ(forest(fit("<extra_trees trees=\"1\"/>", samples)).leaves(), 6u) << "three for each output";
}

TEST(ExtraTrees, GrowsTheSameForestOnAnyNumberOfThreads) {
  for (const std::string leaves : {"pwc", "pwl"}) {
    const TwoOutputs samples(500, 3);
    Threads threads(3);
    const Sub<Approximator> approximator =
        make_from_xml<Approximator>("<extra_trees leaves=\"" + leaves + "\"/>");
    EXPECT_EQ(forest(approximator->fit({samples.x, samples.y, {}}, kExtraTreesDraws, threads)),
              forest(fit("<extra_trees leaves=\"" + leaves + "\"/>", samples)));
  }
}

TEST(ExtraTrees, GrowsDifferentTreesForEachSeedTreeAndOutput) {
  const TwoOutputs samples(200, 2);
  const MadeFunction function = fit("<extra_trees trees=\"2\"/>", samples);
  EXPECT_NE(forest(function), forest(fit("<extra_trees trees=\"2\"/>", samples, Draws(1, "other", 0))));
  const auto root = [&](std::size_t output, std::size_t tree) {
    const ForestTree view = forest(function).tree(output, tree);
    return view.nodes[view.root].value;
  };
  EXPECT_NE(root(0, 0), root(0, 1));
  EXPECT_NE(root(0, 0), root(1, 0));
}

// Trees do not depend on how many others there are.
TEST(ExtraTrees, ALargerForestBeginsAsASmallerOne) {
  const TwoOutputs samples(100, 2);
  EXPECT_EQ(forest(fit("<regression_tree/>", samples)).trees(), 1u);
  const MadeFunction small = fit("<regression_tree/>", samples), large = fit("<extra_trees/>", samples);
  const ForestTree a = forest(small).tree(0, 0), b = forest(large).tree(0, 0);
  EXPECT_EQ(a.nodes[a.root].value, b.nodes[b.root].value);
}

TEST(ExtraTrees, Learns) {
  const TwoOutputs samples(2000, 2), fresh(2001, 2);
  for (const auto& [xml, limit] :
       {std::pair{"<extra_trees/>", 0.15}, std::pair{"<extra_trees leaves=\"pwl\"/>", 0.125}}) {
    const MadeFunction function = fit(xml, samples);
    Matrix predicted(2001, 2);
    function->predict_batch(fresh.x, predicted);
    double squares = 0;
    for (std::size_t i = 0; i < 2001; ++i) squares += std::pow(predicted(i, 0) - fresh.y(i, 0), 2);
    EXPECT_LT(std::sqrt(squares / 2001), limit) << xml << ": the noise alone is 0.1";
  }
}

// Also where there were no samples, and for leaves with as few samples as their models have numbers.
TEST(ExtraTrees, PredictionsLeaveTheRangeOfTheOutputsByTheMarginAtMost) {
  constexpr std::size_t kPoints = 200000;  // for each of five: a million
  const TwoOutputs samples(3000, 3);
  const auto outputs = samples.y.column(0);
  const auto [least, most] = std::minmax_element(outputs.begin(), outputs.end());
  Stream stream = kExtraTreesDraws.stream("everywhere");
  Matrix x(kPoints, 3), y(kPoints, 2);
  for (double& value : x.values()) value = stream.uniform(-2, 2);
  for (const auto& [xml, margin] :
       {std::pair{"<extra_trees trees=\"5\"/>", 0.0},
        {"<extra_trees trees=\"5\" leaves=\"pwl\" n_min=\"4\"/>", 0.0},
        {"<extra_trees trees=\"5\" leaves=\"pwl\" n_min=\"4\" aggregation=\"trimmed_mean\"/>", 0.0},
        {"<regression_tree leaves=\"pwl\" n_min=\"4\"/>", 0.0},
        {"<regression_tree leaves=\"pwl\" n_min=\"60\" margin=\"0.25\"/>", 0.25}}) {
    fit(xml, samples)->predict_batch(x, y);
    const auto predicted = y.column(0);
    const auto [low, high] = std::minmax_element(predicted.begin(), predicted.end());
    const double room = (margin + 1e-6) * (*most - *least);  // samples are in single precision
    EXPECT_GE(*low, *least - room) << xml;
    EXPECT_LE(*high, *most + room) << xml;
    if (margin > 0) {
      EXPECT_TRUE(*low < *least || *high > *most) << "the margin is used";
    }
  }
}

double error_on(const Function& function, const Matrix& x, const std::vector<double>& truth) {
  Matrix y(x.rows(), 1);
  function.predict_batch(x, y);
  double squares = 0;
  for (std::size_t i = 0; i < x.rows(); ++i) squares += (y(i, 0) - truth[i]) * (y(i, 0) - truth[i]);
  return std::sqrt(squares / static_cast<double>(x.rows()));
}

// With so many samples in a leaf that what a model cannot follow is more than what noise does to it. (Noise
// hurts linear models more: with 40 samples in a leaf, constants follow the sine of one of three inputs
// better.)
TEST(ExtraTrees, LinearLeavesBeatAtLeastAsManyConstantOnesOnSmoothFunctions) {
  using Smooth = double (*)(const double*);
  const std::vector<std::pair<std::string, Smooth>> functions = {
      {"sine", [](const double* x) { return std::sin(3 * x[0]) + 0.0 * x[1]; }},
      {"product", [](const double* x) { return x[0] * x[1]; }},
      {"bump", [](const double* x) { return std::exp(-4 * (x[0] * x[0] + x[1] * x[1])); }},
      {"friedman",
       [](const double* x) { return std::sin(0.785 * (1 + x[0]) * (1 + x[1])) + 0.5 * x[2] * x[2]; }}};
  for (const auto& [name, function] : functions) {
    Stream stream = kExtraTreesDraws.stream("smooth");
    Matrix x(4000, 3), y(4000, 1), fresh(5000, 3);
    std::vector<double> truth(5000), point(3);
    for (double& value : x.values()) value = stream.uniform(-1, 1);
    for (double& value : fresh.values()) value = stream.uniform(-1, 1);
    for (std::size_t i = 0; i < x.rows(); ++i) {
      x.row(i, point);
      y(i, 0) = function(point.data()) + 0.05 * stream.normal();
    }
    for (std::size_t i = 0; i < fresh.rows(); ++i) {
      fresh.row(i, point);
      truth[i] = function(point.data());
    }
    Serial serial;
    const auto fitted = [&](const std::string& attributes) {
      return make_from_xml<Approximator>("<extra_trees " + attributes + "/>")
          ->fit({x, y, {}}, kExtraTreesDraws, serial);
    };
    const MadeFunction linear = fitted("leaves=\"pwl\" n_min=\"150\"");
    int n_min = 150;
    MadeFunction constant = fitted("n_min=\"150\"");
    while (forest(constant).leaves() < forest(linear).leaves())
      constant = fitted("n_min=\"" + std::to_string(--n_min) + "\"");
    EXPECT_GE(n_min, 110) << name << ": about as many leaves";
    EXPECT_LT(error_on(*linear, fresh, truth), error_on(*constant, fresh, truth)) << name;
  }
}

// One to forty inputs, several outputs, weights, ties, a constant column: each output is learned from the
// input it is made of, alike by any threads, and no split is along what does not vary.
TEST(ExtraTrees, LearnsFromSamplesOfAnyShape) {
  for (const std::size_t inputs : {1, 2, 5, 17, 40}) {
    for (const std::string leaves : {"pwc", "pwl"}) {
      TwoOutputs samples(1500, inputs);
      Stream stream = kExtraTreesDraws.stream("shape", inputs);
      const std::size_t still = inputs - 1;
      for (std::size_t i = 0; i < samples.x.rows(); ++i) {
        samples.x(i, 0) = std::round(8 * samples.x(i, 0)) / 8;  // ties
        if (inputs > 1) samples.x(i, still) = 0.7;
        samples.y(i, 0) = samples.x(i, 0);
        samples.y(i, 1) = -2 * samples.x(i, 0) + 5;
        samples.weights.push_back(static_cast<double>(stream.below(4)));
      }
      const std::string xml = "<extra_trees trees=\"5\" leaves=\"" + leaves + "\"/>";
      const MadeFunction function = fit(xml, samples);
      Threads threads(2);
      EXPECT_EQ(forest(make_from_xml<Approximator>(xml)->fit({samples.x, samples.y, samples.weights},
                                                             kExtraTreesDraws, threads)),
                forest(function));
      Matrix y(samples.x.rows(), 2);
      function->predict_batch(samples.x, y);
      double squares = 0;
      for (std::size_t i = 0; i < y.rows(); ++i) {
        squares += std::pow(y(i, 0) - samples.y(i, 0), 2) + std::pow((y(i, 1) - samples.y(i, 1)) / 2, 2);
      }
      const double error = std::sqrt(squares / static_cast<double>(2 * y.rows()));
      EXPECT_LT(error, 0.1) << inputs << " inputs, " << leaves << ": the outputs' deviation is 0.6";
      for (std::size_t t = 0; inputs > 1 && t < 5; ++t) {
        const ForestTree tree = forest(function).tree(0, t);
        const std::uint32_t end =
            t + 1 < 5 ? forest(function).tree(0, t + 1).root : forest(function).tree(1, 0).root;
        for (std::uint32_t node = tree.root; node < end; ++node) ASSERT_NE(tree.nodes[node].feature(), still);
      }
    }
  }
}

TEST(ExtraTrees, RefusesWhatIsOutOfBounds) {
  for (const std::string given :
       {"trees=\"0\"", "trees=\"100001\"", "k=\"0\"", "n_min=\"0\"", "v_min=\"-1\"", "margin=\"-0.1\"",
        "v_min=\"nan\"", "leaves=\"gp\"", "n_min=\"1.5\"", "too_few=\"keep\"", "aggregation=\"median\""}) {
    EXPECT_THROW(make_from_xml<Approximator>("<extra_trees " + given + "/>"), ConfigError) << given;
  }
}

}  // namespace
}  // namespace coppice
