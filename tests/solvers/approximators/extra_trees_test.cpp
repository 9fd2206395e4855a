#include <gtest/gtest.h>

#include <cmath>

#include "solvers/approximators/forest_function.h"
#include "tests/support/make.h"
#include "tests/support/threads.h"

namespace coppice {
namespace {

const Draws kDraws(2017, "extra_trees", 0);

struct Samples {
  Matrix x, y;
  std::vector<double> weights;
  Samples(std::size_t rows, std::size_t inputs) : x(rows, inputs), y(rows, 2) {
    Stream stream = kDraws.stream("samples", rows);
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t c = 0; c < inputs; ++c) x(i, c) = stream.uniform(-1, 1);
      y(i, 0) = x(i, 0) * x(i, inputs - 1) + 0.1 * stream.normal();
      y(i, 1) = x(i, 0);
    }
  }
};

MadeFunction fit(const std::string& xml, const Samples& samples, const Draws& draws = kDraws) {
  Serial serial;
  return make_from_xml<Approximator>(xml)->fit({samples.x, samples.y, samples.weights}, draws, serial);
}
const Forest& forest(const MadeFunction& function) {
  return dynamic_cast<const ForestFunction&>(*function).forest();
}

// Aggregation changes what is made of the trees, not the trees.
TEST(ExtraTrees, CanTrimItsMean) {
  const Samples samples(500, 2);
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
    const Samples samples(n, d);
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
  const Samples samples(1000, 3);
  EXPECT_EQ(forest(fit("<extra_trees/>", samples)).trees(), 25u);
  EXPECT_NE(forest(fit("<extra_trees n_min=\"7\"/>", samples)), forest(fit("<extra_trees/>", samples)));
  EXPECT_NE(forest(fit("<extra_trees k=\"2\"/>", samples)), forest(fit("<extra_trees/>", samples)));
  EXPECT_NE(forest(fit("<extra_trees too_few=\"reject\"/>", samples)),
            forest(fit("<extra_trees/>", samples)));
}

TEST(ExtraTrees, SamplesOfWeight0DoNotCount) {
  Samples samples(40, 3);
  samples.weights.assign(40, 0);
  for (std::size_t i = 0; i < 3; ++i) samples.weights[i] = 1;
  EXPECT_EQ(forest(fit("<extra_trees leaves=\"pwl\"/>", samples)).leaf(), LeafModel::constant);
  EXPECT_EQ(forest(fit("<extra_trees trees=\"1\"/>", samples)).leaves(), 6u) << "three for each output";
}

TEST(ExtraTrees, GrowsTheSameForestOnAnyNumberOfThreads) {
  for (const std::string leaves : {"pwc", "pwl"}) {
    const Samples samples(500, 3);
    Threads threads(3);
    const Sub<Approximator> approximator =
        make_from_xml<Approximator>("<extra_trees leaves=\"" + leaves + "\"/>");
    EXPECT_EQ(forest(approximator->fit({samples.x, samples.y, {}}, kDraws, threads)),
              forest(fit("<extra_trees leaves=\"" + leaves + "\"/>", samples)));
  }
}

TEST(ExtraTrees, GrowsDifferentTreesForEachSeedTreeAndOutput) {
  const Samples samples(200, 2);
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
  const Samples samples(100, 2);
  EXPECT_EQ(forest(fit("<regression_tree/>", samples)).trees(), 1u);
  const MadeFunction small = fit("<regression_tree/>", samples), large = fit("<extra_trees/>", samples);
  const ForestTree a = forest(small).tree(0, 0), b = forest(large).tree(0, 0);
  EXPECT_EQ(a.nodes[a.root].value, b.nodes[b.root].value);
}

TEST(ExtraTrees, Learns) {
  const Samples samples(2000, 2), fresh(2001, 2);
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

TEST(ExtraTrees, RefusesWhatIsOutOfBounds) {
  for (const std::string given :
       {"trees=\"0\"", "trees=\"100001\"", "k=\"0\"", "n_min=\"0\"", "v_min=\"-1\"", "margin=\"-0.1\"",
        "v_min=\"nan\"", "leaves=\"gp\"", "n_min=\"1.5\"", "too_few=\"keep\""}) {
    EXPECT_THROW(make_from_xml<Approximator>("<extra_trees " + given + "/>"), ConfigError) << given;
  }
}

}  // namespace
}  // namespace coppice
