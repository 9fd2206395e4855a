#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "tests/engine/graph/nodes/fake_context.h"
#include "tests/engine/graph/nodes/line_optimizer.h"

namespace coppice::testing {
namespace {

using ::testing::HasSubstr;
using Attributes = std::vector<std::pair<std::string, std::string>>;

const Component<Optimizer, LineOptimizer> kLine("line_of_test", "Tries a line.", "no publication");

Sub<Node> tuning(Attributes more = {}, const std::string& parameters = "gains") {
  Attributes attributes = {
      {"id", "tuned"}, {"problem", "car"}, {"policy", "law"}, {"parameters", parameters}};
  attributes.insert(attributes.end(), more.begin(), more.end());
  return make_node(element("optimize", attributes, {element("line_of_test", {})}));
}

void give(FakeContext& context, const std::string& gains = "0.5, 1", const std::string& start = "fixed") {
  context.given["problem"] = {
      input(element("problem", {{"id", "car"}}, {element("double_integrator", {{"start", start}})}))};
  context.given["policy"] = {
      input(element("policy", {{"id", "law"}}, {element("linear_feedback", {{"gains", gains}})}))};
}

const Attributes kLimits = {{"low", "0.487, 0.977"}, {"high", "0.887, 1.377"}, {"budget", "9"}};

TEST(Optimize, MakesThePolicyWithTheBestNumbers) {
  FakeContext context;
  give(context);
  const Sub<Node> node = tuning(kLimits);
  node->check(context);
  node->run(context);
  const PolicyFile best = read_policy_file(context.folder() / kPolicyFile);
  EXPECT_EQ(best.component.name, "linear_feedback");
  const Table optimum = read_table(context.folder() / "optimum.csv");
  ASSERT_EQ(optimum.rows.size(), 2u);
  EXPECT_NEAR(number(optimum.rows[0][optimum.column("value")]), 0.687, 1e-12)
      << "the optimum lies in the middle";
  EXPECT_NEAR(number(optimum.rows[1][optimum.column("value")]), 1.177, 1e-12);
  const Table search = read_table(context.folder() / "search.csv");
  EXPECT_EQ(number(search.rows[0][search.column("evaluations")]), 9);
  EXPECT_EQ(number(search.rows[0][search.column("not_finite")]), 0);
  EXPECT_NEAR(number(search.rows[0][search.column("best_value")]), -3.4227, 1e-3)
      << "as dynamic programming says";
  const Table history = read_table(context.folder() / kProgressFile);
  EXPECT_EQ(history.columns.back().name, "told");
  EXPECT_EQ(number(history.rows.back()[0]), 9);
  EXPECT_EQ(context.counts.at("evaluations"), 9);
}

/// Pushes with its level; refuses levels above 0.6.
struct CautiousPolicy : Policy {
  double level = 0;
  void prepare(const Spaces&, const Simulator*) override {}
  void act(std::span<const double>, std::span<double>, const Draws&, Action& action) const override {
    action.id = 0;
    action.values = Vec<kMaxActionSize>{level};
  }
  void check() const {
    if (level > 0.6) throw std::invalid_argument("a level of " + std::to_string(level) + " is too much");
  }
  static Parameters<CautiousPolicy> parameters() {
    return Parameters<CautiousPolicy>().add("level", &CautiousPolicy::level, "", "Force.");
  }
};
const Component<Policy, CautiousPolicy> kCautious("cautious_of_test", "Pushes a little.", "no publication");

TEST(Optimize, SaysWhichNumbersFailedAndKeepsTheHistory) {
  FakeContext context;
  give(context);
  context.given["policy"] = {input(element("policy", {{"id", "law"}}, {element("cautious_of_test", {})}))};
  const Sub<Node> node = tuning({{"low", "0"}, {"high", "1"}, {"budget", "11"}}, "level");
  node->check(context);
  const std::string message = error_of([&] { node->run(context); });
  EXPECT_THAT(message, HasSubstr("evaluation 8 of 11 failed, of level = 0.7"));  // 0, 0.1, ..., 0.7
  EXPECT_THAT(message, HasSubstr("a level of 0.7"));
  const Table history = read_table(context.folder() / kProgressFile);
  ASSERT_EQ(history.rows.size(), 2u);
  EXPECT_EQ(number(history.rows.back()[0]), 6);
}

TEST(Optimize, GoesOnWhereItWasStopped) {
  FakeContext whole, stopped;
  for (FakeContext* context : {&whole, &stopped}) give(*context, "0.5, 1", "uniform");
  const Sub<Node> node = tuning(kLimits);
  node->run(whole);
  stopped.serial.patience = 2;
  EXPECT_THROW(node->run(stopped), Interrupted);
  ASSERT_TRUE(stopped.saved.has_value());
  stopped.serial.patience = -1;
  node->run(stopped);
  for (const std::string file : {"policy.policy", "progress.csv", "optimum.csv", "search.csv"}) {
    EXPECT_EQ(text_of(whole.folder() / file), text_of(stopped.folder() / file)) << file;
  }
}

/// Best value when all candidates are the same point.
double value_of_one_point(bool common, const std::string& budget) {
  FakeContext context;
  give(context, "0.5, 1", "uniform");
  const Sub<Node> node = tuning({{"low", "0.5, 1"},
                                 {"high", "0.5, 1"},
                                 {"budget", budget},
                                 {"common_scenarios", common ? "true" : "false"}});
  node->run(context);
  const Table search = read_table(context.folder() / "search.csv");
  return number(search.rows[0][search.column("best_value")]);
}

TEST(Optimize, LetsComparedCandidatesMeetTheSameScenarios) {
  FakeContext one;
  give(one, "0.5, 1", "uniform");
  tuning({{"low", "0.5, 1"}, {"high", "0.5, 1"}, {"budget", "1"}})->run(one);
  const Table search = read_table(one.folder() / "search.csv");
  const double first = number(search.rows[0][search.column("best_value")]);
  EXPECT_EQ(value_of_one_point(true, "3"), first) << "three times the same scenario";
  EXPECT_GT(value_of_one_point(false, "30"), first) << "the luckiest of thirty";
}

TEST(Optimize, SaysWhatCannotBeTuned) {
  const auto refused = [](const Sub<Node>& node, const std::string& gains = "0.5, 1") {
    FakeContext context;
    give(context, gains);
    return error_of([&] { node->check(context); });
  };
  const Attributes budget = {{"budget", "9"}};
  EXPECT_THAT(refused(tuning(kLimits, "gain")), HasSubstr("did you mean 'gains'"));
  EXPECT_THAT(refused(tuning(kLimits, "action")), HasSubstr("no number or list of numbers 'action'"));
  EXPECT_THAT(refused(tuning(kLimits, "offset")), HasSubstr("no numbers to begin with"));
  EXPECT_THAT(refused(tuning(kLimits, "gains, gains")), HasSubstr("names 'gains' twice"));
  EXPECT_THAT(refused(tuning({{"low", "0, 0, 0"}, {"high", "2"}, {"budget", "9"}})),
              HasSubstr("low has 3 numbers"));
  EXPECT_THAT(refused(tuning({{"low", "2"}, {"high", "0"}, {"budget", "9"}})),
              HasSubstr("expected are two in order"));
  EXPECT_THAT(refused(tuning({{"low", "1"}, {"high", "2"}, {"budget", "9"}})),
              HasSubstr("gains_0 begins at 0.5"));
  EXPECT_THAT(refused(tuning(budget)), HasSubstr("finite limits"));
  EXPECT_THAT(refused(tuning(kLimits), "0.5, 1, 1"), HasSubstr("numbers"));
}

TEST(Optimize, RefusesLearnedPolicies) {
  FakeContext context;
  give(context);
  context.given["policy"].front().kind = "train";
  EXPECT_THAT(error_of([&] { tuning(kLimits)->check(context); }), HasSubstr("no parameters to tune"));
}

}  // namespace
}  // namespace coppice::testing
