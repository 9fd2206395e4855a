#include <gtest/gtest.h>

#include "solvers/approximators/forest_function.h"
#include "tests/support/make.h"

namespace coppice {
namespace {

const Draws kMergedDraws(5, "merged", 0);

struct MergedSamples {
  MergedSamples() : x(400, 2), y(400, 2) {
    Stream stream = kMergedDraws.stream("samples");
    for (std::size_t i = 0; i < x.rows(); ++i) {
      x(i, 0) = stream.uniform(-1, 1);
      x(i, 1) = stream.uniform(0, 3);
      y(i, 0) = 100 + x(i, 0) * x(i, 1);
      y(i, 1) = x(i, 0) - x(i, 1);
    }
  }
  Matrix x, y;
};

MadeFunction fitted(const std::string& approximator, const MergedSamples& samples) {
  Serial serial;
  return make_from_xml<Approximator>(approximator)->fit({samples.x, samples.y, {}}, kMergedDraws, serial);
}

std::vector<double> at(const MadeFunction& function, double a, double b) {
  std::vector<double> y(2);
  function->predict(std::vector{a, b}, y);
  return y;
}

TEST(MergedTree, SaysWhatTheForestSays) {
  const MergedSamples samples;
  for (const std::string leaves : {"pwc", "pwl"}) {
    const std::string forest = "<extra_trees trees=\"5\" n_min=\"40\" leaves=\"" + leaves + "\"/>";
    const MadeFunction many = fitted(forest, samples);
    const MadeFunction one =
        fitted("<merged_tree max_leaves=\"100000\">" + forest + "</merged_tree>", samples);
    EXPECT_EQ(dynamic_cast<const ForestFunction&>(*one.object).forest().trees(), 1u);
    for (std::size_t i = 0; i < samples.x.rows(); ++i) {
      const std::vector<double> expected = at(many, samples.x(i, 0), samples.x(i, 1));
      const std::vector<double> value = at(one, samples.x(i, 0), samples.x(i, 1));
      EXPECT_NEAR(value[0], expected[0], 1e-6);
      EXPECT_NEAR(value[1], expected[1], 1e-6);
    }
  }
}

TEST(MergedTree, KeepsToItsLeavesAndCanBeSaved) {
  const MergedSamples samples;
  for (const std::string leaves : {"pwc", "pwl"}) {
    const MadeFunction tree = fitted(
        "<merged_tree max_leaves=\"12\"><extra_trees n_min=\"10\" leaves=\"" + leaves + "\"/></merged_tree>",
        samples);
    EXPECT_EQ(tree->facts().front(), (std::pair<std::string, double>{"trees", 2}));
    EXPECT_EQ(tree->facts().back(), (std::pair<std::string, double>{"leaves", 24}));
    Archive archive;
    tree->save(archive);
    ForestFunction again;
    again.load(archive);
    std::vector<double> y(2);
    again.predict(std::vector{0.3, 1.0}, y);
    EXPECT_EQ(y, at(tree, 0.3, 1.0));
    EXPECT_NEAR(y[0], 100.3, 1);
  }
}

TEST(MergedTree, RefusesWhatIsNoForest) {
  const MergedSamples samples;
  EXPECT_THROW(fitted("<merged_tree><linear/></merged_tree>", samples), std::invalid_argument);
  EXPECT_THROW(fitted("<merged_tree><extra_trees aggregation=\"trimmed_mean\"/></merged_tree>", samples),
               std::invalid_argument);
}

}  // namespace
}  // namespace coppice
