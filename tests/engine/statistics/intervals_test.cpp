#include "engine/statistics/intervals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/vocabulary/random.h"

namespace coppice {
namespace {

// Student's own first example (The Probable Error of a Mean, 1908): ten differences in hours of sleep,
// mean 1.58 and (n - 1) standard deviation 1.230; 2.262 * 1.230 / sqrt(10) = 0.880.
TEST(TInterval, OfStudentsSleepData) {
  const std::vector<double> hours = {1.2, 2.4, 1.3, 1.3, 0.0, 1.0, 1.8, 0.8, 4.6, 1.4};
  const Interval interval = *t_interval(hours);
  EXPECT_NEAR(interval.low, 0.700, 5e-4);
  EXPECT_NEAR(interval.high, 2.460, 5e-4);
}

TEST(TInterval, NeedsTwoValues) {
  EXPECT_FALSE(t_interval({}).has_value());
  EXPECT_FALSE(t_interval(std::vector<double>{3.0}).has_value());
  const Interval equal = *t_interval(std::vector<double>{3.0, 3.0});
  EXPECT_EQ(equal.low, 3);
  EXPECT_EQ(equal.high, 3);
}

TEST(TInterval, GrowsWithConfidence) {
  const std::vector<double> values = {1, 2, 3, 4};
  EXPECT_LT(t_interval(values, 0.99)->low, t_interval(values, 0.9)->low);
}

// 20000 intervals: the standard error of the share is 0.15 %.
TEST(TInterval, CoversTheMeanAsOftenAsItSays) {
  for (std::size_t n : {2u, 3u, 10u}) {
    int covered = 0;
    for (std::uint64_t trial = 0; trial < 20000; ++trial) {
      Stream stream = Draws(1, "coverage", n).stream("trial", trial);
      std::vector<double> values(n);
      for (double& value : values) value = 5 + 2 * stream.normal();
      const Interval interval = *t_interval(values);
      covered += interval.low <= 5 && 5 <= interval.high;
    }
    EXPECT_NEAR(covered / 20000.0, 0.95, 0.0062) << n;
  }
}

// Newcombe, Statistics in Medicine 17 (1998), Table I, method 3: 81 of 263, 15 of 148, 0 of 20, 1 of 29 (its
// lower limit there is Wilson's, 0.0061).
TEST(ShareInterval, AgreesWithNewcombesTable) {
  const struct {
    double count, n, low, high;
  } rows[] = {
      {81, 263, 0.2553, 0.3662}, {15, 148, 0.0624, 0.1605}, {0, 20, 0, 0.1611}, {1, 29, 0.0513 / 29, 0.1718}};
  for (const auto& row : rows) {
    const Interval interval = share_interval(row.count / row.n, row.n);
    EXPECT_NEAR(interval.low, row.low, 5e-5) << row.n;
    EXPECT_NEAR(interval.high, row.high, 5e-5) << row.n;
  }
}

// Half the 5 % quantiles of chi-squared with 2, 4 and 6 degrees of freedom: 0.0512933, 0.3553615, 0.8176914.
TEST(ShareInterval, OfFewCasesHasAPoissonLimit) {
  EXPECT_NEAR(share_interval(0.1, 10).low, 0.00512933, 1e-8);
  EXPECT_NEAR(share_interval(0.2, 10).low, 0.03553615, 1e-8);
  EXPECT_NEAR(share_interval(0.9, 10).high, 1 - 0.00512933, 1e-8);
  EXPECT_NEAR(share_interval(0.03, 100).low, 0.008176914, 1e-8);
  EXPECT_NEAR(share_interval(3.0 / 20, 20).low, 0.0524, 5e-5) << "Wilson's";
  EXPECT_NEAR(share_interval(0.15, 10).low, 0.0354, 5e-5) << "Wilson's: a tie counts half";
  EXPECT_GT(share_interval(1, 2).low, 0.3) << "two of two are not few";
}

TEST(ShareInterval, EndsExactlyAtNoneAndAll) {
  for (int n = 1; n <= 300; ++n) {
    EXPECT_EQ(share_interval(0, n).low, 0) << n;
    EXPECT_EQ(share_interval(1, n).high, 1) << n;
  }
}

}  // namespace
}  // namespace coppice
