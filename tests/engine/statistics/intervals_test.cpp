#include "engine/statistics/intervals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "engine/vocabulary/random.h"

namespace coppice {
namespace {

// From 30-digit arithmetic; the first three digits are those of every printed table.
TEST(StudentTQuantile, AgreesWithTables) {
  struct Row {
    double p, degrees, t;
  };
  const Row rows[] = {
      {0.975, 1, 12.706204736174705},    {0.975, 2, 4.3026527297494639},    {0.975, 4, 2.7764451051977944},
      {0.975, 5, 2.5705818356363155},    {0.975, 9, 2.2621571627982055},    {0.975, 10, 2.2281388519862747},
      {0.975, 19, 2.0930240544083098},   {0.975, 30, 2.0422724563012383},   {0.975, 100, 1.9839715185235523},
      {0.975, 1000, 1.9623390808264085}, {0.975, 9999, 1.9602012636213577}, {0.995, 4, 4.6040948713499932},
      {0.9, 3, 1.6377443536962101},      {0.975, 7.3, 2.3450667365477036},  {0.999, 2.5, 13.822193110865965}};
  for (const Row& row : rows) {
    EXPECT_NEAR(student_t_quantile(row.p, row.degrees) / row.t, 1, 1e-12) << row.p << " " << row.degrees;
  }
}

TEST(StudentTQuantile, AgreesWithTheClosedFormsForOneAndTwoDegrees) {
  for (double p = 0.501; p < 1; p += 0.017) {
    EXPECT_NEAR(student_t_quantile(p, 1) / std::tan(std::numbers::pi * (p - 0.5)), 1, 1e-12) << p;
    EXPECT_NEAR(student_t_quantile(p, 2) / ((2 * p - 1) / std::sqrt(2 * p * (1 - p))), 1, 1e-12) << p;
  }
}

TEST(StudentTQuantile, IsSymmetricAndGrowsWithP) {
  EXPECT_EQ(student_t_quantile(0.5, 7), 0);
  double last = -1e300;
  for (double p = 0.01; p < 1; p += 0.01) {
    const double t = student_t_quantile(p, 3.5);
    EXPECT_GT(t, last);
    EXPECT_NEAR(student_t_quantile(1 - p, 3.5), -t, 1e-12 * std::fabs(t) + 1e-14);
    last = t;
  }
}

TEST(StudentTQuantile, RefusesWhatIsOutOfRange) {
  EXPECT_THROW(student_t_quantile(0, 3), std::logic_error);
  EXPECT_THROW(student_t_quantile(1, 3), std::logic_error);
  EXPECT_THROW(student_t_quantile(0.9, 0.5), std::logic_error);
}

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

}  // namespace
}  // namespace coppice
