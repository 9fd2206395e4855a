#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/graph/artifacts.h"
#include "tests/engine/graph/nodes/fake_context.h"

namespace coppice::testing {
namespace {

using ::testing::HasSubstr;

Element problem_element(const std::vector<std::pair<std::string, std::string>>& parameters = {}) {
  return element("problem", {{"id", "car"}}, {element("double_integrator", parameters)});
}

/// Runs a collect node and reads what it made.
Dataset collected(FakeContext& context, const Element& collect) {
  const Element problem = problem_element();
  context.given["problem"] = {input(problem)};
  context.given["policy"] = {input(element("policy", {{"id", "random"}}, {element("random", {})}))};
  const Sub<Node> node = make_node(collect);
  node->check(context);
  node->run(context);
  InputNode made = input(collect, context.folder());
  return load_dataset(made, load_problem(input(problem))->spaces());
}

TEST(Collect, PlaysEpisodesStepAfterStepUpToTheHorizon) {
  FakeContext context;
  const Dataset data = collected(
      context,
      element("collect",
              {{"id", "c"}, {"problem", "car"}, {"policy", "random"}, {"episodes", "5"}, {"horizon", "3"}}));
  ASSERT_GT(data.rows(), 5u);
  EXPECT_EQ(data.episode.front(), 0);
  EXPECT_EQ(data.episode.back(), 4);
  for (std::size_t i = 0; i < data.rows(); ++i) {
    EXPECT_LT(data.step[i], 3);
    if (data.step[i] == 0) {
      EXPECT_EQ(data.states(i, 0), 1) << "the problem starts at 1 m";
      continue;
    }
    EXPECT_EQ(data.states(i, 0), data.next(i - 1, 0));
    EXPECT_EQ(data.states(i, 1), data.next(i - 1, 1));
  }
  EXPECT_EQ(context.counts.at("steps"), static_cast<std::int64_t>(data.rows()));
  EXPECT_EQ(context.counts.at("episodes"), 5);
}

TEST(Collect, MakesTheSameBytesEachTime) {
  const Element collect =
      element("collect", {{"id", "c"}, {"problem", "car"}, {"policy", "random"}, {"episodes", "40"}});
  FakeContext one, two;
  collected(one, collect);
  collected(two, collect);
  EXPECT_EQ(text_of(one.folder() / kDatasetFile), text_of(two.folder() / kDatasetFile));
}

TEST(Collect, DrawsUniformSamplesFromTheBoxes) {
  FakeContext context;
  const Dataset data =
      collected(context, element("collect", {{"id", "c"}, {"problem", "car"}, {"samples", "2000"}}));
  ASSERT_EQ(data.rows(), 2000u);
  for (const auto& column : {data.states.column(0), data.states.column(1), data.actions.column(0)}) {
    double sum = 0, squares = 0;
    for (const double x : column) {
      ASSERT_GE(x, -1);
      ASSERT_LT(x, 1);
      sum += x;
      squares += x * x;
    }
    EXPECT_NEAR(sum / 2000, 0, 4 * std::sqrt(1.0 / 3 / 2000));
    EXPECT_NEAR(squares / 2000, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / 2000));
  }
  for (std::size_t i = 0; i < data.rows(); ++i) {
    EXPECT_EQ(data.episode[i], static_cast<std::int64_t>(i));
    EXPECT_NEAR(data.next(i, 1), data.states(i, 1) + 0.5 * data.actions(i, 0), 1e-12) << "v' = v + 0.5 a";
  }
}

TEST(Collect, AsksForEpisodesOrSamples) {
  const auto error = [](const std::vector<std::pair<std::string, std::string>>& attributes) {
    return error_of([&] { make_node(element("collect", attributes)); });
  };
  EXPECT_THAT(error({{"id", "c"}, {"problem", "car"}}), HasSubstr("either episodes"));
  EXPECT_THAT(error({{"id", "c"}, {"problem", "car"}, {"samples", "3"}, {"episodes", "3"}, {"policy", "p"}}),
              HasSubstr("either episodes"));
  EXPECT_THAT(error({{"id", "c"}, {"problem", "car"}, {"episodes", "3"}}), HasSubstr("need a policy"));
  EXPECT_THAT(error({{"id", "c"}, {"problem", "car"}, {"samples", "3"}, {"policy", "p"}}),
              HasSubstr("without a policy"));
  EXPECT_THAT(error({{"id", "c"}, {"problem", "car"}, {"samples", "3"}, {"horizon", "2"}}),
              HasSubstr("no horizon"));
}

TEST(Collect, EndsWhenAskedTo) {
  FakeContext context;
  context.given["problem"] = {input(problem_element())};
  context.given["policy"] = {input(element("policy", {{"id", "random"}}, {element("random", {})}))};
  context.serial.patience = 1;
  const Sub<Node> node = make_node(
      element("collect", {{"id", "c"}, {"problem", "car"}, {"policy", "random"}, {"episodes", "100"}}));
  EXPECT_THROW(node->run(context), Interrupted);
  EXPECT_FALSE(std::filesystem::exists(context.folder() / kDatasetFile));
}

}  // namespace
}  // namespace coppice::testing
