#include <algorithm>
#include <numbers>

#include "engine/vocabulary/elementary.h"
#include "engine/vocabulary/problem.h"

namespace coppice {
namespace {

/// Gymnasium's Pendulum-v1, so that numbers published for it can be put beside ours: same motion, costs,
/// starts and time limit. Only the observation differs: Gymnasium shows (cos, sin, speed), this the angle in
/// [-pi, pi) itself, 0 upright. Episodes have no end but the time limit.
struct PendulumV1 {
  double gravity = 10.0;
  double discount = 0.98;
  int horizon = 200;

  static constexpr double kMass = 1.0, kLength = 1.0;
  static constexpr double kPeriod = 0.05;  // s
  static constexpr double kTorqueMax = 2.0, kSpeedMax = 8.0;
  static constexpr double kPi = std::numbers::pi;

  using State = Vec<2>;

  Space states() const {
    return {{"angle", "rad", -kPi, kPi, true}, {"angular_speed", "rad/s", -kSpeedMax, kSpeedMax}};
  }
  std::vector<ActionBox> actions() const { return {{"turn", {{"torque", "N*m", -kTorqueMax, kTorqueMax}}}}; }

  State start(const Draws& draws) const {
    return {draws.uniform("angle", -kPi, kPi), draws.uniform("angular_speed", -1, 1)};
  }

  Transition<State> step(const State& state, ActionRef action, const Draws&) const {
    const double angle = normalize_angle(state[0]), speed = state[1], torque = action[0];
    // A uniform rod; the new speed moves the angle. The cost is that of the old state.
    const double acceleration =
        3 * gravity / (2 * kLength) * elementary::sin(angle) + 3 / (kMass * kLength * kLength) * torque;
    const double next_speed = std::clamp(speed + acceleration * kPeriod, -kSpeedMax, kSpeedMax);
    return {.next = {normalize_angle(angle + next_speed * kPeriod), next_speed},
            .reward = -(angle * angle + 0.1 * speed * speed + 0.001 * torque * torque)};
  }

  static Parameters<PendulumV1> parameters() {
    using This = PendulumV1;
    return Parameters<This>()
        .add("gravity", &This::gravity, "m/s^2", "Acceleration of gravity (Gymnasium's g).", at_least(0))
        .add("discount", &This::discount, "", "Discount of a step; Gymnasium has none.", between(0, 1))
        .add("horizon", &This::horizon, "", "Decisions in an episode: Gymnasium's time limit.", at_least(1));
  }
};

const Component<Problem, PendulumV1> kPendulumV1(
    "pendulum_v1", "Gymnasium's Pendulum-v1: swing up a pendulum by small torques.",
    "Towers et al. 2024, Gymnasium; its Pendulum-v1");

}  // namespace
}  // namespace coppice
