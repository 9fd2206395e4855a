#include "solvers/policies/fitted_policy.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/make.h"

namespace coppice {
namespace {

const Spaces kFittedSpaces = {{{"x", "m", -1, 1}, {"v", "m/s", -1, 1}},
                              {{"push", {{"force", "N", -2, 2}, {"turn", "rad", 0, 1}}}}};

/// force = 1 + 2 x - v, turn = x.
Sub<Policy> linear() {
  Sub<Policy> policy = make_from_xml<Policy>("<fitted_policy><function><linear/></function></fitted_policy>");
  Archive archive;
  archive.put("slopes", std::vector<double>{2, -1, 1, 0});
  archive.put("bias", std::vector<double>{1, 0});
  policy.object->load(archive);
  return policy;
}

std::string refusal(const Spaces& spaces) {
  try {
    linear().object->prepare(spaces, nullptr);
  } catch (const std::invalid_argument& refused) {
    return refused.what();
  }
  return "";
}

TEST(FittedPolicy, IsItsFunctionMovedIntoTheBox) {
  const Sub<Policy> policy = linear();
  policy.object->prepare(kFittedSpaces, nullptr);
  Action action{7, {1, 2, 3}};
  policy->act(std::array{0.25, 0.5}, {}, Draws(1, "", 0), action);
  EXPECT_EQ(action, (Action{0, {1.0, 0.25}}));
  policy->act(std::array{1.0, -1.0}, {}, Draws(1, "", 0), action);
  EXPECT_EQ(action, (Action{0, {2.0, 1.0}}));
  policy->act(std::array{-1.0, 1.0}, {}, Draws(1, "", 0), action);
  EXPECT_EQ(action, (Action{0, {-2.0, 0.0}}));
}

TEST(FittedPolicy, SaysWhatTheProblemExpects) {
  Spaces spaces = kFittedSpaces;
  spaces.actions.push_back({"wait", {}});
  EXPECT_EQ(refusal(spaces), "<fitted_policy> chooses the parameters of one action; the problem has 2");
  spaces = kFittedSpaces;
  spaces.states.pop_back();
  EXPECT_EQ(
      refusal(spaces),
      "<fitted_policy>: its function leads from 2 to 2 numbers; the problem's state has 1 and its action 2");
  spaces = kFittedSpaces;
  spaces.actions[0].axes.pop_back();
  EXPECT_NE(refusal(spaces), "");
  EXPECT_EQ(refusal(kFittedSpaces), "");
  EXPECT_THROW(make_from_xml<Policy>("<fitted_policy/>"), ConfigError);
}

}  // namespace
}  // namespace coppice
