#include <gtest/gtest.h>

#include "tests/problems/stepping.h"

namespace coppice {
namespace {

/// Gymnasium's step, line by line, without its rounding to single precision.
Outcome gymnasium(const State2& state, double action) {
  long double position = state[0], velocity = state[1];
  velocity += action * 0.0015L - 0.0025L * std::cos(3 * position);
  if (velocity > 0.07L) velocity = 0.07L;
  if (velocity < -0.07L) velocity = -0.07L;
  position += velocity;
  if (position > 0.6L) position = 0.6L;
  if (position < -1.2L) position = -1.2L;
  if (position == -1.2L && velocity < 0) velocity = 0;
  const bool terminated = position >= 0.45L && velocity >= 0;
  const long double reward = (terminated ? 100 : 0) - 0.1L * std::pow(static_cast<long double>(action), 2);
  return {{static_cast<double>(position), static_cast<double>(velocity)},
          static_cast<double>(reward),
          terminated};
}

TEST(MountainCarContinuous, StepsAgreeWithGymnasiumsEquations) {
  const Stepping step("<mountain_car_continuous/>");
  int walls = 0, goals = 0;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    const auto [state, action] = step.uniform(i);
    const Outcome expected = gymnasium(state, action), made = step(state, action);
    EXPECT_NEAR(made.next[0], expected.next[0], 1e-9);
    EXPECT_NEAR(made.next[1], expected.next[1], 1e-9);
    EXPECT_NEAR(made.reward, expected.reward, 1e-9);
    EXPECT_EQ(made.terminal, expected.terminal);
    walls += made.next[0] == -1.2 ? 1 : 0;
    goals += made.terminal ? 1 : 0;
  }
  EXPECT_GT(walls, 20);
  EXPECT_GT(goals, 20);
}

TEST(MountainCarContinuous, TransitionsByHand) {
  const Stepping step("<mountain_car_continuous/>");
  const Outcome still = step({0, 0}, 1);  // 0.0015 - 0.0025 cos 0
  EXPECT_NEAR(still.next[1], -0.001, 1e-15);
  EXPECT_NEAR(still.next[0], -0.001, 1e-15);
  EXPECT_DOUBLE_EQ(still.reward, -0.1);
  const Outcome wall = step({-1.19, -0.07}, -1);
  EXPECT_EQ(wall.next, (State2{-1.2, 0}));
  EXPECT_DOUBLE_EQ(wall.reward, -0.1);
  const Outcome goal = step({0.44, 0.05}, 0.5);
  EXPECT_TRUE(goal.terminal);
  EXPECT_DOUBLE_EQ(goal.reward, 100 - 0.025);
  EXPECT_FALSE(step({0.5, -0.02}, 0).terminal) << "over the goal, but on the way back";
  EXPECT_EQ(step({0.59, 0.07}, 1).next, (State2{0.6, 0.07})) << "no wall to the right";
  const Outcome clipped = step({0, 0}, 3);
  EXPECT_EQ(clipped.next, still.next);
  EXPECT_DOUBLE_EQ(clipped.reward, -0.1);
  EXPECT_FALSE(Stepping("<mountain_car_continuous goal_velocity=\"0.06\"/>")({0.44, 0.05}, 0.5).terminal);
}

TEST(MountainCarContinuous, PushingTheWayItMovesReachesTheGoal) {
  const Stepping step("<mountain_car_continuous/>");
  const Returns pushing = step.episodes({0, -1e6}, 200);
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_TRUE(pushing.terminal[i]);
    EXPECT_LT(pushing.steps[i], 200);
    // Full force but from rest: at the start, and where the wall has stopped it.
    const double rests = (pushing.total[i] - (100 - 0.1 * pushing.steps[i])) / 0.1;
    EXPECT_TRUE(std::fabs(rests - 1) < 1e-9 || std::fabs(rests - 2) < 1e-9) << rests;
  }
  const Returns idle = step.episodes({0, 0}, 5);
  for (const std::int32_t steps : idle.steps) EXPECT_EQ(steps, 999);
  for (const double total : idle.total) EXPECT_EQ(total, 0);
}

TEST(MountainCarContinuous, StartsAreGymnasiums) {
  const Stepping step("<mountain_car_continuous/>");
  std::vector<double> squares;
  for (std::uint64_t k = 0; k < 2000; ++k) {
    const State2 state = step.start(k);
    EXPECT_TRUE(state[0] >= -0.6 && state[0] < -0.4);
    EXPECT_EQ(state[1], 0);
    squares.push_back((state[0] + 0.5) * (state[0] + 0.5));
  }
  EXPECT_NEAR(estimate(squares).mean, 0.04 / 12, 3 * estimate(squares).error);
}

}  // namespace
}  // namespace coppice
