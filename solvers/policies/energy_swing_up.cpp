#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/vocabulary/elementary.h"
#include "engine/vocabulary/policy.h"

namespace coppice {
namespace {

/// Swings a pendulum up by its energy (Astrom and Furuta, Automatica 36, 2000) and holds it there by linear
/// feedback. State: the angle, 0 upright, then the angular speed; action: a torque. Energies are by unit of
/// inertia: E = theta'^2 / 2 + w^2 (cos theta - 1), 0 at rest upright; w^2 = m g c / I.
class EnergySwingUp : public Policy {
 public:
  double stiffness = 0;  // w^2
  double energy_gain = 0;
  std::vector<double> gains;
  double catch_angle = 0.4;
  double catch_speed = 2.0;

  void prepare(const Spaces& spaces, const Simulator*) override {
    if (spaces.state_size() != 2 || spaces.actions.size() != 1 || spaces.actions[0].axes.size() != 1) {
      throw std::invalid_argument(
          "<energy_swing_up> needs a state of angle and angular speed, and one action of one torque");
    }
    if (gains.size() != 2) {
      throw std::invalid_argument(fmt::format(
          "<energy_swing_up>: gains has {} numbers, expected are 2: of the angle and of its speed",
          gains.size()));
    }
    actions_ = spaces.actions;
  }

  void act(std::span<const double> state, std::span<double>, const Draws&, Action& chosen) const override {
    const double angle = normalize_angle(state[0]), speed = state[1];
    chosen.id = 0;
    chosen.values.resize(1);
    if (std::fabs(angle) < catch_angle && std::fabs(speed) < catch_speed) {
      chosen.values[0] = -(gains[0] * angle + gains[1] * speed);
    } else {
      // A torque along the motion adds energy. At rest either way will do.
      const double energy = speed * speed / 2 + stiffness * (elementary::cos(angle) - 1);
      chosen.values[0] = energy_gain * -energy * (speed < 0 ? -1 : 1);
    }
    clamp_in_place(chosen, actions_);
  }

  static Parameters<EnergySwingUp> parameters() {
    using This = EnergySwingUp;
    return Parameters<This>()
        .require("stiffness", &This::stiffness, "1/s^2",
                 "m g c / I: weight times the distance of the centre of mass, by inertia.", above(0))
        .require("energy_gain", &This::energy_gain, "",
                 "Torque for each unit of energy (by inertia, in rad^2/s^2) that is missing.", at_least(0))
        .require("gains", &This::gains, "", "K of the torque -K s that holds the pendulum once it is up.")
        .add("catch_angle", &This::catch_angle, "rad",
             "Nearer than this, and slower than catch_speed, it is held.", at_least(0))
        .add("catch_speed", &This::catch_speed, "rad/s", "See catch_angle.", at_least(0));
  }

 private:
  std::vector<ActionBox> actions_;
};

const Component<Policy, EnergySwingUp> kEnergySwingUp("energy_swing_up",
                                                      "Swing a pendulum up by its energy, then hold it.",
                                                      "Astrom and Furuta, Automatica 36 (2000)");

}  // namespace
}  // namespace coppice
