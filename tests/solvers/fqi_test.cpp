#include <gtest/gtest.h>

#include "solvers/policies/greedy_policy.h"
#include "tests/solvers/corridor.h"

namespace coppice::testing {
namespace {

const std::string kFqiTable = "<q_value><extra_trees n_min=\"1\" trees=\"5\"/></q_value>";

TEST(Fqi, LearnsToWalkOut) {
  const Lesson lesson;
  const TrainingResult result = lesson.learn("<fqi iterations=\"6\">" + kFqiTable + "</fqi>");
  EXPECT_EQ(result.policy.resolved.name, "greedy_policy");
  result.policy.object->prepare(lesson.problem->spaces(), nullptr);
  for (const double place : {0.0, 1.0, 2.0}) {
    Action action;
    result.policy->act({&place, 1}, {}, lesson.draws, action);
    EXPECT_EQ(action.id, 0);
    EXPECT_GT(action.values[0], 0) << "at " << place;
    EXPECT_NEAR(value_at(*result.value, place, 1), QTable(6, 0.9)(static_cast<int>(place), 1), 1e-6);
  }
}

TEST(Fqi, ItsPolicyLooksForActionsAsItsIterationsDo) {
  const TrainingResult result =
      Lesson().learn("<fqi iterations=\"1\" maximization=\"exact\" max_leaves=\"7\">" + kFqiTable + "</fqi>");
  const auto& policy = dynamic_cast<const GreedyPolicy&>(*result.policy);
  EXPECT_EQ(policy.maximization, Maximization::Method::exact);
  EXPECT_EQ(policy.max_leaves, 7);
  EXPECT_EQ(bytes_of(policy.function), bytes_of(result.value));
}

TEST(Fqi, GoesOnAfterARestartBeforeAnyIteration) {
  expect_resumable(Lesson(), "<fqi iterations=\"5\">" + kFqiTable + "</fqi>", 5);
}

TEST(Fqi, TakesAnyApproximator) {
  const TrainingResult result = Lesson().learn("<fqi iterations=\"2\"><q_value><constant/></q_value></fqi>");
  // Q1 = 2/9 everywhere; all targets but the exit's are -1 + 0.9 * 2/9.
  EXPECT_NEAR(value_at(*result.value, 1, 0), (10 + 8 * (-1 + 0.9 * 2 / 9)) / 9, 1e-12);
}

/// What it says, before anything is learned, of a problem with so many action axes.
std::string refusal(const std::string& attributes, const std::string& forest, std::size_t axes) {
  const auto solver =
      make_from_xml<Solver>("<fqi " + attributes + "><q_value>" + forest + "</q_value></fqi>");
  Spaces spaces;
  spaces.actions = {{"push", Space(axes, {"force", "N", -1, 1})}};
  try {
    solver->check(spaces, false);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Fqi, RefusesMaximaThatItsForestsDoNotHaveBeforeItLearns) {
  const std::string oblique = "<extra_trees splits=\"oblique\"/>";
  const std::string trimmed = "<extra_trees aggregation=\"trimmed_mean\"/>";
  EXPECT_EQ(refusal("", oblique, 1), "");
  EXPECT_NE(refusal("", oblique, 2).find("axis-aligned"), std::string::npos);
  EXPECT_NE(refusal("", "<regression_tree splits=\"oblique\"/>", 2).find("axis-aligned"), std::string::npos);
  EXPECT_NE(refusal("maximization=\"merge\"", trimmed, 1).find("choose maximization=\"exact\""),
            std::string::npos);
  EXPECT_EQ(refusal("maximization=\"exact\"", trimmed, 2), "");
  EXPECT_EQ(refusal("maximization=\"ascent\"", trimmed, 1), "");
  EXPECT_NE(refusal("maximization=\"ascent\"", trimmed, 2).find("by ascent"), std::string::npos);
  EXPECT_NE(refusal("", "<merged_tree>" + oblique + "</merged_tree>", 1).find("axis-aligned"),
            std::string::npos);
  EXPECT_NE(refusal("maximization=\"exact\"", "<merged_tree>" + trimmed + "</merged_tree>", 1), "");
  EXPECT_EQ(refusal("", "<merged_tree><extra_trees/></merged_tree>", 3), "");
}

TEST(Fqi, SaysWhatItNeeds) {
  const Solver::Needs needs = make_from_xml<Solver>("<fqi/>")->needs();
  EXPECT_TRUE(needs.samples && needs.single_action);
  EXPECT_FALSE(needs.simulator);
  Lesson lesson;
  lesson.samples = Dataset(lesson.problem->spaces(), 0);
  EXPECT_EQ(lesson.refusal("<fqi/>"), "fitted Q iteration needs at least one sample");
}

TEST(Fqi, RefusesWhatIsOutOfBounds) {
  for (const std::string given : {"iterations=\"0\"", "discount=\"1.5\"", "discount=\"-0.1\"",
                                  "target_min=\"nan\"", "max_leaves=\"0\"", "maximization=\"grid\""}) {
    EXPECT_THROW(make_from_xml<Solver>("<fqi " + given + "/>"), ConfigError) << given;
  }
}

}  // namespace
}  // namespace coppice::testing
