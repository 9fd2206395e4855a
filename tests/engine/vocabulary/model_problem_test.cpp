#include "engine/vocabulary/model_problem.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <mutex>

#include "tests/support/threads.h"

namespace coppice {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A walk on a line: the position moves by the action and by noise; right of the limit it ends.
struct Walk {
  double noise = 0;
  double limit = 10;
  std::size_t extra = 0;         // further axes that nothing changes
  double poison_position = 1e9;  // positions right of it become NaN
  double poison_reward = 1e9;    // rewards there become NaN

  using State = Vec<4>;

  Space states() const {
    Space axes = {{"position", "m", -100, 100}};
    for (std::size_t i = 0; i < extra; ++i) axes.push_back({"extra_" + std::to_string(i), "", 0, 1});
    return axes;
  }
  std::vector<ActionBox> actions() const { return {{"move", {{"distance", "m", -1, 1}}}, {"stay", {}}}; }
  State start(const Draws& draws) const {
    State state = {draws.uniform("position", 0, 1)};
    state.resize(1 + extra);
    return state;
  }
  Transition<State> step(const State& state, ActionRef action, const Draws& draws) const {
    State next = state;
    next[0] += (action.id == 0 ? action[0] : 0) + draws.uniform("position", -noise, noise);
    const double reward = next[0] > poison_reward ? kNaN : next[0];
    if (next[0] > poison_position) next[0] = kNaN;
    return {.next = next, .reward = reward, .terminal = next[0] > limit};
  }
};

struct WithMembers : Walk {
  double discount = 0.5;
  int horizon = 7;
};
struct WithFunctions : Walk {
  double discount() const { return 0.25; }
  int horizon() const { return 9; }
};

/// Moves by `distance` plus noise; counts its steps in its memory, and stays after `patience` of them.
class Mover : public Policy {
 public:
  explicit Mover(double distance, double noise = 0, int patience = 1 << 20)
      : distance_(distance), noise_(noise), patience_(patience) {}
  void prepare(const Spaces&, const Simulator*) override {}
  std::size_t memory_size() const override { return 1; }
  void act(std::span<const double>, std::span<double> memory, const Draws& draws,
           Action& action) const override {
    const bool stay = memory[0] >= patience_;
    memory[0] += 1;
    action.id = stay ? 1 : 0;
    action.values.resize(stay ? 0 : 1);
    if (!stay) action.values[0] = distance_ + draws.uniform("position", -noise_, noise_);
  }

 private:
  double distance_, noise_;
  int patience_;
};

/// 100 + 10 s.
class Value : public Function {
 public:
  std::size_t inputs() const override { return 1; }
  std::size_t outputs() const override { return 1; }
  void predict(std::span<const double> x, std::span<double> y) const override { y[0] = 100 + 10 * x[0]; }
  Maximum maximize(std::span<const double>, const Space&, const Maximization&) const override { return {}; }
  void save(Archive&) const override {}
  void load(Archive&) override {}
};

class Keeper : public Recorder {
 public:
  void episode(std::size_t rollout, std::uint64_t scenario, const Episode& episode) override {
    const std::lock_guard<std::mutex> lock(guard_);
    EXPECT_TRUE(episodes.emplace(rollout, episode).second) << "recorded twice";
    scenarios[rollout] = scenario;
  }
  std::map<std::size_t, Episode> episodes;
  std::map<std::size_t, std::uint64_t> scenarios;

