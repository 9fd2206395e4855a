#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/vocabulary/solver.h"
#include "tests/engine/graph/nodes/fake_context.h"

namespace coppice::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Attributes = std::vector<std::pair<std::string, std::string>>;

/// Pretends to learn: after n units the "policy" is a constant made of n draws and of the samples' rewards.
class FakeTraining : public Training {
 public:
  FakeTraining(int units, const TrainingInputs& inputs) : units_(units), inputs_(inputs) {}

  bool advance(Parallel&) override {
    ++done_;
    sum_ += inputs_.draws.uniform("fake_learning", 0, 1, static_cast<std::uint32_t>(done_));
    return done_ < units_;
  }
  TrainingProgress progress() const override {
    TrainingProgress progress{done_, units_, {{"sum", sum_}}};
    if (done_ % 2 == 0) progress.measures.emplace_back("even", done_);
    return progress;
  }
  void save(Archive& archive) const override {
    archive.put("done", std::vector<std::int64_t>{done_});
    archive.put("sum", std::vector<double>{sum_});
  }
  void load(Archive& archive) override {
    done_ = archive.get<std::vector<std::int64_t>>("done").at(0);
    sum_ = archive.get<std::vector<double>>("sum").at(0);
  }
  TrainingResult result() const override {
    double value = sum_;
    if (inputs_.samples != nullptr) value += static_cast<double>(inputs_.samples->rows());
    Element constant = element("constant", {{"values", std::to_string(value / 1000)}});
    Diagnostics diagnostics;
    return {make<Policy>(constant, diagnostics), {}};
  }

 private:
  std::int64_t units_, done_ = 0;
  double sum_ = 0;
  const TrainingInputs inputs_;
};

struct FakeSolver : Solver {
  int units = 6;
  bool samples = false, simulator = false, single_action = false, value = false, policy = false;

  Needs needs() const override { return {samples, simulator, single_action, value, policy}; }
  std::vector<std::string> measures(bool) const override { return {"sum", "even"}; }
  std::unique_ptr<Training> start(const TrainingInputs& inputs) const override {
    return std::make_unique<FakeTraining>(units, inputs);
  }
  static Parameters<FakeSolver> parameters() {
    return Parameters<FakeSolver>()
        .add("units", &FakeSolver::units, "", "Units of work.", at_least(1))
        .add("samples", &FakeSolver::samples, "", "Needs samples.")
        .add("simulator", &FakeSolver::simulator, "", "Needs a simulator.")
        .add("single_action", &FakeSolver::single_action, "", "Needs a single action.")
        .add("value", &FakeSolver::value, "", "Uses a value function.")
        .add("policy", &FakeSolver::policy, "", "Uses a policy.");
  }
};
const Component<Solver, FakeSolver> kFakeSolver("fake_solver", "Learns nothing.", "no publication");

/// Two actions, and only episodes: no simulator.
class FakeLiveProblem : public Problem {
 public:
  const Spaces& spaces() const override { return spaces_; }
  double discount() const override { return 1; }
  int horizon() const override { return 1; }
  Returns episodes(const Simulation&, const Draws&, Parallel&) const override { return {}; }
  static Parameters<FakeLiveProblem> parameters() { return {}; }

 private:
  Spaces spaces_{{{"x", "m", 0, 1}}, {{"left", {}}, {"right", {}}}};
};
const Component<Problem, FakeLiveProblem> kFakeProblem("fake_live_problem", "A robot.", "no publication");

Element collect(const std::string& id) {
  return element("collect", {{"id", id}, {"problem", "car"}, {"policy", "p"}, {"episodes", "1"}});
}

Sub<Node> training(Attributes solver = {}, Attributes more = {}) {
  more.insert(more.begin(), {{"id", "t"}, {"problem", "car"}});
  return make_node(element("train", more, {element("fake_solver", solver)}));
}

void give_problem(FakeContext& context, const std::string& problem = "double_integrator") {
  context.given["problem"] = {input(element("problem", {{"id", "car"}}, {element(problem, {})}))};
}

TEST(Train, WritesThePolicyAndARowForEachUnitOfWork) {
  FakeContext context;
  give_problem(context);
  const auto node = training();
  node->check(context);
  node->run(context);
  const PolicyFile policy = read_policy_file(context.folder() / kPolicyFile);
  EXPECT_EQ(policy.component.name, "constant");
  EXPECT_EQ(policy.provenance, context.key());
  EXPECT_EQ(policy.spaces.states.front().name, "position");
  const Table progress = read_table(context.folder() / kProgressFile);
  ASSERT_EQ(progress.rows.size(), 6u);
  ASSERT_EQ(progress.columns.size(), 3u);
  const std::vector<std::string> planned = node->progress_columns(context);
  ASSERT_EQ(planned.size(), 3u);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(progress.columns[c].name, planned[c]);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(number(progress.rows[static_cast<std::size_t>(i)][0]), i + 1);
  EXPECT_EQ(cell_text(progress.rows[0][progress.column("even")]), "") << "that unit did not measure it";
  EXPECT_EQ(number(progress.rows[1][progress.column("even")]), 2);
  EXPECT_EQ(context.counts.at("iterations"), 6);
}

