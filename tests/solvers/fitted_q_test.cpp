#include "solvers/fitted_q.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/solvers/corridor.h"
#include "tests/support/threads.h"

namespace coppice::testing {
namespace {

FittedQParameters parameters(int iterations) {
  FittedQParameters parameters;
  parameters.iterations = iterations;
  parameters.q_value = make_from_xml<Approximator>("<extra_trees n_min=\"1\" trees=\"5\"/>");
  parameters.max_leaves = 1000;
  return parameters;
}

void expect_table(const FittedQ& q, const QTable& table) {
  for (int place = 0; place < 3; ++place) {
    for (int by = -1; by <= 1; ++by) {
      EXPECT_NEAR(value_at(*q.function(), place, by), table(place, by), 1e-6)
          << "place " << place << ", by " << by << ", iteration " << q.iteration();
    }
  }
}

TEST(FittedQ, IsDynamicProgrammingOnATable) {
  const Lesson lesson;
  Serial serial;
  for (const auto method : {Maximization::Method::merge, Maximization::Method::exact}) {
    FittedQParameters given = parameters(5);
    given.maximization = method;
    FittedQ q(given, lesson.inputs());
    for (int n = 1; !q.done(); ++n) {
      q.iterate(serial);
      EXPECT_EQ(q.iteration(), n);
      expect_table(q, QTable(n, 0.9));
    }
    EXPECT_EQ(q.iteration(), 5);
    EXPECT_NEAR(value_at(*q.function(), 2, 1), 10, 1e-12);  // by hand
    EXPECT_NEAR(value_at(*q.function(), 1, 1), 8, 1e-12);
    EXPECT_NEAR(value_at(*q.function(), 0, 1), 6.2, 1e-6);
    EXPECT_NEAR(value_at(*q.function(), 0, -1), -1 + 0.9 * 6.2, 1e-6);
  }
}

TEST(FittedQ, TakesAGivenDiscountAndALeastTarget) {
  const Lesson lesson;
  Serial serial;
  FittedQParameters given = parameters(4);
  given.discount = 0.5;
  given.target_min = -0.25;
  FittedQ q(given, lesson.inputs());
  while (!q.done()) {
    q.iterate(serial);
    expect_table(q, QTable(q.iteration(), 0.5, -0.25));
  }
  given.discount = 0;
  given.target_min.reset();
  FittedQ greedy(given, lesson.inputs());
  while (!greedy.done()) greedy.iterate(serial);
  expect_table(greedy, QTable(1, 0));
}

TEST(FittedQ, MeasuresItsTargets) {
  const Lesson lesson;
  Serial serial;
  FittedQ q(parameters(3), lesson.inputs());
  q.iterate(serial);  // eight steps that cost 1, one worth 10
  EXPECT_EQ(q.measures()[0], std::make_pair(std::string("mean_target"), 2.0 / 9));
  EXPECT_DOUBLE_EQ(q.measures()[1].second, std::sqrt((8 * 1 + 100) / 9.0));
  q.iterate(serial);
  double mean = 0, change = 0;
  for (int place = 0; place < 3; ++place) {
    for (int by = -1; by <= 1; ++by) {
      mean += QTable(2, 0.9)(place, by) / 9;
      change += std::pow(QTable(2, 0.9)(place, by) - QTable(1, 0.9)(place, by), 2) / 9;
    }
  }
  EXPECT_NEAR(q.measures()[0].second, mean, 1e-12);
  EXPECT_NEAR(q.measures()[1].second, std::sqrt(change), 1e-12);
}

TEST(FittedQ, IsTheSameOnThreads) {
  Lesson lesson;
  lesson.samples = join(std::vector<Dataset>(40, all_moves()));  // several chunks
  Serial serial;
  Threads threads(3);
  FittedQ a(parameters(3), lesson.inputs()), b(parameters(3), lesson.inputs());
  while (!a.done()) a.iterate(serial), b.iterate(threads);
  EXPECT_EQ(bytes_of(a.function()), bytes_of(b.function()));
}

TEST(FittedQ, RefusesSamplesThatCannotBeUsed) {
  const auto refusal = [](const Lesson& lesson) -> std::string {
    try {
      FittedQ(parameters(1), lesson.inputs());
    } catch (const std::invalid_argument& refused) {
      return refused.what();
    }
    return "";
  };
  Lesson lesson;
  EXPECT_EQ(refusal(lesson), "");
  lesson.samples.states(4, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(lesson), "");
  lesson.samples = all_moves();
  lesson.samples.actions(4, 0) = std::numeric_limits<double>::infinity();
  EXPECT_NE(refusal(lesson), "");
  lesson.samples = Dataset(lesson.problem->spaces(), 0);
  EXPECT_EQ(refusal(lesson), "fitted Q iteration needs at least one sample");
  TrainingInputs none = lesson.inputs();
  none.samples = nullptr;
  EXPECT_THROW(FittedQ(parameters(1), none), std::invalid_argument);
}

TEST(FittedQ, RefusesACheckpointOfAnotherTraining) {
  const Lesson lesson;
  Serial serial;
  FittedQ q(parameters(3), lesson.inputs());
  while (!q.done()) q.iterate(serial);
  Archive checkpoint;
  q.save(checkpoint);
  Lesson longer = lesson;
  longer.samples = join({all_moves(), all_moves()});
  FittedQ other_samples(parameters(3), longer.inputs()), fewer(parameters(2), lesson.inputs());
  EXPECT_THROW(other_samples.load(checkpoint), std::runtime_error);
  EXPECT_THROW(fewer.load(checkpoint), std::runtime_error);
  Archive empty;
  EXPECT_THROW(other_samples.load(empty), std::runtime_error);
}

TEST(BestActions, AreThoseOfEachState) {
  const Lesson lesson;
  Serial serial;
  FittedQ q(parameters(5), lesson.inputs());
  while (!q.done()) q.iterate(serial);
  const Maximization exact{Maximization::Method::exact, 1};
  Matrix states(150, 1);  // several chunks
  for (std::size_t i = 0; i < 150; ++i) states(i, 0) = static_cast<double>(i) / 50;
  Threads threads(3);
  const Space& box = lesson.problem->spaces().actions.front().axes;
  const Matrix actions = best_actions(*q.function(), states, box, exact, threads);
  ASSERT_EQ(actions.rows(), 150u);
  for (std::size_t i = 0; i < 150; ++i) {
    EXPECT_EQ(actions(i, 0), q.function()->maximize({&states(i, 0), 1}, box, exact).at[0]);
    EXPECT_GT(actions(i, 0), 0) << "towards the exit";
  }
}

}  // namespace
}  // namespace coppice::testing
