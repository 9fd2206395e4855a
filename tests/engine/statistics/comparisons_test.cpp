#include "engine/statistics/comparisons.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace coppice