 private:
  std::mutex guard_;
};

const Draws kDraws(1, "test", 0);

Matrix column(std::vector<double> values) {
  Matrix matrix(values.size(), 1);
  for (std::size_t i = 0; i < values.size(); ++i) matrix(i, 0) = values[i];
  return matrix;
}

Simulation simulation(const Policy& policy, std::size_t rollouts, int horizon) {
  Simulation made;
  made.policy = &policy;
  made.rollouts = rollouts;
  made.horizon = horizon;
  return made;
}

template <class M>
Returns run(const M& model, const Simulation& simulation) {
  Serial serial;
  return ModelProblem<M>(model, "walk").simulate(simulation, kDraws, serial);
}

template <class M>
std::string error_of(const M& model, const Simulation& simulation) {
  try {
    run(model, simulation);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(ModelProblem, TakesDiscountAndHorizonFromMembersFunctionsOrDefaults) {
  EXPECT_EQ(ModelProblem<Walk>({}, "w").discount(), 1.0);
  EXPECT_EQ(ModelProblem<Walk>({}, "w").horizon(), 100);
  EXPECT_EQ(ModelProblem<WithMembers>({}, "w").discount(), 0.5);
  EXPECT_EQ(ModelProblem<WithMembers>({}, "w").horizon(), 7);
  EXPECT_EQ(ModelProblem<WithFunctions>({}, "w").discount(), 0.25);
  EXPECT_EQ(ModelProblem<WithFunctions>({}, "w").horizon(), 9);
}

TEST(ModelProblem, RefusesSpacesThatDoNotFit) {
  Walk model;
  model.extra = 4;  // five axes in a state of capacity 4
  EXPECT_THROW(ModelProblem<Walk>(model, "walk"), std::logic_error);
}

// From 0 by steps of 1: rewards 1, 2, 3; discounted by 1/2: 1 + 1 + 3/4.
TEST(Simulate, SumsRewardsAndDiscountsThem) {
  const Mover mover(1);
  const Matrix starts = column({0.0});
  Simulation three = simulation(mover, 1, 3);
  three.starts = &starts;
  three.discount = 0.5;
  const Returns returns = run(Walk{}, three);
  EXPECT_EQ(returns.total[0], 6);
  EXPECT_EQ(returns.discounted[0], 2.75);
  EXPECT_EQ(returns.steps[0], 3);
  EXPECT_EQ(returns.terminal[0], 0);
}

TEST(Simulate, AddsTheTerminalValueWhereTheHorizonCuts) {
  const Mover mover(1);
  const Value value;
  const Matrix starts = column({0.0, 9.0});
  Simulation three = simulation(mover, 2, 3);
  three.starts = &starts;
  three.discount = 0.5;
  three.terminal_value = &value;
  const Returns returns = run(Walk{}, three);
  EXPECT_EQ(returns.discounted[0], 2.75 + 130.0 / 8);
  EXPECT_EQ(returns.total[0], 6);
  // The second ends in a terminal state after two steps (10 is not right of the limit, 11 is): no value is
  // added.
  EXPECT_EQ(returns.discounted[1], 10 + 5.5);
  EXPECT_EQ(returns.steps[1], 2);
  EXPECT_EQ(returns.terminal[1], 1);
}

TEST(Simulate, WithoutStepsGivesTheTerminalValueOfTheStart) {
  const Value value;
  const Matrix starts = column({2.0});
  Simulation none;
  none.rollouts = 1;
  none.starts = &starts;
  none.terminal_value = &value;
  EXPECT_EQ(run(Walk{}, none).discounted[0], 120);
}

TEST(Simulate, TakesTheFirstActionThenThePolicy) {
  const Mover mover(1);
  const Matrix starts = column({0.0, 0.0});
  std::vector<Action> first(2);
  first[0] = {0, {-0.5}};
  first[1].id = 1;
  Simulation two = simulation(mover, 2, 2);
  two.starts = &starts;
  two.first_actions = first;
  const Returns returns = run(Walk{}, two);
  EXPECT_EQ(returns.total[0], -0.5 + 0.5);
  EXPECT_EQ(returns.total[1], 0 + 1);
}

TEST(Simulate, OneGivenActionNeedsNoPolicy) {
  const Matrix starts = column({3.0});
  const std::vector<Action> first = {{0, {1.0}}};
  Simulation one;
  one.rollouts = 1;
  one.horizon = 1;
  one.starts = &starts;
  one.first_actions = first;
  EXPECT_EQ(run(Walk{}, one).total[0], 4);
}

TEST(Simulate, MovesActionsIntoTheirBoxBeforeTheModelSeesThem) {
  const Matrix starts = column({0.0});
  Keeper keeper;
  const Mover far(50);
  Simulation one = simulation(far, 1, 1);
  one.starts = &starts;
  one.recorder = &keeper;
  EXPECT_EQ(run(Walk{}, one).total[0], 1);
  EXPECT_EQ(keeper.episodes[0].actions[0], (Action{0, {1.0}}));
  const Mover lost(kNaN);
  one.policy = &lost;
  one.recorder = nullptr;
  EXPECT_EQ(run(Walk{}, one).total[0], 0);
}

TEST(Simulate, ResetsThePolicysMemoryForEachRollout) {
  const Mover mover(1, 0, 2);  // two steps, then it stays
  const Matrix starts = column({0.0, 0.0, 0.0});
  Simulation three = simulation(mover, 3, 4);
  three.starts = &starts;
  EXPECT_EQ(run(Walk{}, three).total, (std::vector<double>{7, 7, 7}));  // 1 + 2 + 2 + 2
}

TEST(Simulate, ScenariosAreCountedOrGiven) {
  Walk model;
  model.noise = 1;
  const Mover mover(0, 0.5);
  Simulation counted = simulation(mover, 6, 20);
  counted.first_scenario = 3;
  const Returns all = run(model, counted);
  const std::vector<std::uint64_t> chosen = {8, 4, 4};
  Simulation given = simulation(mover, 3, 20);
  given.scenarios = chosen;
  const Returns some = run(model, given);
  EXPECT_EQ(some.total, (std::vector<double>{all.total[5], all.total[1], all.total[1]}));
  EXPECT_NE(all.total[0], all.total[1]);
}

// Purposes of start, step and policy have the same name: their draws must differ all the same.
TEST(Simulate, DrawsOfStartStepAndPolicyDoNotCoincide) {
  Walk model;
  model.noise = 0.5;
  const Mover mover(0.5, 0.5);
  Keeper keeper;
  Simulation one = simulation(mover, 1, 1);
  one.recorder = &keeper;
  run(model, one);
  const double start = keeper.episodes[0].states[0];
  const double noise = keeper.episodes[0].states[1] - start - keeper.episodes[0].actions[0].values[0];
  EXPECT_NE(start, keeper.episodes[0].actions[0].values[0]);
  EXPECT_GT(std::fabs(noise + 0.5 - start), 1e-9);
  EXPECT_GT(std::fabs(noise + 0.5 - keeper.episodes[0].actions[0].values[0]), 1e-9);
}

// Two policies on scenario k meet the same noise, step by step, although their trajectories differ.
TEST(Simulate, PoliciesMeetTheSameScenarios) {
  Walk model;
  model.noise = 1;
  const Mover still(0), moving(0.25);
  Simulation one = simulation(still, 1, 10);
  Keeper first, second;
  one.recorder = &first;
  run(model, one);
  one.policy = &moving;
  one.recorder = &second;
  run(model, one);
  for (std::size_t t = 0; t <= 10; ++t) {
    EXPECT_NEAR(second.episodes[0].states[t] - first.episodes[0].states[t], 0.25 * static_cast<double>(t),
                1e-12);
  }
}

TEST(Simulate, ResultsDoNotDependOnThreads) {
  Walk model;
  model.noise = 1;
  model.limit = 3;
  const Mover mover(0.1, 0.5);
  Keeper alone, together;
  Simulation many = simulation(mover, 101, 50);
  many.recorder = &alone;
  const Returns expected = run(model, many);
  many.recorder = &together;
  Threads threads(4);
  const Returns returns = ModelProblem<Walk>(model, "walk").simulate(many, kDraws, threads);
  EXPECT_EQ(returns.total, expected.total);
  EXPECT_EQ(returns.discounted, expected.discounted);
  EXPECT_EQ(returns.steps, expected.steps);
  EXPECT_EQ(returns.terminal, expected.terminal);
  ASSERT_EQ(together.episodes.size(), 101u);
  for (std::size_t i = 0; i < 101; ++i) EXPECT_EQ(together.episodes[i].states, alone.episodes[i].states);
}

TEST(Simulate, StepsAgreeWithStartAndStep) {
  Walk model;
  model.noise = 1;
  const ModelProblem<Walk> problem(model, "walk");
  const Mover mover(0.1);
  Keeper keeper;
  Simulation one = simulation(mover, 1, 5);
  one.first_scenario = 9;
  one.recorder = &keeper;
  Serial serial;
  problem.simulate(one, kDraws, serial);
  std::vector<double> state(1), next(1);
  problem.start(kDraws.scenario(9), state);
  for (std::size_t t = 0; t < 5; ++t) {
    EXPECT_EQ(state[0], keeper.episodes[0].states[t]);
    double reward = 0;
    bool terminal = false;
    problem.step(state, {0, {0.1}}, kDraws.scenario(9).step(static_cast<std::uint32_t>(t)), next, reward,
                 terminal);
    EXPECT_EQ(reward, keeper.episodes[0].rewards[t]);
    state = next;
  }
}

TEST(Simulate, RunsStatesWhoseSizeIsKnownAtRunTime) {
  Walk model;
  model.extra = 2;
  Keeper keeper;
  const Mover mover(1);
  Simulation one = simulation(mover, 1, 2);
  one.recorder = &keeper;
  run(model, one);
  EXPECT_EQ(keeper.episodes[0].states.size(), 9u);
}

TEST(Simulate, SaysWhereANumberIsNotFinite) {
  const Matrix starts = column({0.5, 0.0});
  const std::vector<std::uint64_t> scenarios = {40, 41};
  const Mover mover(1);
  Simulation two = simulation(mover, 2, 10);
  two.starts = &starts;
  two.scenarios = scenarios;
  Walk model;
  model.poison_position = 3.2;
  EXPECT_EQ(error_of(model, two), "problem <walk>, scenario 40, step 2: state 'position' is nan");
  model = Walk{};
  model.poison_reward = 3.7;
  EXPECT_EQ(error_of(model, two), "problem <walk>, scenario 40, step 3: the reward is nan");
  const Matrix bad = column({0.0, kNaN});
  two.starts = &bad;
  EXPECT_EQ(error_of(Walk{}, two), "problem <walk>, scenario 41, step 0: state 'position' is nan");
}

TEST(Simulate, RefusesWhatDoesNotFit) {
  const Mover mover(1);
  const Matrix starts = column({0.0});
  const std::vector<Action> actions(3);
  const std::vector<std::uint64_t> scenarios(3);
  const auto message = [&](auto change) {
    Simulation two = simulation(mover, 2, 5);
    change(two);
    return error_of(Walk{}, two);
  };
  EXPECT_EQ(message([](Simulation&) {}), "");
  EXPECT_EQ(message([](Simulation& s) { s.policy = nullptr; }), "simulation: a policy is needed");
  EXPECT_EQ(message([](Simulation& s) { s.horizon = -1; }),
            "simulation: the horizon is -1, it must be at least 0");
  EXPECT_EQ(message([](Simulation& s) { s.discount = 1.5; }),
            "simulation: the discount is 1.5, it must be in [0, 1]");
  EXPECT_NE(message([](Simulation& s) { s.discount = kNaN; }), "");
  EXPECT_EQ(message([&](Simulation& s) { s.starts = &starts; }),
            "simulation: the start states are a 1 x 1 table, 2 x 1 is expected");
  EXPECT_EQ(message([&](Simulation& s) { s.first_actions = actions; }),
            "simulation: 3 first actions are given for 2 rollouts");
  EXPECT_EQ(message([&](Simulation& s) { s.scenarios = scenarios; }),
            "simulation: 3 scenarios are given for 2 rollouts");
  const Value value;
  Walk wide;
  wide.extra = 1;
  Simulation two = simulation(mover, 2, 5);
  two.terminal_value = &value;
  EXPECT_EQ(error_of(wide, two),
            "simulation: the terminal value maps 1 inputs to 1 outputs, 2 to 1 is expected");
}

TEST(Episodes, BeginWhereTheProblemStarts) {
  const ModelProblem<Walk> problem({}, "walk");
  const Mover mover(1);
  Serial serial;
  Simulation one = simulation(mover, 1, 2);
  EXPECT_EQ(problem.episodes(one, kDraws, serial).total, problem.simulate(one, kDraws, serial).total);
  const Matrix starts = column({0.0});
  one.starts = &starts;
  EXPECT_THROW(problem.episodes(one, kDraws, serial), std::invalid_argument);
}

TEST(DatasetRecorder, KeepsTransitionsInTheOrderOfRollouts) {
  Walk model;
  model.limit = 1.9;
  const ModelProblem<Walk> problem(model, "walk");
  const Mover mover(1, 0, 2);
  const Matrix starts = column({1.5, -5.0});
  DatasetRecorder recorder(problem.spaces(), 2);
  Simulation two = simulation(mover, 2, 3);
  two.starts = &starts;
  two.recorder = &recorder;
  Threads threads(2);
  problem.simulate(two, kDraws, threads);
  const Dataset dataset = recorder.dataset();
  dataset.check();
  ASSERT_EQ(dataset.rows(), 4u);  // the first rollout ends after one step
  EXPECT_EQ(dataset.episode, (std::vector<std::int64_t>{0, 1, 1, 1}));
  EXPECT_EQ(dataset.step, (std::vector<std::int64_t>{0, 0, 1, 2}));
  EXPECT_EQ(dataset.action_id, (std::vector<std::int32_t>{0, 0, 0, 1}));
  EXPECT_EQ(dataset.terminal, (std::vector<std::uint8_t>{1, 0, 0, 0}));
  EXPECT_EQ(dataset.states, column({1.5, -5, -4, -3}));
  EXPECT_EQ(dataset.next, column({2.5, -4, -3, -3}));
  EXPECT_EQ(dataset.reward, (std::vector<double>{2.5, -4, -3, -3}));
  EXPECT_TRUE(std::isnan(dataset.actions(3, 0)));
  EXPECT_EQ(dataset.action(2), (Action{0, {1.0}}));
}

}  // namespace
}  // namespace coppice
