#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/vocabulary/optimizer.h"
#include "tests/engine/graph/nodes/fake_context.h"

namespace coppice::testing {
namespace {

using ::testing::HasSubstr;
using Attributes = std::vector<std::pair<std::string, std::string>>;

/// Tries points of a line from the lower to the upper limits, three at a time under one scenario number,
/// until the budget is spent.
class LineSearch : public Search {
 public:
  explicit LineSearch(SearchTask task) : task_(std::move(task)) {}

  Candidates ask(std::int64_t limit) override {
    const std::int64_t count = std::min({limit, task_.budget - told_, 3 - told_ % 3});
    Candidates candidates{Matrix(static_cast<std::size_t>(count), task_.box.size()), {}};
    for (std::size_t i = 0; i < candidates.points.rows(); ++i) {
      candidates.points.set_row(i, point(told_ + static_cast<std::int64_t>(i)));
      candidates.scenarios.push_back(static_cast<std::uint64_t>(told_ / 3));
    }
    return candidates;
  }
  void tell(std::span<const double> values) override {
    for (const double value : values) {
      if (told_ == 0 || value > best_value_) {
        best_ = point(told_);
        best_value_ = value;
      }
      ++told_;
    }
  }
  std::vector<double> best() const override { return best_; }
  double best_value() const override { return best_value_; }
  std::string stop_reason() const override { return told_ == task_.budget ? "budget" : ""; }
  std::vector<double> measures() const override { return {static_cast<double>(told_)}; }
  void save(Archive& archive) const override {
    archive.put("told", std::vector<std::int64_t>{told_});
    archive.put("best", best_);
    archive.put("best_value", std::vector<double>{best_value_});
  }
  void load(Archive& archive) override {
    told_ = archive.get<std::vector<std::int64_t>>("told").at(0);
    best_ = archive.get<std::vector<double>>("best");
    best_value_ = archive.get<std::vector<double>>("best_value").at(0);
  }

 private:
  std::vector<double> point(std::int64_t i) const {
    std::vector<double> x;
    const double share =
        task_.budget == 1 ? 0 : static_cast<double>(i) / static_cast<double>(task_.budget - 1);
    for (const Axis& axis : task_.box) x.push_back(axis.low + share * (axis.high - axis.low));
    return x;
  }

  const SearchTask task_;
  std::int64_t told_ = 0;
  std::vector<double> best_;
  double best_value_ = 0;
};

struct LineOptimizer : Optimizer {
  std::unique_ptr<Search> start(const SearchTask& task) const override {
    for (const Axis& axis : task.box) {
      if (!std::isfinite(axis.low) || !std::isfinite(axis.high))
        throw std::invalid_argument("the line needs finite limits");
    }
    return std::make_unique<LineSearch>(task);
  }
  std::vector<std::string> measures() const override { return {"told"}; }
  static Parameters<LineOptimizer> parameters() { return {}; }
};
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
