#include <algorithm>

#include "engine/vocabulary/elementary.h"
#include "engine/vocabulary/problem.h"

namespace coppice {
namespace {

/// Gymnasium's MountainCarContinuous-v0, so that numbers published for it can be put beside ours: same
/// motion, rewards, starts and time limit. It has no units; speeds are per step. Gymnasium rounds its state
/// to single precision after each step, this does not.
struct MountainCarContinuous {
  double goal_velocity = 0.0;
  double discount = 0.99;
  int horizon = 999;

  static constexpr double kPositionMin = -1.2, kPositionMax = 0.6, kSpeedMax = 0.07;
  static constexpr double kGoal = 0.45, kPower = 0.0015, kGravity = 0.0025;

  using State = Vec<2>;

  Space states() const {
    return {{"position", "", kPositionMin, kPositionMax}, {"velocity", "", -kSpeedMax, kSpeedMax}};
  }
  std::vector<ActionBox> actions() const { return {{"push", {{"force", "", -1, 1}}}}; }

  State start(const Draws& draws) const { return {draws.uniform("position", -0.6, -0.4), 0.0}; }

  Transition<State> step(const State& state, ActionRef action, const Draws&) const {
    const double force = action[0];
    const double pull = force * kPower - kGravity * elementary::cos(3 * state[0]);
    double velocity = std::clamp(state[1] + pull, -kSpeedMax, kSpeedMax);
    const double position = std::clamp(state[0] + velocity, kPositionMin, kPositionMax);
    if (position == kPositionMin && velocity < 0) velocity = 0;  // the wall
    const bool arrived = position >= kGoal && velocity >= goal_velocity;
    return {.next = {position, velocity},
            .reward = (arrived ? 100 : 0) - 0.1 * force * force,
            .terminal = arrived};
  }

  static Parameters<MountainCarContinuous> parameters() {
    using This = MountainCarContinuous;
    return Parameters<This>()
        .add("goal_velocity", &This::goal_velocity, "", "Velocity that is needed at the goal.",
             between(0, kSpeedMax))
        .add("discount", &This::discount, "", "Discount of a step; Gymnasium has none.", between(0, 1))
        .add("horizon", &This::horizon, "", "Decisions in an episode: Gymnasium's time limit.", at_least(1));
  }
};

const Component<Problem, MountainCarContinuous> kMountainCarContinuous(
    "mountain_car_continuous", "Gymnasium's MountainCarContinuous-v0: rock a weak car up a hill.",
    "Moore 1990; Towers et al. 2024, Gymnasium; its MountainCarContinuous-v0");

}  // namespace
}  // namespace coppice
