#include "engine/statistics/profiles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace coppice {
namespace {

using Values = std::vector<double>;

// Agarwal et al.'s test data (rliable, tests/rliable/metrics_test.py), all runs and tasks together; the
// shares are those of its definition, the mean of score > threshold.
const Values kScores = {1, 2, 2, 2, 1, 1, 2, 1};

TEST(PerformanceProfile, IsTheShareOfRunsAboveAThreshold) {
  const auto profile = performance_profile(kScores, Values{0, 0.5, 1, 1.5, 2, 3}, Better::higher);
  const double expected[] = {1, 1, 0.5, 0.5, 0, 0};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(profile[i].share, expected[i]) << profile[i].threshold;
    EXPECT_LE(profile[i].ci95.low, expected[i]);
    EXPECT_GE(profile[i].ci95.high, expected[i]);
  }
  EXPECT_NEAR(profile[2].ci95.low, 0.2152, 5e-5) << "Wilson's interval for 4 of 8";
}

TEST(PerformanceProfile, OfCostsCountsWhatIsBelow) {
  EXPECT_EQ(performance_profile(Values{1, 2, 3, 4}, Values{2.5}, Better::lower)[0].share, 0.5);
  EXPECT_THROW(performance_profile({}, Values{1}, Better::lower), std::logic_error);
}

// Agarwal et al.: gamma minus the mean of min(score, gamma).
TEST(OptimalityGap, CountsWhatIsMissingOnly) {
  EXPECT_EQ(optimality_gap(kScores, 2, Better::higher), 2 - 1.5);
  EXPECT_EQ(optimality_gap(kScores, 1, Better::higher), 0);
  EXPECT_DOUBLE_EQ(optimality_gap(Values{9, 11, 14}, 10, Better::lower), (0 + 1 + 4) / 3.0);
  EXPECT_TRUE(std::isnan(optimality_gap({}, 1, Better::higher)));
}

TEST(OptimalityGap, IsUnknownOfAnUnknownValue) {
  EXPECT_TRUE(std::isnan(optimality_gap(Values{1, std::nan("")}, 0, Better::lower)));
}

}  // namespace
}  // namespace coppice
