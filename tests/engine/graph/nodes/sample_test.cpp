#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "tests/engine/graph/nodes/fake_context.h"

namespace coppice::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Attributes = std::vector<std::pair<std::string, std::string>>;

Sub<Node> sample(Attributes more, Element function = element("sine", {})) {
  more.insert(more.begin(), {"id", "s"});
  return make_node(element("sample", more, {std::move(function)}));
}

Table made(const Sub<Node>& node, FakeContext& context) {
  node->run(context);
  return read_table(context.folder() / kDatasetFile);
}

TEST(Sample, GridReachesBothLimitsWithoutNoise) {
  FakeContext context;
  const auto node = sample({{"samples", "5"}, {"draw", "grid"}});
  EXPECT_FALSE(node->random());
  EXPECT_THAT(node->dataset_columns(context), ElementsAre("x", "y"));
  const Table table = made(node, context);
  ASSERT_EQ(table.rows.size(), 5u);
  for (int i = 0; i < 5; ++i) {
    const double x = std::numbers::pi * (-1 + i / 2.0);
    EXPECT_NEAR(number(table.rows[i][0]), x, 1e-15);
    EXPECT_NEAR(number(table.rows[i][1]), std::sin(x), 1e-15);
  }
  EXPECT_EQ(number(table.rows[4][0]), std::numbers::pi);
}

TEST(Sample, NoiseIsNormalAndAddedToTheFunction) {
  FakeContext context;
  const auto node = sample({{"samples", "20000"}, {"noise", "0.5"}}, element("friedman_1", {}));
  EXPECT_TRUE(node->random());
  const Table table = made(node, context);
  ASSERT_EQ(table.columns.size(), 11u);
  double sum = 0, squares = 0, fourth = 0;
  for (const std::vector<Cell>& row : table.rows) {
    const auto x = [&](int i) { return number(row[static_cast<std::size_t>(i - 1)]); };
    const double truth = 10 * std::sin(std::numbers::pi * x(1) * x(2)) + 20 * (x(3) - 0.5) * (x(3) - 0.5) +
                         10 * x(4) + 5 * x(5);
    const double error = number(row[10]) - truth;
    sum += error;
    squares += error * error;
    fourth += error * error * error * error;
  }
  EXPECT_NEAR(sum / 20000, 0, 0.015);
  EXPECT_NEAR(squares / 20000, 0.25, 0.01);
  EXPECT_NEAR(fourth / 20000 / (0.25 * 0.25), 3, 0.2);
}

TEST(Sample, LongerSamplesBeginWithTheShorterOnes) {
  FakeContext few, many;
  const Table a = made(sample({{"samples", "10"}}), few);
  const Table b = made(sample({{"samples", "20"}}), many);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(a.rows[i], b.rows[i]);
  EXPECT_NE(b.rows[10], b.rows[11]);
}

TEST(Sample, RefusesAGridOfSeveralInputs) {
  try {
    sample({{"samples", "5"}, {"draw", "grid"}}, element("friedman_1", {}));
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("a grid is of one input, and <friedman_1> has 10"));
  }
}

TEST(Predict, SaysWhatTheFunctionSaysOfEachRow) {
  FakeContext samples, fitted, context;
  write_file(samples.folder() / kDatasetFile, "x1,x2,y\n0,0,1\n1,0,3\n0,1,0\n1,1,2\n2,1,4\n");
  InputNode data;
  data.id = "data";
  data.folder = samples.folder();
  fitted.given["samples"] = {data};
  const auto fit =
      make_node(element("fit", {{"id", "f"}, {"samples", "data"}, {"inputs", "x2, x1"}, {"output", "y"}},
                        {element("linear", {})}));
  fit->run(fitted);
  InputNode function;
  function.id = "f";
  function.folder = fitted.folder();
  context.given["function"] = {function};
  context.given["samples"] = {data};
  const auto node = make_node(element("predict", {{"id", "p"}, {"function", "f"}, {"samples", "data"}}));
  const Table table = made(node, context);
  ASSERT_EQ(table.rows.size(), 5u);
  EXPECT_EQ(table.columns[0].name, "x2");
  EXPECT_EQ(table.columns[2].name, "y");
  const double expected[] = {1, 3, 0, 2, 4};  // y = 1 + 2 x1 - x2
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(number(table.rows[i][2]), expected[i], 1e-9);
}

}  // namespace
}  // namespace coppice::testing
