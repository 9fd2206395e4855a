#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "engine/vocabulary/policy.h"
#include "tests/support/make.h"

namespace coppice {
namespace {

constexpr double kPi = std::numbers::pi;

const Spaces kPendulumSpaces = {{{"angle", "rad", -kPi, kPi, true}, {"speed", "rad/s", -8, 8}},
                                {{"turn", {{"torque", "N*m", -2, 2}}}}};

double torque(const std::string& xml, std::vector<double> state) {
  const Sub<Policy> policy = make_from_xml<Policy>(xml);
  policy.object->prepare(kPendulumSpaces, nullptr);
  Action action;
  policy->act(state, {}, Draws(1, "test", 0), action);
  return action.values[0];
}

const std::string kLaw = "<energy_swing_up stiffness=\"15\" energy_gain=\"0.1\" gains=\"3, 0.5\"/>";

// Missing energy: 15 (1 - cos theta) - theta'^2 / 2.
TEST(EnergySwingUp, AddsTheEnergyThatIsMissingAlongTheMotion) {
  EXPECT_DOUBLE_EQ(torque(kLaw, {kPi / 2, 2}), 0.1 * (15 - 2));
  EXPECT_DOUBLE_EQ(torque(kLaw, {kPi / 2, -2}), -0.1 * (15 - 2));
  EXPECT_DOUBLE_EQ(torque(kLaw, {-kPi / 2, 6}), 0.1 * (15 - 18)) << "too much of it is taken away";
  EXPECT_EQ(torque(kLaw, {kPi, 0}), 2) << "at rest it begins, with no more than the motor has";
  EXPECT_NEAR(torque(kLaw, {1, std::sqrt(30 * (1 - std::cos(1.0)))}), 0, 1e-12);
}

TEST(EnergySwingUp, HoldsByLinearFeedbackNearTheTop) {
  EXPECT_DOUBLE_EQ(torque(kLaw, {0.2, -0.4}), -(3 * 0.2 - 0.5 * 0.4));
  EXPECT_NEAR(torque(kLaw, {2 * kPi + 0.2, -0.4}), -(3 * 0.2 - 0.5 * 0.4), 1e-12) << "a turn further";
  EXPECT_DOUBLE_EQ(torque(kLaw, {0, 1.9}), -0.95);
  EXPECT_DOUBLE_EQ(torque(kLaw, {0, 2.1}), -0.1 * 2.1 * 2.1 / 2) << "too fast to be caught";
}

TEST(EnergySwingUp, RefusesWhatIsNoPendulum) {
  const Sub<Policy> policy = make_from_xml<Policy>(kLaw);
  Spaces spaces = kPendulumSpaces;
  spaces.states.push_back({"cart", "m", -1, 1});
  EXPECT_THROW(policy.object->prepare(spaces, nullptr), std::invalid_argument);
  spaces = kPendulumSpaces;
  spaces.actions.push_back(spaces.actions[0]);
  EXPECT_THROW(policy.object->prepare(spaces, nullptr), std::invalid_argument);
  EXPECT_THROW(torque("<energy_swing_up stiffness=\"15\" energy_gain=\"1\" gains=\"3\"/>", {0, 0}),
               std::invalid_argument);
  EXPECT_THROW(make_from_xml<Policy>("<energy_swing_up energy_gain=\"1\" gains=\"3, 1\"/>"), ConfigError);
}

}  // namespace
}  // namespace coppice