TEST(Train, ResumedGivesTheBytesOfATrainingNeverStopped) {
  FakeContext straight, stopped;
  for (FakeContext* context : {&straight, &stopped}) give_problem(*context);
  const auto node = training();
  node->run(straight);
  int interruptions = 0;
  for (;; ++interruptions) {
    stopped.serial.patience = 2;  // two units of work each time
    try {
      node->run(stopped);
      break;
    } catch (const Interrupted&) {
      ASSERT_LT(interruptions, 5);
    }
  }
  EXPECT_EQ(interruptions, 2);
  for (const auto& file : {kPolicyFile, kProgressFile}) {
    EXPECT_EQ(text_of(stopped.folder() / file), text_of(straight.folder() / file));
  }
}

TEST(Train, BeginsAnewAfterAnUnreadableCheckpoint) {
  FakeContext straight, damaged;
  for (FakeContext* context : {&straight, &damaged}) give_problem(*context);
  const auto node = training();
  node->run(straight);
  damaged.saved.emplace();
  damaged.saved->put("training/done", std::vector<std::int64_t>{3});
  damaged.saved->put("training/sum", std::vector<double>{1e9});
  node->run(damaged);
  EXPECT_EQ(text_of(damaged.folder() / kPolicyFile), text_of(straight.folder() / kPolicyFile));
}

TEST(Train, JoinsTheSamplesOfSeveralNodes) {
  FakeContext one, two, both;
  FakeContext* collecting[] = {&one, &two};
  for (FakeContext* context : collecting) {
    give_problem(*context);
    context->given["policy"] = {input(element("policy", {{"id", "p"}}, {element("random", {})}))};
    make_node(collect("c"))->run(*context);
  }
  give_problem(both);
  both.given["samples"] = {input(collect("c"), one.folder()), input(collect("d"), two.folder())};
  training({{"samples", "true"}}, {{"samples", "c, d"}})->run(both);
  EXPECT_EQ(both.counts.at("samples"), one.counts.at("steps") + two.counts.at("steps"));
}

TEST(Train, RefusesSamplesThatAreThereTwice) {
  FakeContext context;
  give_problem(context);
  const auto data = [](const std::string& id, const std::string& stream, const std::string& file = {}) {
    InputNode made = input(collect(id));
    if (!stream.empty()) made.streams = {stream, "evaluate 0"};
    if (!file.empty()) made.element = shared(element("dataset", {{"id", id}, {"file", file}}));
    return made;
  };
  const auto error = [&](std::vector<InputNode> samples) {
    context.given["samples"] = std::move(samples);
    return error_of([&] { training({{"samples", "true"}}, {{"samples", "c, d"}})->check(context); });
  };
  EXPECT_THAT(
      error({data("a", "more 0"), data("c", "collect 0"), data("c", "collect 1"), data("d", "collect 1")}),
      AllOf(HasSubstr("samples 'c' and 'd' come from the same draws (collect 1)"),
            HasSubstr("give 'd' a seed_label of its own")));
  EXPECT_THAT(error({data("e", "", "log.csv"), data("f", "", "log.csv")}),
              HasSubstr("samples 'e' and 'f' are the same file"));
  EXPECT_EQ(error({data("c", "collect 0"), data("c", "collect 1"), data("d", "more 0"),
                   data("e", "", "log.csv"), data("f", "", "other.csv")}),
            "");
}

TEST(Train, SaysWhatTheSolverNeeds) {
  FakeContext car, live;
  give_problem(car);
  give_problem(live, "fake_live_problem");
  const auto error = [](const FakeContext& context, const Attributes& solver) {
    return error_of([&] { training(solver)->check(context); });
  };
  EXPECT_THAT(error(car, {{"samples", "true"}}), HasSubstr("give samples="));
  EXPECT_EQ(error(car, {{"simulator", "true"}, {"single_action", "true"}}), "");
  EXPECT_THAT(error(live, {{"simulator", "true"}}), HasSubstr("only offers episodes"));
  EXPECT_THAT(error(live, {{"single_action", "true"}}), HasSubstr("has 2 actions"));
  EXPECT_THAT(error(live, {{"samples", "true"}, {"single_action", "true"}}),
              AllOf(HasSubstr("give samples="), HasSubstr("has 2 actions")));
}

TEST(Train, RefusesWhatTheSolverMakesNoUseOf) {
  FakeContext context;
  give_problem(context);
  context.given["value"].emplace_back().id = "v";
  context.given["policy"] = {input(element("policy", {{"id", "p"}}, {element("random", {})}))};
  const auto error = [&](const Attributes& solver) {
    return error_of([&] { training(solver, {{"value", "v"}, {"policy", "p"}})->check(context); });
  };
  EXPECT_THAT(error({}), AllOf(HasSubstr("<fake_solver> makes no use of value=\"v\""),
                               HasSubstr("<fake_solver> makes no use of policy=\"p\""),
                               HasSubstr("<fake_solver> takes problem, samples")));
  EXPECT_THAT(error({{"value", "true"}}), AllOf(Not(HasSubstr("value=")), HasSubstr("policy=\"p\""),
                                                HasSubstr("takes problem, samples, value")));
  EXPECT_EQ(error({{"value", "true"}, {"policy", "true"}}), "");
}

}  // namespace
}  // namespace coppice::testing
