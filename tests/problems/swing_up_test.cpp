#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/problems/stepping.h"

namespace coppice {
namespace {

struct Plant {
  const char* body;
  long double inertia, weight;  // weight: m g c, of the centre of mass
};
// I = m l^2 / 3 about the end of a rod of 5 kg and 1 m; m l^2 for a mass at its end.
constexpr Plant kRod{"rod", 5.0L / 3, 24.525L}, kPoint{"point", 5.0L, 49.05L};

/// Semi-implicit Euler steps of 1 ms; dry friction by cases.
Outcome integrated(const Plant& plant, const State2& state, double torque) {
  const long double pi = std::numbers::pi_v<long double>;
  long double angle = state[0], speed = state[1];
  for (int i = 0; i < 100; ++i) {
    speed += (plant.weight * std::sin(angle) + torque - 0.1L * speed) / plant.inertia * 0.001L;
    const long double loss = 0.1L / plant.inertia * 0.001L;
    if (speed > loss) {
      speed -= loss;
    } else if (speed < -loss) {
      speed += loss;
    } else {
      speed = 0;
    }
    angle += 0.001L * speed;
  }
  angle = std::remainder(angle, 2 * pi);
  const bool terminal = std::fabs(speed) > 10;
  const long double reward = -std::fabs(angle) / pi - std::pow(torque / 15.0L, 2);
  return {{static_cast<double>(angle), static_cast<double>(speed)},
          terminal ? -50 : static_cast<double>(reward),
          terminal};
}

TEST(SwingUp, StepsAgreeWithAnIndependentIntegration) {
  int ended = 0;
  for (const Plant& plant : {kRod, kPoint}) {
    const Stepping step(fmt::format("<swing_up body=\"{}\"/>", plant.body));
    for (std::uint64_t i = 0; i < 500; ++i) {
      const auto [state, torque] = step.uniform(i);
      const Outcome expected = integrated(plant, state, torque), made = step(state, torque);
      EXPECT_NEAR(std::remainder(made.next[0] - expected.next[0], 2 * kPi), 0, 1e-9);
      EXPECT_NEAR(made.next[1], expected.next[1], 1e-9);
      EXPECT_NEAR(made.reward, expected.reward, 1e-9);
      EXPECT_EQ(made.terminal, expected.terminal);
      EXPECT_TRUE(made.next[0] >= -kPi && made.next[0] < kPi);
      ended += made.terminal ? 1 : 0;
    }
  }
  EXPECT_GT(ended, 10);
}

/// The largest change of energy within ten seconds without friction or torque.
double energy_error(const Plant& plant, int substeps) {
  const Stepping step(fmt::format("<swing_up body=\"{}\" damping=\"0\" dry_friction=\"0\" substeps=\"{}\"/>",
                                  plant.body, substeps));
  const auto energy = [&](const State2& x) {
    return static_cast<double>(plant.inertia * x[1] * x[1] / 2 + plant.weight * std::cos(x[0]));
  };
  State2 state = {0.5, 0};
  const double first = energy(state);
  double worst = 0;
  for (int t = 0; t < 100; ++t) {
    state = step(state, 0).next;
    worst = std::max(worst, std::fabs(energy(state) - first));
  }
  return worst;
}

TEST(SwingUp, EnergyIsConservedWithoutFriction) {
  for (const Plant& plant : {kRod, kPoint}) {
    const double coarse = energy_error(plant, 100), fine = energy_error(plant, 10000);
    EXPECT_LT(coarse, 0.01 * static_cast<double>(plant.weight));
    EXPECT_LT(fine, 1e-4 * static_cast<double>(plant.weight));
    EXPECT_NEAR(coarse / fine, 100, 15) << "the error is that of steps of first order";
  }
}

// theta = pi + a cos(w t), w^2 = m g c / I, for small a.
TEST(SwingUp, SmallSwingsAreHarmonic) {
  for (const Plant& plant : {kRod, kPoint}) {
    const Stepping step(fmt::format(
        "<swing_up body=\"{}\" damping=\"0\" dry_friction=\"0\" substeps=\"10000\"/>", plant.body));
    const double w = std::sqrt(static_cast<double>(plant.weight / plant.inertia)), a = 1e-3;
    State2 state = {-kPi + a, 0};
    for (int t = 1; t <= 50; ++t) {
      state = step(state, 0).next;
      EXPECT_NEAR(std::remainder(state[0] + kPi, 2 * kPi), a * std::cos(w * 0.1 * t), 2e-3 * a) << t;
    }
  }
}

// Coulomb friction takes 4 friction / (m g c) of the amplitude in each period (of small swings), then holds.
TEST(SwingUp, DryFrictionTakesAFixedPartOfTheAmplitude) {
  const double w = std::sqrt(24.525 * 3 / 5), loss = 4 * 0.1 / 24.525;
  const Stepping step("<swing_up damping=\"0\" substeps=\"10000\"/>");
  State2 state = {-kPi + 0.05, 0};
  double furthest = 0;
  for (int t = 1; t <= 16; ++t) {  // T = 1.638 s
    state = step(state, 0).next;
    const double angle = std::remainder(state[0] + kPi, 2 * kPi);
    // Energy as an amplitude, about the centre that friction shifts.
    const double centre = state[1] > 0 ? -loss / 4 : loss / 4;
    furthest = std::hypot(angle - centre, state[1] / w);
  }
  EXPECT_NEAR(furthest, 0.05 - 0.75 * loss, 1e-4) << "third half swing";
  for (int t = 0; t < 200; ++t) state = step(state, 0).next;
  EXPECT_EQ(state[1], 0) << "comes to rest";
  EXPECT_LT(std::fabs(std::remainder(state[0] + kPi, 2 * kPi)), loss / 4 + 1e-9);
}

TEST(SwingUp, FrictionHoldsAgainstASmallTorque) {
  const Stepping step("<swing_up/>");
  EXPECT_EQ(step({0, 0}, 0.099).next, (State2{0, 0}));
  EXPECT_NE(step({0, 0}, 0.11).next, (State2{0, 0}));
}

TEST(SwingUp, TheMotorIsTooWeakToLiftIt) {
  for (const Plant& plant : {kRod, kPoint}) {
    const Stepping step(fmt::format("<swing_up body=\"{}\"/>", plant.body));
    State2 state = step.start(0);
    for (int t = 0; t < 100; ++t) {
      state = step(state, 15).next;
      ASSERT_GT(std::fabs(state[0]), 0.5) << t;
    }
  }
}

// By dynamic programming no policy costs less than 20.95 from rest.
TEST(SwingUp, ALawOfEnergySwingsItUpAtNoLessThanTheOptimum) {
  const Stepping step("<swing_up/>");
  const Returns returns = step.episodes_of(
      "<energy_swing_up stiffness=\"14.715\" energy_gain=\"2\" gains=\"30, 8\" catch_speed=\"3\"/>", 1);
  EXPECT_EQ(returns.steps[0], 100);
  EXPECT_GT(-returns.total[0], 20.9);
  EXPECT_LT(-returns.total[0], 30);  // hanging down for ten seconds costs 100
}

TEST(SwingUp, StartsHangDown) {
  EXPECT_EQ(Stepping("<swing_up/>").start(1), (State2{-kPi, 0}));
  const Stepping near("<swing_up start=\"near_down\"/>");
  bool left = false, right = false;
  for (std::uint64_t k = 0; k < 100; ++k) {
    const State2 state = near.start(k);
    EXPECT_GE(std::fabs(state[0]), kPi * 179 / 180 - 1e-12);
    EXPECT_LE(std::fabs(state[1]), kPi / 180);
    (state[0] < 0 ? left : right) = true;
  }
  EXPECT_TRUE(left && right);
}

TEST(SwingUp, DefaultsAreTheThesis) {
  const Stepping step("<swing_up/>");
  EXPECT_EQ(step.problem().horizon(), 100);
  EXPECT_EQ(step({0, 9.9}, 15).reward, -50);
  EXPECT_EQ(Stepping("<swing_up penalty=\"7\"/>")({0, 9.9}, 15).reward, -7);
  EXPECT_THROW(Stepping("<swing_up body=\"disc\"/>"), ConfigError);
  EXPECT_THROW(Stepping("<swing_up substeps=\"0\"/>"), ConfigError);
}

}  // namespace
}  // namespace coppice
