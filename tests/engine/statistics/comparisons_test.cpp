#include "engine/statistics/comparisons.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace coppice {
namespace {

Summary summary_of(const std::vector<double>& values, double mean) {
  return {mean, t_interval(values), static_cast<std::int64_t>(values.size())};
}

// Means 3 and 6, variances of the means 1/2 and 2: 5.882 degrees of freedom, whose quantile is 2.45882371.
TEST(WelchInterval, AgreesWithACalculationByHand) {
  const std::optional<Interval> interval =
      welch_interval(summary_of({1, 2, 3, 4, 5}, 3), summary_of({2, 4, 6, 8, 10}, 6));
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->low, -0.88774164, 1e-7);
  EXPECT_NEAR(interval->high, 6.88774164, 1e-7);
}

TEST(WelchInterval, IsThatOfTheOtherSampleWhenOneDoesNotVary) {
  const std::vector<double> values = {1, 2, 4, 9};
  const std::optional<Interval> interval = welch_interval(summary_of({0, 0, 0}, 0), summary_of(values, 4));
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->low, t_interval(values)->low, 1e-12);
  EXPECT_NEAR(interval->high, t_interval(values)->high, 1e-12);
}

TEST(WelchInterval, NeedsBothIntervals) {
  EXPECT_FALSE(welch_interval({1, std::nullopt, 1}, summary_of({1, 2, 3}, 2)));
  EXPECT_FALSE(welch_interval(summary_of({1, 2, 3}, 2), {1, std::nullopt, 1}));
  const std::optional<Interval> none = welch_interval(summary_of({2, 2}, 2), summary_of({3, 3}, 3));
  ASSERT_TRUE(none);
  EXPECT_EQ(none->low, 1);
  EXPECT_EQ(none->high, 1);
}

TEST(PairedDifferences, AreTakenInOrder) {
  EXPECT_EQ(paired_differences(std::vector<double>{3, 5}, std::vector<double>{1, 9}),
            (std::vector<double>{2, -4}));
  EXPECT_THROW(paired_differences(std::vector<double>{1}, std::vector<double>{1, 2}), std::logic_error);
}

// The worked example of the article "Holm-Bonferroni method" (Wikipedia): 0.005 and 0.01 are rejected at
// 0.05, 0.03 is not, and 0.04 therefore is not either.
TEST(HolmAdjusted, ReproducesAWorkedExample) {
  const std::vector<double> adjusted = holm_adjusted(std::vector<double>{0.01, 0.04, 0.03, 0.005});
  const double expected[] = {0.03, 0.06, 0.06, 0.02};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(adjusted[i], expected[i], 1e-15) << i;
}

TEST(HolmAdjusted, EndsAtOneAndLeavesOutWhatWasNotTested) {
  const std::vector<double> adjusted = holm_adjusted(std::vector<double>{0.9, NAN, 0.02, 0.8});
  EXPECT_EQ(adjusted[0], 1);
  EXPECT_TRUE(std::isnan(adjusted[1]));
  EXPECT_NEAR(adjusted[2], 0.06, 1e-15);
  EXPECT_EQ(adjusted[3], 1);
  EXPECT_TRUE(holm_adjusted({}).empty());
}

// Agarwal et al.'s own test data (rliable, tests/rliable/metrics_test.py): four runs of X and three of Y on
// two tasks; the mean of the tasks' probabilities is 1/3.
TEST(ProbabilityOfImprovement, ReproducesAgarwalsExample) {
  const std::vector<double> x[] = {{1, 2, 1, 2}, {2, 2, 1, 1}}, y[] = {{1, 2, 3}, {1, 2, 3}};
  const double first = probability_of_improvement(x[0], y[0], Better::higher).probability;
  const double second = probability_of_improvement(x[1], y[1], Better::higher).probability;
  EXPECT_NEAR((first + second) / 2, 1.0 / 3, 1e-15);
}

// The example of scipy.stats.mannwhitneyu: ages at diagnosis of diabetes, U = 17 of 20 pairs.
TEST(ProbabilityOfImprovement, ReproducesTheDiabetesExample) {
  const std::vector<double> males = {19, 22, 16, 29, 24}, females = {20, 11, 17, 12};
  EXPECT_EQ(probability_of_improvement(males, females, Better::higher).probability, 17.0 / 20);
  EXPECT_NEAR(probability_of_improvement(males, females, Better::lower).probability, 3.0 / 20, 1e-15);
}

TEST(ProbabilityOfImprovement, DoubtsEvenACleanSeparation) {
  const std::vector<double> low = {1, 2, 3, 4, 5}, high = {6, 7, 8, 9, 10};
  const Improvement sure = probability_of_improvement(high, low, Better::higher);
  EXPECT_EQ(sure.probability, 1);
  EXPECT_NEAR(sure.ci95->high, 1, 1e-15);
  EXPECT_LT(sure.ci95->low, 0.8);
  EXPECT_GT(sure.ci95->low, 0.5);
  const Improvement none = probability_of_improvement(low, low, Better::higher);
  EXPECT_EQ(none.probability, 0.5);
  EXPECT_NEAR(none.ci95->low + none.ci95->high, 1, 1e-12) << "symmetrical";
  EXPECT_TRUE(std::isnan(probability_of_improvement({}, low, Better::higher).probability));
  EXPECT_FALSE(
      probability_of_improvement(std::vector<double>{1}, std::vector<double>{2}, Better::higher).ci95);
}

TEST(ProbabilityOfImprovement, DividesCountsOnce) {
  const std::vector<double> first = {1, 2, 3}, second = {0.5, 1.5, 2.5, 3.5};
  EXPECT_EQ(probability_of_improvement(first, second, Better::higher).probability, 6.0 / 12);
  const std::vector<double> costs = {1, 2, 4};
  EXPECT_EQ(probability_of_improvement(costs, second, Better::higher).probability, 7.0 / 12);
  EXPECT_EQ(probability_of_improvement(costs, second, Better::lower).probability, 5.0 / 12);
}

}  // namespace
}  // namespace coppice
