#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "engine/vocabulary/policy.h"
#include "tests/support/make.h"

namespace coppice {
namespace {

const Spaces kSpaces = {{{"x", "m", -1, 1}, {"v", "m/s", -1, 1}},
                        {{"push", {{"force", "N", -2, 2}, {"turn", "rad", 0, 1}}}, {"wait", {}}}};

Sub<Policy> prepared(const std::string& xml, const Spaces& spaces = kSpaces) {
  Sub<Policy> policy = make_from_xml<Policy>(xml);
  policy.object->prepare(spaces, nullptr);
  return policy;
}

Action act(const Policy& policy, std::vector<double> state, const Draws& draws = Draws(1, "test", 0)) {
  Action action;
  policy.act(state, {}, draws, action);
  return action;
}

std::string refusal(const std::string& xml, const Spaces& spaces = kSpaces) {
  try {
    prepared(xml, spaces);
  } catch (const std::invalid_argument& refused) {
    return refused.what();
  }
  return "";
}

TEST(RandomPolicy, IsUniformOverActionsAndOverTheirBoxes) {
  const Sub<Policy> policy = prepared("<random/>");
  int waits = 0;
  double force = 0, square = 0, turn = 0, product = 0;
  constexpr int n = 40000;
  for (std::uint32_t i = 0; i < n; ++i) {
    const Action action = act(*policy, {0, 0}, Draws(1, "test", 0).scenario(i));
    if (action.id == 1) {
      ++waits;
      EXPECT_EQ(action.values.size(), 0u);
      continue;
    }
    ASSERT_EQ(action.values.size(), 2u);
    EXPECT_TRUE(action.values[0] >= -2 && action.values[0] < 2 && action.values[1] >= 0 &&
                action.values[1] < 1);
    force += action.values[0];
    square += action.values[0] * action.values[0];
    turn += action.values[1];
    product += action.values[0] * (action.values[1] - 0.5);
  }
  const double pushes = n - waits;  // all limits: four standard errors
  EXPECT_NEAR(waits, n / 2, 400);
  EXPECT_NEAR(force / pushes, 0, 0.033);
  EXPECT_NEAR(square / pushes, 4.0 / 3, 0.034);
  EXPECT_NEAR(turn / pushes, 0.5, 0.0082);
  EXPECT_NEAR(product / pushes, 0, 0.0095);
}

TEST(RandomPolicy, NeedsLimits) {
  Spaces spaces = kSpaces;
  spaces.actions[0].axes[0].high = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal("<random/>", spaces), "<random>: 'force' of action 'push' has no limits");
}

TEST(ConstantPolicy, TakesItsActionEverywhere) {
  const Sub<Policy> policy = prepared("<constant values=\"0.5, 0.25\"/>");
  EXPECT_EQ(act(*policy, {0, 0}), (Action{0, {0.5, 0.25}}));
  EXPECT_EQ(act(*policy, {1, -1}), (Action{0, {0.5, 0.25}}));
  EXPECT_EQ(act(*prepared("<constant action=\"1\"/>"), {0, 0}).id, 1);
}

TEST(ConstantPolicy, ItsValuesLieInTheBox) {
  EXPECT_EQ(act(*prepared("<constant values=\"5, -5\"/>"), {0, 0}), (Action{0, {2.0, 0.0}}));
  EXPECT_EQ(act(*prepared("<constant/>"), {0, 0}), (Action{0, {0.0, 0.0}}));
}

TEST(ConstantPolicy, SaysWhatTheProblemExpects) {
  EXPECT_EQ(refusal("<constant action=\"2\"/>"),
            "<constant>: action is 2, but the problem has the actions 0 to 1");
  EXPECT_EQ(refusal("<constant values=\"1\"/>"),
            "<constant>: values has 1 numbers, but action 'push' has 2 parameters");
  EXPECT_THROW(make_from_xml<Policy>("<constant action=\"-1\"/>"), ConfigError);
}

TEST(LinearFeedback, IsOffsetMinusGainsTimesState) {
  const Sub<Policy> policy = prepared("<linear_feedback gains=\"1, 2, 0.5, -0.25\" offset=\"0.125, 0.5\"/>");
  const Action action = act(*policy, {0.25, -0.5});
  EXPECT_EQ(action.values[0], 0.125 - (0.25 - 1.0));
  EXPECT_EQ(action.values[1], 0.5 - (0.125 + 0.125));
}

TEST(LinearFeedback, ItsActionLiesInTheBox) {
  const Sub<Policy> policy = prepared("<linear_feedback gains=\"10, 0, 10, 0\"/>");
  EXPECT_EQ(act(*policy, {1, 0}), (Action{0, {-2.0, 0.0}}));
  EXPECT_EQ(act(*policy, {-1, 0}), (Action{0, {2.0, 1.0}}));
}

TEST(LinearFeedback, SaysWhatTheProblemExpects) {
  EXPECT_EQ(
      refusal("<linear_feedback gains=\"1, 2\"/>"),
      "<linear_feedback>: gains has 2 numbers, expected are 2 x 2 = 4: a row of 2 for each action parameter");
  EXPECT_EQ(refusal("<linear_feedback gains=\"1, 2, 3, 4\" offset=\"1\"/>"),
            "<linear_feedback>: offset has 1 numbers, expected is one for each of the 2 action parameters");
  EXPECT_EQ(refusal("<linear_feedback gains=\"1\" action=\"3\"/>"),
            "<linear_feedback>: action is 3, but the problem has the actions 0 to 1");
  EXPECT_THROW(make_from_xml<Policy>("<linear_feedback/>"), ConfigError);
}

}  // namespace
}  // namespace coppice
