#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/vocabulary/elementary.h"
#include "engine/vocabulary/problem.h"

namespace coppice {
namespace {

/// A pendulum swung up by a motor in its joint that is too weak to lift it (thesis, section 1.1.4). The
/// thesis simulates it in Gazebo and leaves the pendulum's inertia open: a uniform rod fits its results, a
/// point mass at its end does not. Angle 0 is upright. The speed limit is tested at the end of a control step
/// only.
struct SwingUp {
  enum class Body { rod, point };
  enum class Start { down, near_down };

  Body body = Body::rod;
  double mass = 5.0;
  double length = 1.0;
  double damping = 0.1;
  double dry_friction = 0.1;
  Start start_from = Start::down;
  double penalty = 50.0;
  int substeps = 100;
  double discount = 0.98;
  int horizon = 100;

  static constexpr double kGravity = 9.81, kTorqueMax = 15.0, kSpeedMax = 10.0;
  static constexpr double kPi = std::numbers::pi;
  static constexpr double kPeriod = 0.1;  // s, one decision

  using State = Vec<2>;

  Space states() const {
    return {{"angle", "rad", -kPi, kPi, true}, {"angular_speed", "rad/s", -kSpeedMax, kSpeedMax}};
  }
  std::vector<ActionBox> actions() const { return {{"turn", {{"torque", "N*m", -kTorqueMax, kTorqueMax}}}}; }

  State start(const Draws& draws) const {
    if (start_from == Start::down) return {-kPi, 0.0};
    const double degree = kPi / 180;
    return {normalize_angle(kPi + draws.uniform("angle", -degree, degree)),
            draws.uniform("angular_speed", -degree, degree)};
  }

  Transition<State> step(const State& state, ActionRef action, const Draws&) const {
    Transition<State> made{.next = moved(state, action[0])};
    const double torque = action[0] / kTorqueMax;
    made.terminal = std::fabs(made.next[1]) > kSpeedMax;
    // Eq. 1.2, of the angle that the step leads to.
    made.reward = made.terminal ? -penalty : -(std::fabs(made.next[0]) / kPi + torque * torque);
    return made;
  }

  /// I theta'' = m g c sin(theta) + torque - damping theta' - dry_friction sign(theta'), c the distance of
  /// the centre of mass; the speed first, then the angle by the new speed, which keeps the energy bounded.
  /// Dry friction stops the pendulum but does not turn it round.
  State moved(State state, double torque) const {
    const double dt = kPeriod / substeps;
    const double inertia = mass * length * length / (body == Body::rod ? 3 : 1);
    const double weight = mass * kGravity * (body == Body::rod ? length / 2 : length);
    const double brake = dt * dry_friction / inertia;
    for (int i = 0; i < substeps; ++i) {
      const double free = weight * elementary::sin(state[0]) + torque - damping * state[1];
      const double speed = state[1] + dt * free / inertia;
      state[1] = speed - std::clamp(speed, -brake, brake);
      state[0] += dt * state[1];
    }
    state[0] = normalize_angle(state[0]);
    return state;
  }

  static Parameters<SwingUp> parameters() {
    using This = SwingUp;
    return Parameters<This>()
        .choice("body", &This::body, {"rod", "point"}, "A uniform rod, or a point mass at its end.")
        .add("mass", &This::mass, "kg", "Mass of the pendulum.", above(0))
        .add("length", &This::length, "m", "Length of the pendulum.", above(0))
        .add("damping", &This::damping, "N*m*s/rad", "Viscous friction of the joint.", at_least(0))
        .add("dry_friction", &This::dry_friction, "N*m", "Dry friction of the joint.", at_least(0))
        .choice("start", &This::start_from, {"down", "near_down"},
                "Start at rest hanging down, or within 1 deg and 1 deg/s of it.")
        .add("penalty", &This::penalty, "", "Cost of the step that exceeds 10 rad/s and ends the episode.",
             at_least(0))
        .add("substeps", &This::substeps, "", "Steps of integration in a decision.", between(1, 1000000))
        .add("discount", &This::discount, "", "Discount of a step.", between(0, 1))
        .add("horizon", &This::horizon, "", "Decisions in an episode.", at_least(1));
  }
};

const Component<Problem, SwingUp> kSwingUp(
    "swing_up", "Swing a pendulum up and hold it there by a motor too weak to lift it.",
    "Hofer 2017, section 1.1.4");

}  // namespace
}  // namespace coppice
