#include "engine/statistics/running_times.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace coppice {
namespace {

TEST(RunningTimes, ChargeSuccessesWithTheEvaluationsOfFailures) {
  const std::vector<SearchRun> runs = {{100, true}, {300, false}, {200, true}};
  EXPECT_EQ(expected_running_time(runs), 300);  // 600 evaluations, 2 successes
  EXPECT_EQ(expected_running_time(std::vector<SearchRun>{{70, true}}), 70);
  EXPECT_TRUE(std::isinf(expected_running_time(std::vector<SearchRun>{{70, false}, {80, false}})));
}

TEST(RunningTimes, HaveNoIntervalWhereNothingIsKnown) {
  const Draws draws(1, "", 0);
  EXPECT_FALSE(running_time_interval(std::vector<SearchRun>(9, {70, true}), draws));
  EXPECT_FALSE(running_time_interval(std::vector<SearchRun>(20, {70, false}), draws));
  const auto sure = running_time_interval(std::vector<SearchRun>(10, {70, true}), draws);
  ASSERT_TRUE(sure);
  EXPECT_EQ(sure->low, 70);
  EXPECT_EQ(sure->high, 70);
  std::vector<SearchRun> rare(12, {100, false});
  rare[0].reached = true;  // (11/12)^12 = 35 % of the resamples have no success
  EXPECT_TRUE(std::isinf(running_time_interval(rare, draws)->high));
}

/// Successes after 50 to 150 evaluations with probability 0.4, failures after 200: the true expected running
/// time is 100 + 0.6 / 0.4 * 200 = 400.
TEST(RunningTimes, HaveIntervalsThatCoverTheTruth) {
  constexpr int kSamples = 400;
  int covered = 0;
  for (int sample = 0; sample < kSamples; ++sample) {
    Stream stream = Draws(static_cast<std::uint64_t>(sample), "", 0).stream("runs");
    std::vector<SearchRun> runs;
    for (int r = 0; r < 51; ++r) {
      const bool reached = stream.uniform() < 0.4;
      runs.push_back({reached ? stream.uniform(50, 150) : 200, reached});
    }
    const auto interval = running_time_interval(runs, Draws(7, "", 0), 0.95, 399);
    if (interval && interval->low <= 400 && 400 <= interval->high) ++covered;
  }
  // At least 0.92 of the nominal 0.95 less three standard errors, and not so wide that it says nothing.
  EXPECT_GE(covered, 0.92 * kSamples - 3 * std::sqrt(0.92 * 0.08 * kSamples));
  EXPECT_LE(covered, 0.99 * kSamples);
}

// The ranks are from binomial distribution functions: P(Bin(11, 1/2) <= 8) = 0.967, P(Bin(51, 1/2) <= 31) =
// 0.954.
TEST(RunningTimes, BoundMediansByOrderStatistics) {
  const auto bound = [](std::size_t n) {
    std::vector<double> values(n);
    std::iota(values.rbegin(), values.rend(), 1);
    return median_upper_bound(values);
  };
  EXPECT_FALSE(bound(4)) << "their largest is below the median with probability 1/16";
  EXPECT_EQ(bound(5), 5);
  EXPECT_EQ(bound(11), 9);
  EXPECT_EQ(bound(15), 12);
  EXPECT_EQ(bound(51), 32);
}

}  // namespace
}  // namespace coppice
