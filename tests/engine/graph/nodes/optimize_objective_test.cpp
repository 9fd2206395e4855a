#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/vocabulary/objective.h"
#include "tests/engine/graph/nodes/fake_context.h"
#include "tests/engine/graph/nodes/line_optimizer.h"

namespace coppice::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Attributes = std::vector<std::pair<std::string, std::string>>;
using Values = std::vector<double>;

/// Its value is its input, but for what goes wrong above 0.3.
struct Brittle : Objective {
  enum class Fault { throws, gives_nan, gives_infinity };
  Fault fault = Fault::throws;

  class Function : public ObjectiveFunction {
   public:
    explicit Function(Fault fault) : fault_(fault) {}
    const Space& box() const override { return box_; }
    double evaluate(std::span<const double> x, const Draws&) const override {
      if (x[0] <= 0.3) return x[0];
      if (fault_ == Fault::throws) throw std::runtime_error("the gripper is stuck");
      if (fault_ == Fault::gives_nan) return std::numeric_limits<double>::quiet_NaN();
      return std::numeric_limits<double>::infinity();
    }
    bool noisy() const override { return false; }

   private:
    Fault fault_;
    Space box_{{"x0", "", -1, 1}};
  };
  std::unique_ptr<const ObjectiveFunction> draw(const Draws&) const override {
    return std::make_unique<Function>(fault);
  }
  static Parameters<Brittle> parameters() {
    return Parameters<Brittle>().choice("fault", &Brittle::fault, {"throws", "gives_nan", "gives_infinity"},
                                        "What goes wrong.");
  }
};
const Component<Objective, Brittle> kBrittle("brittle_of_test", "Fails above 0.3.", "no publication");

/// Nine points of the line from -1 to 1 in every input.
Sub<Node> searching(Attributes more = {}) {
  Attributes attributes = {
      {"id", "found"}, {"objective", "f"}, {"low", "-1"}, {"high", "1"}, {"budget", "9"}};
  attributes.insert(attributes.end(), more.begin(), more.end());
  return make_node(element("optimize", attributes, {element("line_of_test", {})}));
}

void give(FakeContext& context, const Element& family) {
  context.given["objective"] = {input(element("objective", {{"id", "f"}}, {family}))};
}
Element sphere(Attributes more = {}) {
  Attributes attributes = {{"n", "2"}, {"spread", "0"}};
  attributes.insert(attributes.end(), more.begin(), more.end());
  return element("sphere", attributes);
}

Values column(const FakeContext& context, std::string_view file, const std::string& name) {
  const Table table = read_table(context.folder() / file);
  Values values;
  for (const std::vector<Cell>& row : table.rows) values.push_back(number(row[table.column(name)]));
  return values;
}

TEST(OptimizeObjective, SaysHowNearItCameAndWhen) {
  FakeContext context;
  give(context, sphere());
  const Sub<Node> node = searching({{"targets", "10, 1, 0.2, 0"}});
  node->check(context);
  node->run(context);
  // Both inputs are -1, -0.75, ..., 1: the loss is twice the square.
  EXPECT_THAT(column(context, kImprovementsFile, "evaluations"), ElementsAre(1, 2, 3, 4, 5));
  EXPECT_THAT(column(context, kImprovementsFile, "gap"), ElementsAre(2, 1.125, 0.5, 0.125, 0));
  EXPECT_THAT(column(context, kTargetsFile, "target"), ElementsAre(10, 1, 0.2, 0));
  EXPECT_THAT(column(context, kTargetsFile, "evaluations"), ElementsAre(1, 3, 4, 5));
  EXPECT_THAT(column(context, kOptimumFile, "value"), ElementsAre(0, 0));
  for (const auto& [name, value] : std::map<std::string, double>{{"evaluations", 9},
                                                                 {"not_finite", 0},
                                                                 {"best_value", 0},
                                                                 {"best_observed", 0},
                                                                 {"dimension", 2},
                                                                 {"true_value", 0},
                                                                 {"optimum", 0},
                                                                 {"gap", 0}}) {
    EXPECT_THAT(column(context, kSearchFile, name), ElementsAre(value)) << name;
  }
  EXPECT_EQ(column(context, kProgressFile, "gap").back(), 0);
  EXPECT_THAT(text_of(context.folder() / kSearchFile), HasSubstr("budget"));
}

TEST(OptimizeObjective, LeavesTargetsThatWereNotReachedEmpty) {
  FakeContext context;
  give(context, element("sphere", {{"n", "1"}, {"spread", "0"}}));
  searching({{"low", "1"}, {"high", "2"}, {"targets", "2, 0.9"}})->run(context);
  const Table targets = read_table(context.folder() / kTargetsFile);
  EXPECT_EQ(number(targets.rows[0][1]), 1);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(targets.rows[1][1]));
}

TEST(OptimizeObjective, EndsWhenItIsNearEnough) {
  FakeContext context;
  give(context, sphere());
  searching({{"stop_gap", "0.2"}})->run(context);
  EXPECT_THAT(column(context, kSearchFile, "evaluations"), ElementsAre(6)) << "three are asked at a time";
  EXPECT_THAT(text_of(context.folder() / kSearchFile), HasSubstr("target"));
}

TEST(OptimizeObjective, JudgesNoisyFunctionsByTheirTrueValues) {
  FakeContext context;
  give(context, sphere({{"noise", "3"}}));
  searching()->run(context);
  EXPECT_THAT(column(context, kImprovementsFile, "gap"), ElementsAre(2, 1.125, 0.5, 0.125, 0));
  const Values found = column(context, kOptimumFile, "value");
  EXPECT_EQ(column(context, kSearchFile, "gap").front(), found[0] * found[0] + found[1] * found[1]);
  EXPECT_GT(column(context, kSearchFile, "best_observed").front(), 0) << "the luckiest of nine";
}

