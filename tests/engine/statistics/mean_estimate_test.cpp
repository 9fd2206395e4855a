#include "engine/statistics/mean_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/statistics/comparisons.h"
#include "engine/statistics/estimates.h"

namespace coppice {
namespace {

using Values = std::vector<double>;

/// Student's test alone, without the skewness.
MeanEstimate without_skewness(MeanEstimate estimate) {
  estimate.third = 0;
  return estimate;
}

// Student's sleep data (Biometrika 6, 1908), extra hours under two drugs, the example of R's t.test:
// Welch t = -1.8608, df = 17.776, p = 0.07939, interval -3.3654832 to 0.2054832;
// paired t = -4.0621, df = 9, p = 0.002833, interval -2.4598858 to -0.7001142.
const Values kFirstDrug = {0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
const Values kSecondDrug = {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};

TEST(Difference, IsWelchsTest) {
  const MeanEstimate d = without_skewness(difference(mean_estimate(kFirstDrug), mean_estimate(kSecondDrug)));
  EXPECT_NEAR(d.mean / std::sqrt(d.variance), -1.8608, 5e-5);
  EXPECT_NEAR(d.degrees, 17.776, 5e-4);
  EXPECT_NEAR(p_value(d), 0.07939, 5e-6);
  EXPECT_NEAR(confidence_interval(d)->low, -3.3654832, 5e-8);
  EXPECT_NEAR(confidence_interval(d)->high, 0.2054832, 5e-8);
}

TEST(Difference, OfPairsIsTheTestOfTheirDifferences) {
  const MeanEstimate d = without_skewness(mean_estimate(paired_differences(kFirstDrug, kSecondDrug)));
  EXPECT_NEAR(d.mean / std::sqrt(d.variance), -4.0621, 5e-5);
  EXPECT_NEAR(p_value(d), 0.002833, 5e-7);
  EXPECT_NEAR(confidence_interval(d)->low, -2.4598858, 5e-8);
  EXPECT_NEAR(confidence_interval(d)->high, -0.7001142, 5e-8);
}

TEST(ConfidenceInterval, FollowsTheTail) {
  Values values;  // the quantiles of an exponential distribution
  for (int i = 0; i < 40; ++i) values.push_back(-std::log(1 - (i + 0.5) / 40));
  const MeanEstimate skewed = mean_estimate(values);
  const Interval student = *confidence_interval(without_skewness(skewed));
  const Interval interval = *confidence_interval(skewed);
  EXPECT_EQ(interval.low, student.low) << "never narrower than Student's";
  EXPECT_GT(interval.high, student.high + 0.05);
  for (double& value : values) value = -value;
  const Interval mirrored = *confidence_interval(mean_estimate(values));
  EXPECT_NEAR(mirrored.low, -interval.high, 1e-12);
  EXPECT_NEAR(mirrored.high, -interval.low, 1e-12);
}

TEST(ConfidenceInterval, IsStudentsBelowTenValues) {
  const Values values = {0, 0, 0, 1, 9};
  EXPECT_EQ(confidence_interval(mean_estimate(values))->high, t_interval(values)->high);
}

TEST(PValue, IsWhereTheIntervalMeetsZero) {
  Values values;
  for (int i = 0; i < 30; ++i) values.push_back(std::exp(0.1 * i - 1.5));
  for (const double shift : {0.1, 1.0, 2.0, 2.8, 3.5, 5.0}) {
    MeanEstimate estimate = mean_estimate(values);
    estimate.mean -= shift;
    const double p = p_value(estimate);
    if (p < 1e-6) continue;
    const Interval interval = *confidence_interval(estimate, 1 - p);
    EXPECT_NEAR(std::fmin(std::fabs(interval.low), std::fabs(interval.high)), 0, 1e-9) << shift;
  }
}

TEST(MeanEstimate, OfNothingOrOneValueHasNoInterval) {
  for (const Values& values : {Values{}, Values{2}}) {
    EXPECT_FALSE(confidence_interval(mean_estimate(values)));
    EXPECT_TRUE(std::isnan(p_value(mean_estimate(values))));
  }
  EXPECT_FALSE(confidence_interval(difference(mean_estimate(Values{1}), mean_estimate(kFirstDrug))));
}

TEST(MeanEstimate, SaysNothingBeyondTheRangeOfNumbers) {
  const Values large = {0, 1e160, 0, 0, 0, 0, 0, 1e160, 0, 0, 0, 0};
  EXPECT_FALSE(confidence_interval(mean_estimate(large))) << "the variance is no double";
  EXPECT_TRUE(std::isnan(p_value(mean_estimate(large))));
  const MeanEstimate unknown = mean_estimate(Moments{12, 1, std::nan(""), 0});
  EXPECT_FALSE(confidence_interval(unknown));
  EXPECT_TRUE(std::isnan(p_value(unknown)));
}

TEST(MeanEstimate, OfEqualValuesIsCertain) {
  const MeanEstimate same = mean_estimate(Values(20, 3.0));
  EXPECT_EQ(confidence_interval(same)->low, 3);
  EXPECT_EQ(confidence_interval(same)->high, 3);
  EXPECT_EQ(p_value(same), 0);
  EXPECT_TRUE(std::isnan(p_value(difference(same, same))));
}

}  // namespace
}  // namespace coppice
