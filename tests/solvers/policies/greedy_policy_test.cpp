#include "solvers/policies/greedy_policy.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/make.h"

namespace coppice {
namespace {

const Spaces kGreedySpaces = {{{"x", "m", -1, 1}},
                              {{"push", {{"force", "N", -2, 2}, {"turn", "rad", 0, 1}}}}};

/// Two trees over x, force and turn: one rises by 1 above force = 1, the other by 2 below force = 1.5 where
/// x > 0; both by 4 above turn = 1/2.
Sub<Policy> forest(const std::string& attributes = "maximization=\"exact\"") {
  Sub<Policy> policy = make_from_xml<Policy>("<greedy_policy " + attributes +
                                             "><function><forest/></function></greedy_policy>");
  Archive archive;
  using Ints = std::vector<std::int32_t>;
  archive.put("shape", std::vector<std::int64_t>{3, 1, 0});
  archive.put("roots", Ints{0, 5});
  archive.put("features", Ints{1, 3, 2, 3, 3, 0, 3, 1, 2, 3, 3, 3});
  archive.put("children", Ints{1, 1, 3, 3, 4, 6, 6, 8, 10, 9, 10, 11});
  archive.put("values", std::vector<double>{1, 0, 0.5, 1, 5, 0, 0, 1.5, 0.5, 0, 2, 6});
  archive.put("models", std::vector<double>{});
  policy.object->load(archive);
  return policy;
}

Action act(const Policy& policy, double x) {
  Action action{7, {}};
  policy.act({&x, 1}, {}, Draws(1, "", 0), action);
  return action;
}

TEST(GreedyPolicy, TakesTheCentreOfTheBestLeaf) {
  for (const std::string how : {"maximization=\"exact\"", "maximization=\"merge\" max_leaves=\"50\""}) {
    const Sub<Policy> policy = forest(how);
    policy.object->prepare(kGreedySpaces, nullptr);
    EXPECT_EQ(act(*policy, 0.5), (Action{0, {1.25, 0.75}})) << how;  // (5 + 6) / 2
    EXPECT_EQ(act(*policy, -0.5), (Action{0, {1.5, 0.75}})) << how;  // (5 + 0) / 2
  }
}

TEST(GreedyPolicy, PrunesToItsLeaves) {
  const Sub<Policy> policy = forest("maximization=\"merge\" max_leaves=\"1\"");
  policy.object->prepare(kGreedySpaces, nullptr);
  EXPECT_EQ(act(*policy, 0.5), (Action{0, {0.0, 0.5}})) << "one leaf, the whole box";
}

TEST(GreedyPolicy, SaysWhatTheProblemExpects) {
  const auto refusal = [](const Spaces& spaces) -> std::string {
    try {
      forest().object->prepare(spaces, nullptr);
    } catch (const std::invalid_argument& refused) {
      return refused.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(kGreedySpaces), "");
  Spaces spaces = kGreedySpaces;
  spaces.actions.push_back({"wait", {}});
  EXPECT_EQ(refusal(spaces), "<greedy_policy> chooses the parameters of one action; the problem has 2");
  spaces = kGreedySpaces;
  spaces.states.push_back({"v", "m/s", -1, 1});
  EXPECT_EQ(refusal(spaces),
            "<greedy_policy>: its value function has 3 inputs; the problem's state and action have 4");
  EXPECT_THROW(make_from_xml<Policy>("<greedy_policy/>"), ConfigError);
  EXPECT_THROW(
      make_from_xml<Policy>("<greedy_policy max_leaves=\"0\"><function><forest/></function></greedy_policy>"),
      ConfigError);
}

}  // namespace
}  // namespace coppice
