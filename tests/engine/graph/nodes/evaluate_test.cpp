#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/statistics/estimates.h"
#include "engine/statistics/mean_estimate.h"
#include "tests/engine/graph/nodes/fake_context.h"

namespace coppice::testing {
namespace {

using ::testing::HasSubstr;
using Attributes = std::vector<std::pair<std::string, std::string>>;

void give(FakeContext& context, const Attributes& problem, const Element& policy) {
  context.given["problem"] = {
      input(element("problem", {{"id", "car"}}, {element("double_integrator", problem)}))};
  context.given["policies"] = {input(element("policy", {{"id", "p"}}, {policy}))};
}

Sub<Node> evaluation(Attributes attributes) {
  attributes.insert(attributes.begin(), {{"id", "e"}, {"problem", "car"}, {"policies", "p"}});
  return make_node(element("evaluate", attributes));
}

double value(const FakeContext& context, const char* column) {
  const Table table = read_table(context.folder() / kEvaluationFile);
  return number(table.rows.at(0).at(table.column(column)));
}

/// The linear-quadratic regulator of the double integrator: optimal, since no constraint binds.
const Element kRegulator = element("linear_feedback", {{"gains", "0.687, 1.177"}});

TEST(Evaluate, AgreesWithTheRiccatiSolution) {
  FakeContext context;
  give(context, {}, kRegulator);
  const Sub<Node> node = evaluation({{"episodes", "3"}});
  node->check(context);
  node->run(context);
  EXPECT_NEAR(value(context, "mean_cost"), 3.4227, 1e-3);
  EXPECT_NEAR(value(context, "mean_discounted_return"), -3.3457, 1e-3);
  EXPECT_EQ(value(context, "mean_return"), -value(context, "mean_cost"));
  EXPECT_EQ(value(context, "episodes"), 3);
  EXPECT_EQ(value(context, "mean_steps"), 200);
  EXPECT_EQ(value(context, "terminal_rate"), 0);
  EXPECT_EQ(value(context, "sd"), 0) << "nothing is random here";
  EXPECT_EQ(value(context, "horizon"), 200);
  EXPECT_EQ(value(context, "discount"), 0.98);
  EXPECT_EQ(context.counts.at("steps"), 600);
  EXPECT_GT(context.measures.at("action"), 0);
  EXPECT_GT(context.measures.at("episode"), 0);
}

TEST(Evaluate, TakesItsOwnHorizonAndDiscountBeforeTheProblems) {
  FakeContext context;
  give(context, {}, kRegulator);
  evaluation({{"episodes", "1"}, {"horizon", "1"}, {"discount", "0"}})->run(context);
  // One step from (1, 0): p^2 + a^2 with a = -0.687.
  EXPECT_NEAR(value(context, "mean_cost"), 1 + 0.687 * 0.687, 1e-12);
  EXPECT_EQ(value(context, "mean_steps"), 1);
  EXPECT_EQ(value(context, "discount"), 0);
  EXPECT_TRUE(std::isnan(value(context, "ci95_low"))) << "one episode tells nothing of the spread";
}

TEST(Evaluate, SummarizesTheReturnsOfItsEpisodes) {
  FakeContext context;
  give(context, {{"start", "uniform"}}, element("random", {}));
  evaluation({{"episodes", "50"}})->run(context);
  const Table returns = read_table(context.folder() / kReturnsFile);
  ASSERT_EQ(returns.rows.size(), 50u);
  std::vector<double> totals;
  double terminal = 0;
  for (const std::vector<Cell>& row : returns.rows) {
    totals.push_back(number(row[returns.column("return")]));
    terminal += number(row[returns.column("terminal")]);
  }
  const Interval ci = *confidence_interval(mean_estimate(totals));
  EXPECT_EQ(value(context, "mean_return"), mean(totals));
  EXPECT_EQ(value(context, "sd"), standard_deviation(totals));
  EXPECT_EQ(value(context, "ci95_low"), ci.low);
  EXPECT_EQ(value(context, "ci95_high"), ci.high);
  EXPECT_EQ(value(context, "terminal_rate"), terminal / 50) << "a count is divided once";
  EXPECT_GT(terminal, 25) << "who acts at random leaves the box";
}

TEST(Evaluate, PutsEveryPolicyIntoTheSameScenarios) {
  const auto starts = [](const Element& policy) {
    FakeContext context;
    give(context, {{"start", "uniform"}, {"penalty", "0"}}, policy);
    evaluation({{"episodes", "20"}, {"horizon", "1"}})->run(context);
    // Without a force, the cost of the first step is the squared position, unless it leaves.
    const Table table = read_table(context.folder() / kReturnsFile);
    std::vector<double> costs;
    for (const std::vector<Cell>& row : table.rows) {
      const bool left = number(row[table.column("terminal")]) != 0;
      costs.push_back(left ? std::nan("") : -number(row[table.column("return")]));
    }
    return costs;
  };
  const std::vector<double> still = starts(element("constant", {{"values", "0"}}));
  const std::vector<double> pushed = starts(element("constant", {{"values", "0.25"}}));
  int compared = 0;
  for (std::size_t k = 0; k < still.size(); ++k) {
    if (std::isnan(still[k]) || std::isnan(pushed[k])) continue;
    EXPECT_NEAR(pushed[k], still[k] + 0.0625, 1e-12);
    ++compared;
  }
  EXPECT_GT(compared, 5);
}

TEST(Evaluate, GoesOnFromItsCheckpointToTheSameBytes) {
  const auto node = evaluation({{"episodes", "200"}});
  FakeContext straight, stopped;
  for (FakeContext* context : {&straight, &stopped})
    give(*context, {{"start", "uniform"}}, element("random", {}));
  node->run(straight);
  stopped.serial.patience = 3;
  EXPECT_THROW(node->run(stopped), Interrupted);
  EXPECT_GT(stopped.progress_done, 0);
  EXPECT_LT(stopped.progress_done, 200);
  ASSERT_TRUE(stopped.saved);
  node->run(stopped);
  for (const auto& file : {kEvaluationFile, kReturnsFile}) {
    EXPECT_EQ(text_of(stopped.folder() / file), text_of(straight.folder() / file));
  }
  EXPECT_EQ(stopped.counts.at("steps"), straight.counts.at("steps"));
}

TEST(Evaluate, BeginsAnewAfterAnUnreadableCheckpoint) {
  const auto node = evaluation({{"episodes", "5"}});
  FakeContext context;
  give(context, {}, kRegulator);
  context.saved.emplace();
  context.saved->put("total", std::vector<double>{1, 2, 3});  // and nothing else
  node->run(context);
  EXPECT_NEAR(value(context, "mean_cost"), 3.4227, 1e-3);
}

TEST(Evaluate, LeavesOutTheReturnsOnRequest) {
  FakeContext context;
  give(context, {}, kRegulator);
  evaluation({{"episodes", "1"}, {"returns", "false"}})->run(context);
  EXPECT_FALSE(std::filesystem::exists(context.folder() / kReturnsFile));
}

TEST(Evaluate, RefusesToJudgeAPolicyByTheDrawsThatMadeIt) {
  FakeContext context;
  give(context, {}, kRegulator);
  context.given["policies"].front().streams = {"train 0", "test 0"};
  EXPECT_THAT(error_of([&] { evaluation({{"episodes", "1"}})->check(context); }), HasSubstr("seed_label"));
}

TEST(Evaluate, RefusesAPolicyThatDoesNotFitTheProblem) {
  FakeContext context;
  give(context, {}, element("linear_feedback", {{"gains", "1, 2, 3"}}));
  EXPECT_THAT(error_of([&] { evaluation({{"episodes", "1"}})->check(context); }), HasSubstr("gains has 3"));
}

}  // namespace
}  // namespace coppice::testing