TEST(OptimizeObjective, GivesEveryEvaluationNoiseOfItsOwnUnlessAskedTo) {
  const auto observed = [](const std::string& common) {
    FakeContext context;
    give(context, sphere({{"noise", "1"}}));
    searching({{"low", "0"}, {"high", "0"}, {"budget", "3"}, {"common_scenarios", common}})->run(context);
    FakeContext one;
    give(one, sphere({{"noise", "1"}}));
    searching({{"low", "0"}, {"high", "0"}, {"budget", "1"}})->run(one);
    return column(context, kSearchFile, "best_observed").front() -
           column(one, kSearchFile, "best_observed").front();
  };
  EXPECT_EQ(observed("true"), 0) << "three times the same noise";
  EXPECT_EQ(observed("auto"), observed("false"));
  EXPECT_GT(observed("auto"), 0) << "the luckiest of three";
}

TEST(OptimizeObjective, DrawsItsStartAndItsFunctionFromTheSeed) {
  std::vector<double> starts, optima;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    FakeContext context;
    context.seed = seed;
    give(context, element("sphere", {{"n", "1"}}));
    searching({{"low", "-5"}, {"high", "5"}, {"start_low", "-4"}, {"start_high", "4"}, {"budget", "1"}})
        ->run(context);
    starts.push_back(column(context, kOptimumFile, "start").front());
    optima.push_back(column(context, kSearchFile, "gap").front());  // (-5 - optimum)^2
  }
  EXPECT_GE(*std::min_element(starts.begin(), starts.end()), -4);
  EXPECT_LE(*std::max_element(starts.begin(), starts.end()), 4);
  EXPECT_LT(*std::min_element(starts.begin(), starts.end()), -3);  // missed by chance: (7/8)^40 = 0.5 %
  EXPECT_GT(*std::max_element(starts.begin(), starts.end()), 3);
  EXPECT_NE(optima[0], optima[1]);
}

TEST(OptimizeObjective, GoesOnWhereItWasStopped) {
  FakeContext whole, stopped;
  for (FakeContext* context : {&whole, &stopped}) give(*context, sphere({{"noise", "1"}}));
  searching()->run(whole);
  stopped.serial.patience = 2;
  EXPECT_THROW(searching()->run(stopped), Interrupted);
  stopped.serial.patience = -1;
  searching()->run(stopped);
  for (const std::string_view file :
       {kProgressFile, kImprovementsFile, kTargetsFile, kOptimumFile, kSearchFile})
    EXPECT_EQ(text_of(whole.folder() / file), text_of(stopped.folder() / file)) << file;
}

TEST(OptimizeObjective, SaysWhichEvaluationFailedAndKeepsTheHistory) {
  FakeContext context;
  give(context, element("brittle_of_test", {}));
  try {
    searching()->run(context);
    FAIL() << "it did not fail";
  } catch (const Unfinished& failure) {  // -1, -0.75, ..., 0.25, 0.5
    EXPECT_EQ(std::string(failure.what()), "evaluation 7 of 9 failed, of x0 = 0.5: the gripper is stuck");
  }
  EXPECT_THAT(column(context, kProgressFile, "iteration"), ElementsAre(3, 6));
  EXPECT_THAT(column(context, kProgressFile, "best_value"), ElementsAre(-0.5, 0.25));
  EXPECT_THAT(column(context, kImprovementsFile, "value"), ElementsAre(-1, -0.75, -0.5, -0.25, 0, 0.25));
}

TEST(OptimizeObjective, CountsWhatIsNotFinite) {
  for (const char* fault : {"gives_nan", "gives_infinity"}) {
    FakeContext context;
    give(context, element("brittle_of_test", {{"fault", fault}}));
    searching()->run(context);
    EXPECT_THAT(column(context, kSearchFile, "not_finite"), ElementsAre(3)) << fault;  // 0.5, 0.75, 1
    EXPECT_THAT(column(context, kSearchFile, "best_observed"), ElementsAre(0.25)) << fault;
    EXPECT_EQ(column(context, kImprovementsFile, "value").back(), 0.25) << fault;
  }
}

TEST(OptimizeObjective, RefusesWhatItMakesNoUseOf) {
  const auto refused = [](Attributes more, const Element& family) {
    FakeContext context;
    give(context, family);
    return error_of([&] { searching(std::move(more))->check(context); });
  };
  EXPECT_THAT(refused({{"episodes", "4"}}, sphere()), HasSubstr("makes no use of"));
  EXPECT_THAT(refused({{"policy", "p"}}, sphere()), HasSubstr("makes no use of"));
  EXPECT_THAT(refused({{"start_low", "-4"}}, sphere()), HasSubstr("go together"));
  EXPECT_THAT(refused({{"start_low", "-4"}, {"start_high", "4"}}, sphere()), HasSubstr("in [-1, 1]"));
  EXPECT_THAT(refused({{"stop_gap", "1"}}, element("brittle_of_test", {})), HasSubstr("optimum is known"));
  const Element nothing =
      element("optimize", {{"id", "found"}, {"budget", "9"}}, {element("line_of_test", {})});
  EXPECT_THAT(error_of([&] { make_node(nothing); }), HasSubstr("or an objective"));
}

}  // namespace
}  // namespace coppice::testing
