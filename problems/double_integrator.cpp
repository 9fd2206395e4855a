#include <cmath>

#include "engine/vocabulary/problem.h"

namespace coppice {
namespace {

/// A mass on a line that a force brings to rest at the origin (thesis, section 1.1.1; Santamaria, Sutton and
/// Ram, Adaptive Behavior 6(2), 1997). An action holds for one control step; leaving the box ends the
/// episode.
struct DoubleIntegrator {
  enum class Cost { p2_a2, p2_v2 };
  enum class Integration { euler, exact };
  enum class Start { fixed, uniform };

  Cost cost = Cost::p2_a2;
  Integration integration = Integration::euler;
  Start start_from = Start::fixed;
  double penalty = 50.0;
  double discount = 0.98;
  int horizon = 200;

  static constexpr double kPeriod = 0.5;  // s, one decision
  static constexpr int kEulerSteps = 10;  // of 0.05 s

  using State = Vec<2>;

  Space states() const { return {{"position", "m", -1, 1}, {"speed", "m/s", -1, 1}}; }
  std::vector<ActionBox> actions() const { return {{"accelerate", {{"acceleration", "m/s^2", -1, 1}}}}; }

  State start(const Draws& draws) const {
    if (start_from == Start::fixed) return {1.0, 0.0};
    return {draws.uniform("position", -1, 1), draws.uniform("speed", -1, 1)};
  }

  Transition<State> step(const State& state, ActionRef action, const Draws&) const {
    const double a = action[0];
    Transition<State> made{.next = moved(state, a)};
    made.terminal = std::fabs(made.next[0]) > 1 || std::fabs(made.next[1]) > 1;
    // The cost is that of the state where the action was taken. Leaving costs the penalty alone.
    const double second = cost == Cost::p2_a2 ? a : state[1];
    made.reward = made.terminal ? -penalty : -(state[0] * state[0] + second * second);
    return made;
  }

  /// Euler advances the position by the old speed, which moves it by 0.1125 a in a period instead of a / 8.
  State moved(State state, double a) const {
    if (integration == Integration::exact) {
      return {state[0] + kPeriod * state[1] + 0.5 * kPeriod * kPeriod * a, state[1] + kPeriod * a};
    }
    const double dt = kPeriod / kEulerSteps;
    for (int i = 0; i < kEulerSteps; ++i) {
      state[0] += dt * state[1];
      state[1] += dt * a;
    }
    return state;
  }

  static Parameters<DoubleIntegrator> parameters() {
    using This = DoubleIntegrator;
    return Parameters<This>()
        .choice("cost", &This::cost, {"p2_a2", "p2_v2"},
                "Cost of a step: squared position plus squared acceleration, or plus squared speed.")
        .choice("integration", &This::integration, {"euler", "exact"},
                "Euler steps of 0.05 s, or the exact motion.")
        .choice("start", &This::start_from, {"fixed", "uniform"},
                "Start at rest at 1 m, or uniformly in the state space.")
        .add("penalty", &This::penalty, "", "Cost of the step that leaves the state space.", at_least(0))
        .add("discount", &This::discount, "", "Discount of a step.", between(0, 1))
        .add("horizon", &This::horizon, "", "Decisions in an episode.", at_least(1));
  }
};

const Component<Problem, DoubleIntegrator> kDoubleIntegrator(
    "double_integrator", "Bring a mass on a line to rest at the origin by bounded accelerations.",
    "Hofer 2017, section 1.1.1; Santamaria, Sutton and Ram 1997");

}  // namespace
}  // namespace coppice
