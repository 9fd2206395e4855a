// What every registered problem promises; new ones are covered without an edit.

#include <gtest/gtest.h>

#include <cmath>

#include "engine/vocabulary/problem.h"
#include "registry/units.h"
#include "tests/support/example.h"
#include "tests/support/make.h"
#include "tests/support/threads.h"

namespace coppice {
namespace {

constexpr std::size_t kRollouts = 60;

/// Takes corners of the action boxes: the farthest that a policy can go.
class Corners : public Policy {
 public:
  void prepare(const Spaces& spaces, const Simulator*) override { actions_ = spaces.actions; }
  void act(std::span<const double>, std::span<double>, const Draws& draws, Action& action) const override {
    action.id = static_cast<int>(draws.below("action", actions_.size()));
    const Space& axes = actions_[static_cast<std::size_t>(action.id)].axes;
    action.values.resize(axes.size());
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const bool low = draws.below("corner", 2, static_cast<std::uint32_t>(i)) == 0;
      action.values[i] = low ? axes[i].low : axes[i].high;
    }
  }

 private:
  std::vector<ActionBox> actions_;
};

class Episodes : public Recorder {
 public:
  void episode(std::size_t rollout, std::uint64_t, const Episode& episode) override {
    all.at(rollout) = episode;
  }
  std::vector<Episode> all = std::vector<Episode>(kRollouts);
};

class Problems : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    made_ = make_example<Problem>(GetParam());
    policies_ = {make_from_xml<Policy>("<random/>").object, std::make_shared<Corners>()};
    for (const auto& policy : policies_) policy->prepare(problem().spaces(), problem().simulator());
  }
  const Problem& problem() const { return *made_; }
  const Simulator& simulator() const { return *problem().simulator(); }
  bool has_simulator() const { return problem().simulator() != nullptr; }

  Returns run(const Policy& policy, Parallel& parallel, Recorder* recorder = nullptr) const {
    Simulation simulation;
    simulation.policy = &policy;
    simulation.rollouts = kRollouts;
    simulation.horizon = std::min(problem().horizon(), 50);
    simulation.discount = problem().discount();
    simulation.first_scenario = 1000;
    simulation.recorder = recorder;
    return problem().episodes(simulation, kDraws, parallel);
  }

  const Draws kDraws{2017, "conformance", 0};
  Serial serial_;
  Sub<Problem> made_;
  std::vector<std::shared_ptr<Policy>> policies_;
};

TEST_P(Problems, SpacesAreSound) {
  const Spaces& spaces = problem().spaces();
  EXPECT_NO_THROW(spaces.check());
  std::vector<Space> all = {spaces.states};
  for (const ActionBox& box : spaces.actions) all.push_back(box.axes);
  for (const Space& axes : all) {
    for (const Axis& axis : axes) {
      EXPECT_EQ(axis.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"), std::string::npos)
          << axis.name;
      const std::optional<Quantity> unit = parse_unit(axis.unit);
      ASSERT_TRUE(unit.has_value()) << axis.name << ": " << axis.unit;
      EXPECT_EQ(unit->value, 1) << axis.name << ": " << axis.unit << " is no SI unit";
    }
  }
  EXPECT_TRUE(problem().discount() >= 0 && problem().discount() <= 1);
  EXPECT_GE(problem().horizon(), 1);
}

TEST_P(Problems, StartsLieInTheStateSpaceAndDependOnTheScenarioOnly) {
  if (!has_simulator()) GTEST_SKIP() << "offers episodes only";
  const Space& axes = problem().spaces().states;
  std::vector<double> state(axes.size()), again(axes.size());
  for (std::uint64_t scenario = 0; scenario < 500; ++scenario) {
    simulator().start(kDraws.scenario(scenario), state);
    simulator().start(kDraws.scenario(scenario), again);
    EXPECT_EQ(state, again);
    for (std::size_t i = 0; i < axes.size(); ++i) {
      EXPECT_TRUE(state[i] >= axes[i].low && state[i] <= axes[i].high) << axes[i].name << " = " << state[i];
    }
  }
}

TEST_P(Problems, EqualDrawsGiveEqualRolloutsOnAnyNumberOfThreads) {
  for (const auto& policy : policies_) {
    const Returns first = run(*policy, serial_);
    Threads threads(3);
    for (Parallel* parallel : {static_cast<Parallel*>(&serial_), static_cast<Parallel*>(&threads)}) {
      const Returns again = run(*policy, *parallel);
      EXPECT_EQ(again.total, first.total);
      EXPECT_EQ(again.discounted, first.discounted);
      EXPECT_EQ(again.steps, first.steps);
      EXPECT_EQ(again.terminal, first.terminal);
    }
  }
}

TEST_P(Problems, EpisodesAreFiniteAndAgreeWithTheirReturns) {
  for (const auto& policy : policies_) {
    Episodes episodes;
    const Returns returns = run(*policy, serial_, &episodes);
    for (std::size_t i = 0; i < kRollouts; ++i) {
      const Episode& episode = episodes.all[i];
      const std::size_t steps = episode.actions.size();
      EXPECT_EQ(static_cast<std::size_t>(returns.steps[i]), steps);
      EXPECT_EQ(episode.states.size(), (steps + 1) * problem().spaces().state_size());
      EXPECT_EQ(returns.terminal[i] != 0, episode.terminal);
      if (!episode.terminal) {
        EXPECT_EQ(steps, static_cast<std::size_t>(std::min(problem().horizon(), 50)));
      }
      for (double x : episode.states) EXPECT_TRUE(std::isfinite(x));
      double total = 0, discounted = 0, weight = 1;
      for (double reward : episode.rewards) {
        total += reward;
        discounted += weight * reward;
        weight *= problem().discount();
      }
      EXPECT_EQ(total, returns.total[i]);
      EXPECT_EQ(discounted, returns.discounted[i]);
      for (const Action& action : episode.actions)
        EXPECT_EQ(clamp(action, problem().spaces().actions), action);
    }
  }
}

// Each recorded transition is what `step` gives; the last one alone may be terminal.
TEST_P(Problems, StepsAgreeWithEpisodesAndNothingFollowsATerminalState) {
  if (!has_simulator()) GTEST_SKIP() << "offers episodes only";
  const std::size_t size = problem().spaces().state_size();
  std::vector<double> next(size);
  for (const auto& policy : policies_) {
    Episodes episodes;
    run(*policy, serial_, &episodes);
    for (std::size_t i = 0; i < kRollouts; ++i) {
      const Episode& episode = episodes.all[i];
      for (std::size_t t = 0; t < episode.actions.size(); ++t) {
        const std::span<const double> pair(episode.states.data() + t * size, 2 * size);
        double reward = 0;
        bool terminal = false;
        const Draws draws = kDraws.scenario(1000 + i).step(static_cast<std::uint32_t>(t));
        simulator().step(pair.first(size), episode.actions[t], draws, next, reward, terminal);
        EXPECT_TRUE(std::equal(next.begin(), next.end(), pair.last(size).begin()));
        EXPECT_EQ(reward, episode.rewards[t]);
        EXPECT_EQ(terminal, episode.terminal && t + 1 == episode.actions.size());
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Problems, testing::ValuesIn(Catalogue::instance().names("problem")),
                         component_name);

}  // namespace
}  // namespace coppice
