#include "solvers/transition_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/solvers/corridor.h"
#include "tests/support/threads.h"

namespace coppice::testing {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Transitions from uniform states and actions of a point that moves by half its action; walking beyond 1
/// ends the episode and costs 50.
struct Walk {
  Spaces spaces{{{"place", "m", -1, 1}}, {{"walk", {{"by", "m", -1, 1}}}}};
  double noise = 0;
  bool ends = true;

  Dataset samples(std::size_t count) const {
    Dataset made(spaces, count);
    for (std::size_t i = 0; i < count; ++i) {
      const Draws draws = Draws(7, "walk", 0).scenario(i);
      const double place = draws.uniform("place", -1, 1), by = draws.uniform("by", -1, 1);
      made.states(i, 0) = place;
      made.set_action(i, {0, {by}});
      made.next(i, 0) = next(place, by) + draws.uniform("noise", -noise, noise);
      made.terminal[i] = ends && made.next(i, 0) > 1 ? 1 : 0;
      made.reward[i] = made.terminal[i] != 0 ? -50 : reward(place, by);
    }
    return made;
  }
  static double next(double place, double by) { return place + 0.5 * by; }
  static double reward(double place, double by) { return 2 * place - by - 3; }
};

Dataset modelled(const Dataset& samples, std::size_t count, const std::string& xml) {
  Serial serial;
  return model_transitions(samples, *make_from_xml<Approximator>(xml), count, Draws(1, "model", 0), serial);
}

const std::string kModel = "<extra_trees leaves=\"pwl\" n_min=\"5\" margin=\"0.5\"/>";

TEST(TransitionModel, IsExactWhereTheProblemIsLinear) {
  const Dataset made = modelled(Walk().samples(400), 2000, kModel);
  ASSERT_EQ(made.rows(), 2000u);
  std::size_t wrong_ends = 0;
  for (std::size_t i = 0; i < made.rows(); ++i) {
    const double place = made.states(i, 0), by = made.actions(i, 0);
    EXPECT_GE(place, -1);
    EXPECT_LE(place, 1);
    EXPECT_NEAR(made.next(i, 0), Walk::next(place, by), 1e-6);
    const bool terminal = Walk::next(place, by) > 1;
    if ((made.terminal[i] != 0) != terminal) {
      ++wrong_ends;
      EXPECT_NEAR(made.next(i, 0), 1, 0.05) << "wrong about the end, and not near the limit";
    } else {
      EXPECT_NEAR(made.reward[i], terminal ? -50 : Walk::reward(place, by), 1e-6);
    }
  }
  EXPECT_LT(wrong_ends, 20u);
}

TEST(TransitionModel, DrawsStatesAndActionsUniformlyAndApart) {
  const Dataset made = modelled(Walk().samples(50), 4000, kModel);
  double place = 0, by = 0, both = 0;
  for (std::size_t i = 0; i < made.rows(); ++i) {
    place += made.states(i, 0) / 4000;
    by += made.actions(i, 0) / 4000;
    both += made.states(i, 0) * made.actions(i, 0) / 4000;
  }
  // Standard errors: 0.577 / sqrt(4000) = 0.009, of the product 0.005.
  EXPECT_NEAR(place, 0, 0.04);
  EXPECT_NEAR(by, 0, 0.04);
  EXPECT_NEAR(both, 0, 0.02);
}

TEST(TransitionModel, HoldsTheMeanOfANoisyStep) {
  Walk walk;
  walk.noise = 0.2;
  walk.ends = false;
  const Dataset made = modelled(walk.samples(4000), 500, "<linear/>");
  for (std::size_t i = 0; i < made.rows(); ++i) {
    EXPECT_NEAR(made.next(i, 0), Walk::next(made.states(i, 0), made.actions(i, 0)), 0.02);
    EXPECT_EQ(made.terminal[i], 0) << "no sample ended";
  }
}

TEST(TransitionModel, EndsEveryEpisodeWhenEverySampleDid) {
  Dataset samples = Walk().samples(100);
  for (auto& terminal : samples.terminal) terminal = 1;
  const Dataset made = modelled(samples, 50, kModel);
  for (std::size_t i = 0; i < made.rows(); ++i) EXPECT_EQ(made.terminal[i], 1);
}

TEST(TransitionModel, GoesTheShortWayRoundACircle) {
  Walk walk;
  walk.spaces.states = {{"angle", "rad", -kPi, kPi, true}};
  Dataset samples(walk.spaces, 500);
  const auto wrapped = [](double angle) { return std::remainder(angle, 2 * kPi); };
  for (std::size_t i = 0; i < samples.rows(); ++i) {
    const Draws draws = Draws(7, "circle", 0).scenario(i);
    samples.states(i, 0) = draws.uniform("angle", -kPi, kPi);
    samples.set_action(i, {0, {draws.uniform("by", -1, 1)}});
    samples.next(i, 0) = wrapped(samples.states(i, 0) + samples.actions(i, 0));
  }
  const Dataset made = modelled(samples, 500, "<linear/>");
  for (std::size_t i = 0; i < made.rows(); ++i) {
    EXPECT_GE(made.next(i, 0), -kPi);
    EXPECT_LT(made.next(i, 0), kPi);
    EXPECT_NEAR(wrapped(made.next(i, 0) - made.states(i, 0) - made.actions(i, 0)), 0, 1e-9);
  }
}

TEST(TransitionModel, IsTheSameForAnyNumberOfThreads) {
  const Dataset samples = Walk().samples(100);
  const auto model = make_from_xml<Approximator>(kModel);
  Serial serial;
  Threads threads(3);
  const Draws draws(1, "model", 0);
  const Dataset one = model_transitions(samples, *model, 1000, draws, serial);
  const Dataset three = model_transitions(samples, *model, 1000, draws, threads);
  EXPECT_EQ(one.states, three.states);
  EXPECT_EQ(one.actions, three.actions);
  EXPECT_EQ(one.next, three.next);
  EXPECT_EQ(one.reward, three.reward);
  EXPECT_EQ(one.terminal, three.terminal);
}

TEST(TransitionModel, RefusesAnAxisWithoutLimits) {
  Dataset samples = Walk().samples(100);
  samples.spaces.states[0].high = std::numeric_limits<double>::infinity();
  EXPECT_THROW(modelled(samples, 10, kModel), std::invalid_argument);
}

TEST(FittedQ, LearnsFromAModelOfAFewSamplesAndResumes) {
  const std::string xml =
      "<fqi iterations=\"4\" model_samples=\"300\" maximization=\"exact\"><model><extra_trees leaves=\"pwl\" "
      "n_min=\"2\"/></model><q_value><extra_trees n_min=\"2\" trees=\"5\"/></q_value></fqi>";
  expect_resumable(Lesson(), xml, 4);
}

}  // namespace
}  // namespace coppice::testing
