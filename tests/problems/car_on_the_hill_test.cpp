#include <gtest/gtest.h>

#include "tests/problems/stepping.h"

namespace coppice {
namespace {

/// H / p: with it H' = (H/p)^3 and H'' = -15 p (H/p)^5 right of the origin.
long double ratio(long double p) {
  return std::pow(1 + 5 * p * p, -0.5L);
}
long double height(long double p) {
  return p < 0 ? p * (p + 1) : p * ratio(p);
}
long double slope(long double p) {
  return p < 0 ? 1 + 2 * p : std::pow(ratio(p), 3);
}

/// Ernst, Geurts and Wehenkel (2005), section 5.1, term by term as it stands there.
State2 ernst(const State2& state, double u) {
  long double p = state[0], s = state[1];
  for (int i = 0; i < 100; ++i) {
    const long double first = slope(p), second = p < 0 ? 2 : -15 * p * std::pow(ratio(p), 5);
    const long double d = 1 + first * first;
    const long double acceleration = u / d - 9.81L * first / d - s * s * first * second / d;
    p += 0.001L * s;
    s += 0.001L * acceleration;
  }
  return {static_cast<double>(p), static_cast<double>(s)};
}

TEST(CarOnTheHill, StepsAgreeWithAnIndependentIntegration) {
  const Stepping step("<car_on_the_hill/>");
  for (std::uint64_t i = 0; i < 500; ++i) {
    const auto [state, u] = step.uniform(i);
    const State2 expected = ernst(state, u), next = step(state, u).next;
    EXPECT_NEAR(next[0], expected[0], 1e-9);
    EXPECT_NEAR(next[1], expected[1], 1e-9);
  }
}

// Along a slope the horizontal force u does the work u dp: that fixes H' and H'' without using the equation.
TEST(CarOnTheHill, EnergyGrowsByTheWorkOfTheForce) {
  const auto energy = [](const State2& x) {
    const long double h = slope(x[0]);
    return static_cast<double>(0.5L * x[1] * x[1] * (1 + h * h) + 9.81L * height(x[0]));
  };
  const Stepping step("<car_on_the_hill/>");
  double worst = 0;
  for (std::uint64_t i = 0; i < 500; ++i) {
    const auto [state, u] = step.uniform(i);
    const State2 next = step(state, u).next;
    if (next[0] < -1 || next[0] > 1 || std::fabs(next[1]) > 3) continue;
    if ((state[0] < 0) != (next[0] < 0)) continue;  // H'' jumps at the origin
    worst = std::max(worst, std::fabs(energy(next) - energy(state) - u * (next[0] - state[0])));
  }
  EXPECT_LT(worst, 0.05);  // Euler steps of 1 ms; energies are about 10
  EXPECT_GT(worst, 0);
}

// Exhaustive search finds no shorter sequence of {-4, 4}.
TEST(CarOnTheHill, NineteenStepsReachTheTop) {
  const Stepping step("<car_on_the_hill/>");
  State2 state = step.start(0);
  EXPECT_EQ(state, (State2{-0.5, 0}));
  for (int t = 0; t < 19; ++t) {
    const Outcome made = step(state, t < 5 ? -4 : 4);
    EXPECT_EQ(made.terminal, t == 18) << t;
    EXPECT_EQ(made.reward, t == 18 ? 1 : 0) << t;
    state = made.next;
  }
  EXPECT_GT(state[0], 1);
}

TEST(CarOnTheHill, FullThrottleAloneDoesNotReachTheTop) {
  const Stepping step("<car_on_the_hill/>");
  State2 state = step.start(0);
  for (int t = 0; t < 100; ++t) {
    const Outcome made = step(state, 4);
    ASSERT_FALSE(made.terminal) << t;
    state = made.next;
  }
}

TEST(CarOnTheHill, LeavingToTheLeftOrTooFastCostsOne) {
  const Stepping step("<car_on_the_hill/>");
  const Outcome left = step({-0.95, -1.5}, -4), down = step({-0.9, 2.95}, 4), fast = step({0.9, 2.99}, 4);
  EXPECT_LT(left.next[0], -1);
  EXPECT_GT(down.next[1], 3);
  EXPECT_GT(fast.next[0], 1) << "over the top, but ...";
  for (const Outcome& made : {left, down}) {
    EXPECT_EQ(made.reward, -1);
    EXPECT_TRUE(made.terminal);
  }
  EXPECT_EQ(fast.reward, std::fabs(fast.next[1]) > 3 ? -1 : 1) << "the limits come first";
  EXPECT_TRUE(fast.terminal);
}

TEST(CarOnTheHill, DefaultsAreErnsts) {
  const Stepping step("<car_on_the_hill/>");
  EXPECT_EQ(step.problem().discount(), 0.95);
  EXPECT_NE(Stepping("<car_on_the_hill start=\"uniform\"/>").start(1), (State2{-0.5, 0}));
  EXPECT_THROW(Stepping("<car_on_the_hill start=\"top\"/>"), ConfigError);
}

}  // namespace
}  // namespace coppice
