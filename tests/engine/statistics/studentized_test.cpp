#include "engine/statistics/studentized.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/statistics/estimates.h"

namespace coppice {
namespace {

using Values = std::vector<double>;

// The self-awareness times of Wilcox (Introduction to Robust Estimation and Hypothesis Testing, 2012, 3.3.2).
const Values kTimes = {77,  87,  88,  114, 151, 210, 219, 246,  253, 262,
                       296, 299, 306, 376, 428, 515, 666, 1310, 2611};

TEST(StudentizedIqm, HasTheErrorOfATrimmedMean) {
  const Studentized iqm = studentized_iqm(kTimes);
  // 4 of 19 are cut at each end; 11 are kept, from 151 to 428.
  EXPECT_NEAR(iqm.value, (151 + 210 + 219 + 246 + 253 + 262 + 296 + 299 + 306 + 376 + 428) / 11.0, 1e-12);
  Values winsorized(4, 151);
  winsorized.insert(winsorized.end(), kTimes.begin() + 4, kTimes.begin() + 15);
  winsorized.insert(winsorized.end(), 4, 428);
  const double sd = standard_deviation(winsorized);
  EXPECT_NEAR(iqm.error, sd * std::sqrt(18.0 / (11 * 10)), 1e-12);
  EXPECT_EQ(iqm.degrees, 10);
}

TEST(IqmInterval, IsStudentsWithTheKeptValues) {
  const Studentized iqm = studentized_iqm(kTimes);
  const Interval interval = *iqm_interval(kTimes);
  const double half = 2.228138851965 * iqm.error;  // t(0.975, 10)
  EXPECT_NEAR(interval.low, iqm.value - half, 1e-9);
  EXPECT_NEAR(interval.high, iqm.value + half, 1e-9);
  const Interval narrower = *iqm_interval(kTimes, 0.5);
  EXPECT_NEAR(narrower.high - iqm.value, 0.699812061312 * iqm.error, 1e-9);
}

// Of 1 to 8 the values 3 to 6 are kept; winsorized 3, 3, 3, 4, 5, 6, 6, 6: sum of squares about 4.5 is 14.
TEST(IqmInterval, OfEightValuesByHand) {
  const Interval interval = *iqm_interval(Values{8, 1, 7, 2, 6, 3, 5, 4});
  const double half = 3.182446305284 * std::sqrt(14.0 / (4 * 3));  // t(0.975, 3)
  EXPECT_NEAR(interval.low, 4.5 - half, 1e-9);
  EXPECT_NEAR(interval.high, 4.5 + half, 1e-9);
}

TEST(IqmInterval, KnowsItsLimits) {
  EXPECT_FALSE(iqm_interval(Values{1, 2, 3, 4})) << "two would be kept";
  EXPECT_TRUE(iqm_interval(Values{1, 2, 3, 4, 5}));
  Values few_differ(12, 3.0);
  few_differ.back() = 4;
  EXPECT_FALSE(iqm_interval(few_differ)) << "what is kept does not vary, but values do";
  const Interval same = *iqm_interval(Values(20, 3.0));
  EXPECT_EQ(same.low, 3);
  EXPECT_EQ(same.high, 3);
}

}  // namespace
}  // namespace coppice
