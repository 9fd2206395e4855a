#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "engine/vocabulary/problem.h"
#include "tests/support/make.h"

namespace coppice {

inline constexpr double kPi = std::numbers::pi;

using State2 = std::array<double, 2>;

struct Outcome {
  State2 next{};
  double reward = 0;
  bool terminal = false;
};

/// A problem of two state axes and one action parameter, one step at a time.
class Stepping {
 public:
  explicit Stepping(const std::string& xml) : problem_(make_from_xml<Problem>(xml)) {}

  const Problem& problem() const { return *problem_; }
  State2 start(std::uint64_t scenario) const {
    State2 state{};
    problem_->simulator()->start(draws_.scenario(scenario), state);
    return state;
  }
  Outcome operator()(const State2& state, double action, std::uint64_t scenario = 0) const {
    Outcome made;
    problem_->simulator()->step(state, {0, {action}}, draws_.scenario(scenario), made.next, made.reward,
                                made.terminal);
    return made;
  }
  /// Episodes of linear feedback u = -gains s, undiscounted.
  Returns episodes(const State2& gains, std::size_t count) const {
    return episodes_of(
        "<linear_feedback gains=\"" + std::to_string(gains[0]) + ", " + std::to_string(gains[1]) + "\"/>",
        count);
  }
  Returns episodes_of(const std::string& policy, std::size_t count) const {
    const Sub<Policy> law = make_from_xml<Policy>(policy);
    law.object->prepare(problem_->spaces(), nullptr);
    Simulation simulation;
    simulation.policy = law.object.get();
    simulation.rollouts = count;
    simulation.horizon = problem_->horizon();
    Serial serial;
    return problem_->episodes(simulation, draws_, serial);
  }
  /// A state and an action anywhere in their boxes.
  std::pair<State2, double> uniform(std::uint64_t number) const {
    const Draws at = draws_.fork("uniform").scenario(number);
    const Space& axes = problem_->spaces().states;
    const Axis& action = problem_->spaces().actions[0].axes[0];
    return {{at.uniform("state", axes[0].low, axes[0].high, 0),
             at.uniform("state", axes[1].low, axes[1].high, 1)},
            at.uniform("action", action.low, action.high)};
  }

 private:
  Sub<Problem> problem_;
  Draws draws_{2017, "stepping", 0};
};

/// Mean and its standard error.
struct Estimate {
  double mean, error;
};
inline Estimate estimate(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0, squares = 0;
  for (double value : values) mean += value / n;
  for (double value : values) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / (n - 1) / n)};
}

}  // namespace coppice
