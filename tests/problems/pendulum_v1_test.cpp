#include <gtest/gtest.h>

#include <numbers>

#include "tests/problems/stepping.h"

namespace coppice {
namespace {

struct Made {
  long double angle, speed, reward;
};

/// Gymnasium's step on its own state, an angle that is not wrapped, with the remainder of Python's %.
Made gymnasium(long double angle, long double speed, long double u) {
  const long double pi = std::numbers::pi_v<long double>;
  long double wrapped = std::fmod(angle + pi, 2 * pi);
  if (wrapped < 0) wrapped += 2 * pi;
  wrapped -= pi;
  const long double reward = -(std::pow(wrapped, 2) + 0.1L * std::pow(speed, 2) + 0.001L * u * u);
  speed += (15 * std::sin(angle) + 3 * u) / 20;
  speed = std::fmin(std::fmax(speed, -8.0L), 8.0L);
  return {angle + speed / 20, speed, reward};
}

TEST(PendulumV1, StepsAgreeWithGymnasiumsEquations) {
  const Stepping step("<pendulum_v1/>");
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const auto [state, u] = step.uniform(i);
    // Gymnasium's angle has been turning for a while.
    const Made expected = gymnasium(state[0] + 2 * std::numbers::pi_v<long double> * (i % 7), state[1], u);
    const Outcome made = step(state, u);
    EXPECT_NEAR(std::cos(made.next[0]), static_cast<double>(std::cos(expected.angle)), 1e-9);
    EXPECT_NEAR(std::sin(made.next[0]), static_cast<double>(std::sin(expected.angle)), 1e-9);
    EXPECT_NEAR(made.next[1], static_cast<double>(expected.speed), 1e-9);
    EXPECT_NEAR(made.reward, static_cast<double>(expected.reward), 1e-9);
    EXPECT_FALSE(made.terminal);
    EXPECT_GE(made.next[0], -kPi);
    EXPECT_LT(made.next[0], kPi);
  }
}

TEST(PendulumV1, TransitionsByHand) {
  const Stepping step("<pendulum_v1/>");
  const auto expect = [&](State2 state, double u, State2 next, double reward) {
    const Outcome made = step(state, u);
    EXPECT_NEAR(made.next[0], next[0], 1e-12);
    EXPECT_NEAR(made.next[1], next[1], 1e-12);
    EXPECT_NEAR(made.reward, reward, 1e-12);
  };
  expect({0, 0}, 1, {0.0075, 0.15}, -0.001);                                // 3 u dt, then dt
  expect({kPi / 2, 0}, 0, {kPi / 2 + 0.0375, 0.75}, -kPi * kPi / 4);        // 15 sin dt
  expect({kPi / 2, 7.9}, 2, {kPi / 2 + 0.4, 8}, -(kPi * kPi / 4 + 6.245));  // clipped at 8
  expect({0, -8}, -2, {-0.4, -8}, -6.404);
  expect({3.1, 8}, 0, {3.5 - 2 * kPi, 8}, -(9.61 + 6.4));  // round the bottom
  expect({0, 0}, 5, {0.015, 0.3}, -0.004);                 // the torque is clipped at 2, in the cost as well
  expect({-kPi, 8}, 2, {-kPi + 0.4, 8}, -16.273604401089358);  // the least reward there is
}

TEST(PendulumV1, StartsAndLimitsAreGymnasiums) {
  const Stepping step("<pendulum_v1/>");
  EXPECT_EQ(step.problem().horizon(), 200);
  std::vector<double> angles, speeds;
  for (std::uint64_t k = 0; k < 4000; ++k) {
    const State2 state = step.start(k);
    EXPECT_TRUE(std::fabs(state[0]) <= kPi && std::fabs(state[1]) <= 1);
    angles.push_back(state[0] * state[0]);
    speeds.push_back(state[1] * state[1]);
  }
  EXPECT_NEAR(estimate(angles).mean, kPi * kPi / 3, 3 * estimate(angles).error);
  EXPECT_NEAR(estimate(speeds).mean, 1.0 / 3, 3 * estimate(speeds).error);
}

// The best that is published for Gymnasium's is -152 (RL Baselines3 Zoo: means of 750 episodes); starts vary.
TEST(PendulumV1, ALawOfEnergyEarnsWhatIsPublished) {
  const Stepping step("<pendulum_v1/>");
  const Returns returns = step.episodes_of(
      "<energy_swing_up stiffness=\"15\" energy_gain=\"1\" gains=\"10, 2.5\" catch_angle=\"0.6\" "
      "catch_speed=\"3\"/>",
      1000);
  const Estimate earned = estimate(returns.total);
  EXPECT_NEAR(earned.mean, -152, 3 * earned.error);
  EXPECT_LT(earned.error, 5);
}

TEST(PendulumV1, GravityIsAParameter) {
  EXPECT_NEAR(Stepping("<pendulum_v1 gravity=\"9.81\"/>")({kPi / 2, 0}, 0).next[1], 1.5 * 9.81 * 0.05, 1e-12);
  EXPECT_THROW(Stepping("<pendulum_v1 gravity=\"-1\"/>"), ConfigError);
}

}  // namespace
}  // namespace coppice
