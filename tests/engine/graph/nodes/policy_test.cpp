#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/graph/artifacts.h"
#include "tests/engine/graph/nodes/fake_context.h"

namespace coppice::testing {
namespace {

using ::testing::HasSubstr;

Element car_element(const std::string& id = "car") {
  return element("problem", {{"id", id}}, {element("double_integrator", {})});
}
const Element kFeedback = element("linear_feedback", {{"gains", "1, 2"}});

TEST(PolicyNode, IsADefinitionUnlessItHasAProblemOrAFile) {
  EXPECT_TRUE(make_node(element("policy", {{"id", "p"}}, {kFeedback}))->definition());
  EXPECT_FALSE(make_node(element("policy", {{"id", "p"}, {"problem", "car"}}, {kFeedback}))->definition());
}

TEST(PolicyNode, TakesAPolicyOrAFile) {
  EXPECT_THAT(error_of([] {
                make_node(element("policy", {{"id", "p"}}));
              }),
              HasSubstr("either a policy inside"));
  FakeContext context;
  const std::string file = (context.folder() / "some.policy").string();
  write_file(file, "anything");
  EXPECT_THAT(error_of([&] {
                make_node(element("policy", {{"id", "p"}, {"file", file}}, {kFeedback}));
              }),
              HasSubstr("either a policy inside"));
}

TEST(PolicyNode, WritesAFileThatOtherNodesRead) {
  FakeContext context;
  context.given["problem"] = {input(car_element())};
  const Element described = element("policy", {{"id", "p"}, {"problem", "car"}}, {kFeedback});
  const Sub<Node> node = make_node(described);
  node->check(context);
  node->run(context);
  const PolicyFile file = read_policy_file(context.folder() / kPolicyFile);
  EXPECT_EQ(file.component.get("gains"), "1, 2");
  EXPECT_EQ(file.spaces.actions.front().name, "accelerate");

  // Read again from elsewhere, it acts as configured.
  const std::string path = (context.folder() / kPolicyFile).string();
  const Element from_file = element("policy", {{"id", "q"}, {"file", path}});
  FakeContext elsewhere;
  make_node(from_file)->check(elsewhere);
  make_node(from_file)->run(elsewhere);
  const auto problem = load_problem(input(car_element()));
  const MadePolicy policy = load_policy(input(from_file, elsewhere.folder()), *problem);
  Action action;
  policy->act(std::vector<double>{0.1, -0.2}, {}, Draws(1, "test", 0), action);
  EXPECT_NEAR(action.values[0], -(0.1 - 0.4), 1e-15);
  EXPECT_EQ(text_of(elsewhere.folder() / kPolicyFile), text_of(path)) << "who made it stays written there";
}

TEST(PolicyNode, RefusesAFileForAnotherProblem) {
  FakeContext context;
  PolicyFile file;
  file.spaces = {{{"level", "m", 0, 2}}, {{"pump", {{"inflow", "m^3/s", 0, 1}}}}};
  file.component = element("random", {});
  const std::string path = (context.folder() / "tank.policy").string();
  write_policy_file(path, file);
  context.given["problem"] = {input(car_element())};
  const auto node = make_node(element("policy", {{"id", "p"}, {"problem", "car"}, {"file", path}}));
  EXPECT_THAT(error_of([&] { node->check(context); }), HasSubstr("1 axes for the state, the problem 2"));
}

TEST(PolicyNode, RefusesAPolicyThatDoesNotFitItsProblem) {
  FakeContext context;
  context.given["problem"] = {input(car_element())};
  const auto node = make_node(
      element("policy", {{"id", "p"}, {"problem", "car"}}, {element("linear_feedback", {{"gains", "1"}})}));
  EXPECT_THAT(error_of([&] { node->check(context); }), HasSubstr("gains has 1"));
}

TEST(RequireSameAxes, LetsLimitsDifferButNothingElse) {
  const Spaces problem{{{"x", "m", 0, 1}}, {{"go", {{"speed", "m/s", 0, 1}}}}};
  Spaces wider = problem;
  wider.states[0].high = 9;
  wider.actions[0].axes[0].low = -9;
  EXPECT_NO_THROW(require_same_axes(wider, problem, "policy 'p'"));

  Spaces other = problem;
  other.states[0].unit = "rad";
  EXPECT_THAT(error_of([&] { require_same_axes(other, problem, "policy 'p'"); }),
              HasSubstr("policy 'p' has 'x' in rad as axis 1 of the state, the problem 'x' in m"));
  other = problem;
  other.actions[0].name = "stop";
  EXPECT_THAT(error_of([&] { require_same_axes(other, problem, "policy 'p'"); }),
              HasSubstr("'stop' as action 0"));
  other = problem;
  other.actions.push_back({"stop", {}});
  EXPECT_THAT(error_of([&] { require_same_axes(other, problem, "policy 'p'"); }), HasSubstr("2 actions"));
}

TEST(LoadPolicy, GivesNothingWhileALearnedPolicyIsNotThereYet) {
  InputNode learned;
  learned.kind = "train";
  learned.element = shared(element("train", {{"id", "t"}}));
  EXPECT_FALSE(load_policy(learned, *load_problem(input(car_element()))));
}

}  // namespace
}  // namespace coppice::testing
