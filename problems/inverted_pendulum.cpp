#include <cmath>
#include <numbers>

#include "engine/vocabulary/elementary.h"
#include "engine/vocabulary/problem.h"

namespace coppice {
namespace {

/// A pendulum on a cart, held upright by a noisy force on the cart (thesis, section 1.1.3; Wang, Tanaka and
/// Griffin, IEEE Trans. Fuzzy Systems 4(1), 1996; Pazis and Lagoudakis, ICML 2009). A positive force turns
/// the pendulum to negative angles. Angle and, if asked for, speed are tested at the end of a control step
/// only.
struct InvertedPendulum {
  enum class Force { commanded, noisy };

  double cart_mass = 8.0;
  double force_noise = 10.0;
  Force reward_force = Force::commanded;
  double speed_max = 2.0;
  bool speed_ends = false;
  double penalty = 1000.0;
  double discount = 0.95;
  int horizon = 3000;

  static constexpr double kGravity = 9.8, kMass = 2.0, kLength = 0.5;
  static constexpr double kForceMax = 50.0;
  static constexpr double kAngleMax = std::numbers::pi / 2;
  static constexpr double kPeriod = 0.1;   // s, one decision
  static constexpr int kEulerSteps = 100;  // of 1 ms

  using State = Vec<2>;

  Space states() const {
    return {{"angle", "rad", -kAngleMax, kAngleMax}, {"angular_speed", "rad/s", -speed_max, speed_max}};
  }
  std::vector<ActionBox> actions() const { return {{"push", {{"force", "N", -kForceMax, kForceMax}}}}; }

  State start(const Draws&) const { return {0.0, 0.0}; }

  Transition<State> step(const State& state, ActionRef action, const Draws& draws) const {
    const double force = action[0] + draws.uniform("force_noise", -force_noise, force_noise);
    Transition<State> made{.next = moved(state, force)};
    const double angle = made.next[0], speed = made.next[1];
    made.terminal = std::fabs(angle) > kAngleMax || (speed_ends && std::fabs(speed) > speed_max);
    const double a = angle / kAngleMax;
    const double f = (reward_force == Force::commanded ? action[0] : force) / kForceMax;
    made.reward = made.terminal ? -penalty : -(a * a + speed * speed + f * f);
    return made;
  }

  /// theta'' = (g sin - alpha m l theta'^2 sin cos - alpha cos u) / (4 l / 3 - alpha m l cos^2), by Euler
  /// steps.
  State moved(State state, double force) const {
    const double dt = kPeriod / kEulerSteps;
    const double alpha = 1 / (kMass + cart_mass);
    const double aml = alpha * kMass * kLength;
    for (int i = 0; i < kEulerSteps; ++i) {
      const double sine = elementary::sin(state[0]), cosine = elementary::cos(state[0]);
      const double speed = state[1];
      const double above = kGravity * sine - cosine * (aml * speed * speed * sine + alpha * force);
      state[0] += dt * speed;
      state[1] += dt * above / (4 * kLength / 3 - aml * cosine * cosine);
    }
    return state;
  }

  static Parameters<InvertedPendulum> parameters() {
    using This = InvertedPendulum;
    return Parameters<This>()
        .add("cart_mass", &This::cart_mass, "kg",
             "Mass of the cart: 8 kg in the thesis's text, 6 kg in its authors' program.", above(0))
        .add("force_noise", &This::force_noise, "N",
             "Half width of the uniform noise that is added to the force, drawn once for each decision.",
             at_least(0))
        .choice("reward_force", &This::reward_force, {"commanded", "noisy"},
                "Whether the cost of a step counts the force asked for, or that with noise.")
        .add("speed_max", &This::speed_max, "rad/s",
             "Limit of the angular speed's axis, between which uniform samples are drawn.", above(0))
        .add("speed_ends", &This::speed_ends, "",
             "Whether a larger angular speed ends the episode at the penalty, as in the authors' program.")
        .add("penalty", &This::penalty, "", "Cost of the step that ends the episode.", at_least(0))
        .add("discount", &This::discount, "", "Discount of a step.", between(0, 1))
        .add("horizon", &This::horizon, "", "Decisions in an episode.", at_least(1));
  }
};

const Component<Problem, InvertedPendulum> kInvertedPendulum(
    "inverted_pendulum", "Keep a pendulum upright by a noisy force on its cart.",
    "Hofer 2017, section 1.1.3; Wang, Tanaka and Griffin 1996; Pazis and Lagoudakis 2009");

}  // namespace
}  // namespace coppice
