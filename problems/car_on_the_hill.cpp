#include <cmath>

#include "engine/vocabulary/problem.h"

namespace coppice {
namespace {

/// A car too weak to climb a hill straight away (thesis, section 1.1.2; Ernst, Geurts and Wehenkel, JMLR 6,
/// 2005, section 5.1 with its constants). Limits and goal are tested at the end of a control step only.
struct CarOnTheHill {
  enum class Start { fixed, uniform };

  Start start_from = Start::fixed;
  double discount = 0.95;
  int horizon = 100;

  static constexpr double kMass = 1.0, kGravity = 9.81;
  static constexpr double kPeriod = 0.1;   // s, one decision
  static constexpr int kEulerSteps = 100;  // of 1 ms
  static constexpr double kMaxSpeed = 3.0;

  using State = Vec<2>;

  Space states() const { return {{"position", "m", -1, 1}, {"speed", "m/s", -kMaxSpeed, kMaxSpeed}}; }
  std::vector<ActionBox> actions() const { return {{"push", {{"force", "N", -4, 4}}}}; }

  State start(const Draws& draws) const {
    if (start_from == Start::fixed) return {-0.5, 0.0};
    return {draws.uniform("position", -1, 1), draws.uniform("speed", -kMaxSpeed, kMaxSpeed)};
  }

  Transition<State> step(const State& state, ActionRef action, const Draws&) const {
    Transition<State> made{.next = moved(state, action[0])};
    const bool failed = made.next[0] < -1 || std::fabs(made.next[1]) > kMaxSpeed;
    const bool arrived = !failed && made.next[0] > 1;
    made.terminal = failed || arrived;
    made.reward = failed ? -1 : arrived ? 1 : 0;
    return made;
  }

  /// H' and H'' of the hill's shape, H(p) = p^2 + p for p < 0 and p / sqrt(1 + 5 p^2) for p >= 0 (Eq. 1.1).
  struct Slope {
    double first, second;
  };
  static Slope slope(double p) {
    if (p < 0) return {2 * p + 1, 2};
    const double root = std::sqrt(1 + 5 * p * p);
    const double first = 1 / (root * root * root);
    return {first, -15 * p * first / (root * root)};
  }

  /// p'' = (u / m - g H' - p'^2 H' H'') / (1 + H'^2), by Euler steps.
  static State moved(State state, double force) {
    const double dt = kPeriod / kEulerSteps;
    for (int i = 0; i < kEulerSteps; ++i) {
      const auto [first, second] = slope(state[0]);
      const double speed = state[1];
      const double pull = force / kMass - kGravity * first - speed * speed * first * second;
      state[0] += dt * speed;
      state[1] += dt * pull / (1 + first * first);
    }
    return state;
  }

  static Parameters<CarOnTheHill> parameters() {
    using This = CarOnTheHill;
    return Parameters<This>()
        .choice("start", &This::start_from, {"fixed", "uniform"},
                "Start at rest at -0.5 m, or uniformly in the state space.")
        .add("discount", &This::discount, "", "Discount of a step.", between(0, 1))
        .add("horizon", &This::horizon, "", "Decisions in an episode.", at_least(1));
  }
};

const Component<Problem, CarOnTheHill> kCarOnTheHill(
    "car_on_the_hill", "Bring an underpowered car to the top of a hill: +1 there, -1 for leaving the limits.",
    "Hofer 2017, section 1.1.2; Ernst, Geurts and Wehenkel 2005");

}  // namespace
}  // namespace coppice
