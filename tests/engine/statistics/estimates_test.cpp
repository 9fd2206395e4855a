#include "engine/statistics/estimates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/vocabulary/random.h"

namespace coppice {
namespace {

using Values = std::vector<double>;

TEST(Mean, IsExactWhereASimpleSumIsNot) {
  EXPECT_EQ(mean(Values{1, 2, 6}), 3);
  EXPECT_EQ(mean(Values(1000, 0.1)), 0.1);
  EXPECT_EQ(mean(Values{1e16, 1, 1}), (1e16 + 2) / 3);
  EXPECT_TRUE(std::isnan(mean({})));
}

TEST(StandardDeviation, DividesByOneLessThanTheNumber) {
  EXPECT_DOUBLE_EQ(standard_deviation(Values{2, 4, 4, 4, 5, 5, 7, 9}), std::sqrt(32.0 / 7));
  EXPECT_EQ(standard_deviation(Values{1e9 + 1, 1e9 + 2, 1e9 + 3}), 1);
  EXPECT_TRUE(std::isnan(standard_deviation(Values{1})));
}

TEST(Quantile, InterpolatesBetweenOrderStatistics) {
  const Values values = {40, 10, 30, 20};
  EXPECT_EQ(quantile(values, 0), 10);
  EXPECT_EQ(quantile(values, 1), 40);
  EXPECT_EQ(quantile(values, 0.25), 17.5);  // numpy.quantile([10, 20, 30, 40], 0.25)
  EXPECT_EQ(median(values), 25);
  EXPECT_EQ(median(Values{3}), 3);
  EXPECT_TRUE(std::isnan(median({})));
  EXPECT_THROW(quantile(values, 1.5), std::logic_error);
}

TEST(InterquartileMean, LeavesAQuarterOutAtEachEnd) {
  EXPECT_EQ(interquartile_mean(Values{100, 1, 2, 3, 4, 5, 6, -100}), 3.5);
  EXPECT_EQ(interquartile_mean(Values{9, 1, 2, 3, 4}), 3);  // floor(5 / 4) = 1 at each end
  EXPECT_EQ(interquartile_mean(Values{1, 2, 6}), 3);
  EXPECT_TRUE(std::isnan(interquartile_mean({})));
}

TEST(Estimate, SummarizesUnits) {
  const Estimate costs = estimate(Values{1, 2, 3, 4, 10}, Better::lower);
  EXPECT_EQ(costs.units, 5u);
  EXPECT_EQ(costs.mean, 4);
  EXPECT_EQ(costs.median, 3);
  EXPECT_EQ(costs.iqm, 3);
  EXPECT_EQ(costs.best, 1);
  EXPECT_EQ(costs.worst, 10);
  EXPECT_NEAR(costs.sd, std::sqrt(12.5), 1e-15);
  EXPECT_NEAR(costs.ci95->low, 4 - 2.7764451051977987 * std::sqrt(12.5 / 5), 1e-12);
  EXPECT_EQ(estimate(Values{1, 2, 3}, Better::higher).best, 3);
}

TEST(Estimate, OneTrainingRunTellsNothingOfTheNextHoweverManyEpisodes) {
  const Estimate one = estimate({Values{1, 2, 3, 4}}, Unit::training_run, Better::higher);
  EXPECT_EQ(one.units, 1u);
  EXPECT_EQ(one.mean, 2.5);
  EXPECT_FALSE(one.ci95.has_value());
  EXPECT_TRUE(std::isnan(one.sd));
  EXPECT_TRUE(estimate({Values{1, 2, 3, 4}}, Unit::episode, Better::higher).ci95.has_value());
}

TEST(Estimate, TheUnitDecidesWhatIsAveraged) {
  const std::vector<Values> runs = {{0, 0, 0}, {6}};
  EXPECT_EQ(estimate(runs, Unit::training_run, Better::higher).mean, 3);
  EXPECT_EQ(estimate(runs, Unit::episode, Better::higher).mean, 1.5);
  EXPECT_EQ(estimate(runs, Unit::training_run, Better::higher).best, 6);
}

TEST(Estimate, OfNothingIsEmpty) {
  const Estimate none = estimate(Values(), Better::higher);
  EXPECT_EQ(none.units, 0u);
  EXPECT_TRUE(std::isnan(none.mean));
  EXPECT_FALSE(none.ci95.has_value());
}

// Runs differ (deviation 1), and episodes within a run (deviation 3): the interval over runs covers the mean
// of all runs as it should; the one over episodes, as if they were independent, does not.
TEST(Estimate, IntervalsOverTrainingRunsCoverNestedData) {
  int by_run = 0, by_episode = 0;
  for (std::uint64_t trial = 0; trial < 10000; ++trial) {
    Stream stream = Draws(1, "nested", 0).stream("trial", trial);
    std::vector<Values> runs(5, Values(20));
    for (Values& run : runs) {
      const double level = stream.normal();
      for (double& episode : run) episode = level + 3 * stream.normal();
    }
    const auto covers = [&](Unit unit) {
      const Interval interval = *estimate(runs, unit, Better::higher).ci95;
      return interval.low <= 0 && 0 <= interval.high;
    };
    by_run += covers(Unit::training_run);
    by_episode += covers(Unit::episode);
  }
  EXPECT_NEAR(by_run / 10000.0, 0.95, 0.0087);  // four standard errors
  EXPECT_LT(by_episode / 10000.0, 0.9);
}

TEST(Mean, OfHugeValuesIsOneOfThem) {
  const std::vector<double> huge = {1e308, 1e308, 1e308, 1e308};
  EXPECT_NEAR(mean(huge) / 1e308, 1, 1e-15);
  EXPECT_EQ(standard_deviation(huge), 0);
  const std::vector<double> half = {0, 1e308, 0, 1e308};
  EXPECT_NEAR(mean(half) / 5e307, 1, 1e-15);
  EXPECT_NEAR(standard_deviation(half) / 1e308, std::sqrt(1.0 / 3), 1e-15);
  EXPECT_EQ(mean(std::vector<double>{1.7e308, -1.7e308}), 0);
}

TEST(Estimate, HasNoWorstAndBestWhereNobodySaysWhatIsGood) {
  const Estimate unknown = estimate(std::vector<double>{1, 2}, std::nullopt);
  EXPECT_TRUE(std::isnan(unknown.worst));
  EXPECT_TRUE(std::isnan(unknown.best));
  EXPECT_EQ(unknown.mean, 1.5);
}

}  // namespace
}  // namespace coppice
