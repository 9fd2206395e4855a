#include <gtest/gtest.h>

#include <cmath>

#include "tests/solvers/corridor.h"

namespace coppice::testing {
namespace {

/// Q(s, a) = -(a - s / 3)^2: the best action is known. Counts how often it is asked.
class KnownValue : public Function {
 public:
  explicit KnownValue(std::size_t inputs = 2) : inputs_(inputs) {}
  std::size_t inputs() const override { return inputs_; }
  std::size_t outputs() const override { return 1; }
  void predict(std::span<const double> x, std::span<double> y) const override {
    y[0] = -(x[1] - x[0] / 3) * (x[1] - x[0] / 3);
  }
  Maximum maximize(std::span<const double> prefix, const Space&, const Maximization& how) const override {
    leaves = how.leaves;
    return {Vec<kMaxActionSize>{prefix[0] / 3}, 0};
  }
  void save(Archive& archive) const override { archive.put("known", std::vector<double>{1}); }
  void load(Archive&) override {}
  mutable int leaves = 0;

 private:
  std::size_t inputs_;
};

/// Keeps what it is asked to fit.
struct Witness : Approximator {
  static inline Matrix x, y;
  static inline std::uint64_t key = 0;
  MadeFunction fit(const TrainingSet& set, const Draws& draws, Parallel& parallel) const override {
    x = set.x;
    y = set.y;
    key = draws.key();
    EXPECT_TRUE(set.weights.empty());
    return make_from_xml<Approximator>("<constant/>")->fit(set, draws, parallel);
  }
  static Parameters<Witness> parameters() { return {}; }
};
const Component<Approximator, Witness> kWitness("witness", "Keeps what it is asked to fit.",
                                                "no publication");

Lesson with_known_value() {
  Lesson lesson;
  lesson.value.object = std::make_shared<KnownValue>();
  return lesson;
}

const std::string kFpfTable = "<q_value><extra_trees n_min=\"1\" trees=\"5\"/></q_value>";

TEST(Fpf, LearnsToWalkOut) {
  for (const std::string leaves : {"pwc", "pwl"}) {
    const Lesson lesson;
    const TrainingResult result =
        lesson.learn("<fpf iterations=\"6\" policy_samples=\"2000\">" + kFpfTable +
                     "<policy><extra_trees leaves=\"" + leaves + "\"/></policy></fpf>");
    EXPECT_EQ(result.policy.resolved.name, "fitted_policy");
    EXPECT_NEAR(value_at(*result.value, 0, 1), 6.2, 1e-6);
    result.policy.object->prepare(lesson.problem->spaces(), nullptr);
    for (const double place : {0.0, 1.0, 2.0}) {
      Action action;
      result.policy->act({&place, 1}, {}, lesson.draws, action);
      EXPECT_GT(action.values[0], 0) << leaves << " at " << place;
    }
  }
}

TEST(Fpf, FitsTheBestActionsOfAGivenValueFunction) {
  const Lesson lesson = with_known_value();
  const TrainingResult result = lesson.learn("<fpf policy_samples=\"3000\" max_leaves=\"31\"/>");
  EXPECT_EQ(result.value.object, lesson.value.object);
  EXPECT_EQ(dynamic_cast<const KnownValue&>(*lesson.value).leaves, 31);
  result.policy.object->prepare(lesson.problem->spaces(), nullptr);
  for (double place = 0.1; place < 3; place += 0.1) {
    Action action;
    result.policy->act({&place, 1}, {}, lesson.draws, action);
    EXPECT_NEAR(action.values[0], place / 3, 1e-6) << "linear leaves fit a line; at " << place;
  }
}

TEST(Fpf, PolicyStatesAreUniformInTheStateSpace) {
  with_known_value().learn("<fpf policy_samples=\"4000\"><policy><witness/></policy></fpf>");
  ASSERT_EQ(Witness::x.rows(), 4000u);
  std::vector<double> places(Witness::x.column(0).begin(), Witness::x.column(0).end());
  std::sort(places.begin(), places.end());
  double distance = 0;  // Kolmogorov-Smirnov
  for (std::size_t i = 0; i < 4000; ++i) {
    distance = std::max(distance, std::fabs(places[i] / 3 - (static_cast<double>(i) + 0.5) / 4000));
  }
  EXPECT_LT(distance, 1.95 / std::sqrt(4000)) << "one in a thousand is larger";
  for (std::size_t i = 0; i < 4000; ++i) EXPECT_EQ(Witness::y(i, 0), Witness::x(i, 0) / 3);
}

TEST(Fpf, PolicyStatesMayBeThoseOfTheSamples) {
  with_known_value().learn(
      "<fpf policy_samples=\"3000\" policy_states=\"samples\"><policy><witness/></policy></fpf>");
  std::map<double, int> count;
  for (const double place : Witness::x.column(0)) ++count[place];
  ASSERT_EQ(count.size(), 3u);
  for (const double place : {0.0, 1.0, 2.0}) EXPECT_NEAR(count[place], 1000, 4 * std::sqrt(3000 * 2.0 / 9));
}

TEST(Fpf, DependsOnItsDrawsOnly) {
  Lesson lesson = with_known_value();
  const std::string xml = "<fpf policy_samples=\"50\"><policy><witness/></policy></fpf>";
  lesson.learn(xml);
  const Matrix first = Witness::x;
  const std::uint64_t key = Witness::key;
  lesson.learn(xml);
  EXPECT_EQ(Witness::x, first);
  EXPECT_EQ(Witness::key, key);
  lesson.draws = Draws(2018, "corridor", 0);
  lesson.learn(xml);
  EXPECT_NE(Witness::x, first);
  EXPECT_NE(Witness::key, key);
}

TEST(Fpf, GoesOnAfterARestartBeforeAnyUnit) {
  expect_resumable(Lesson(), "<fpf iterations=\"4\" policy_samples=\"300\">" + kFpfTable + "</fpf>", 5);
  expect_resumable(with_known_value(), "<fpf policy_samples=\"300\"/>", 1);
}

TEST(Fpf, SaysWhatItNeeds) {
  const Solver::Needs needs = make_from_xml<Solver>("<fpf/>")->needs();
  EXPECT_TRUE(needs.samples && needs.single_action);
  EXPECT_FALSE(needs.simulator);
  Lesson lesson;
  lesson.value.object = std::make_shared<KnownValue>(3);
  EXPECT_EQ(lesson.refusal("<fpf/>"),
            "<fpf> needs the value of states and actions, a function of 2 numbers; the given value function "
            "has 3");
  lesson.value = {};
  lesson.samples = Dataset(lesson.problem->spaces(), 0);
  EXPECT_EQ(lesson.refusal("<fpf/>"), "fitted Q iteration needs at least one sample");
}

TEST(Fpf, RefusesWhatIsOutOfBounds) {
  for (const std::string given : {"policy_samples=\"0\"", "policy_samples=\"1e10\"", "policy_states=\"grid\"",
                                  "iterations=\"0\"", "discount=\"2\""}) {
    EXPECT_THROW(make_from_xml<Solver>("<fpf " + given + "/>"), ConfigError) << given;
  }
}

}  // namespace
}  // namespace coppice::testing
