#include "engine/statistics/shares.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace coppice {
namespace {

using Values = std::vector<double>;

ShareDifference of_counts(double a, double n, double b, double m) {
  return {{a / n, n}, {b / m, m}};
}

TEST(ShareDifference, HasTheIntervalsOfNewcombesExamples) {
  // Statistics in Medicine 17 (1998) 873-890, table II, method 10.
  struct Example {
    double a, n, b, m, low, high;
  };
  for (const Example& e : {Example{56, 70, 48, 80, 0.0524, 0.3339}, Example{9, 10, 3, 10, 0.1705, 0.8090},
                           Example{5, 56, 0, 29, -0.0381, 0.1926}, Example{0, 10, 0, 20, -0.1611, 0.2775},
                           Example{10, 10, 0, 10, 0.6075, 1.0}}) {
    const Interval interval = *of_counts(e.a, e.n, e.b, e.m).interval();
    EXPECT_NEAR(interval.low, e.low, 5e-5) << e.a;
    EXPECT_NEAR(interval.high, e.high, 5e-5) << e.a;
  }
}

/// Cases of which so many are 1 in both, in the first only, in the second only, in neither.
std::pair<Values, Values> pairs(int both, int first, int second, int neither) {
  std::pair<Values, Values> values;
  const auto add = [&](int n, double a, double b) {
    values.first.insert(values.first.end(), static_cast<std::size_t>(n), a);
    values.second.insert(values.second.end(), static_cast<std::size_t>(n), b);
  };
  add(both, 1, 1);
  add(first, 1, 0);
  add(second, 0, 1);
  add(neither, 0, 0);
  return values;
}

TEST(ShareDifference, OfPairedCasesHasTheIntervalOfNewcombesExample) {
  // Statistics in Medicine 17 (1998) 2635-2650, method 10.
  const auto [a, b] = pairs(36, 12, 2, 0);
  ShareDifference difference = of_counts(48, 50, 38, 50);
  difference.correlation = case_correlation(a, b);
  EXPECT_NEAR(difference.interval()->low, 0.0569, 5e-5);
  EXPECT_NEAR(difference.interval()->high, 0.3404, 5e-5);
}

TEST(ShareDifference, KeepsDoubtWhereNoPairDiffers) {
  for (const int ones : {0, 1, 10, 20}) {
    const auto [a, b] = pairs(ones, 0, 0, 20 - ones);
    ShareDifference difference = of_counts(ones, 20, ones, 20);
    difference.correlation = case_correlation(a, b);
    EXPECT_LT(difference.interval()->low, -0.05) << ones;
    EXPECT_GT(difference.interval()->high, 0.05) << ones;
    EXPECT_EQ(difference.p_value(), 1) << ones;
  }
}

TEST(ShareDifference, HasThePValueAtWhichItsIntervalBegins) {
  const ShareDifference difference = of_counts(56, 70, 48, 80);
  const double p = difference.p_value();
  EXPECT_NEAR(difference.interval(1 - p)->low, 0, 1e-9);
  EXPECT_NEAR(p, 0.0081, 0.001) << "the chi-squared test without correction has 0.0082";
  const ShareDifference all = of_counts(0, 20, 20, 20);
  EXPECT_EQ(all.value(), -1);
  EXPECT_NEAR(all.interval()->high, -0.7721, 5e-5);
  EXPECT_GT(all.p_value(), 0);
  EXPECT_LT(all.p_value(), 1e-6);
  EXPECT_TRUE(std::isnan((ShareDifference{{0.5, 0}, {0.5, 10}}.p_value())));
}

TEST(MeanShare, CountsEveryRunOnceWhereTheirSharesAreFarApart) {
  const ShareEstimate apart = mean_share(Values{0, 1, 1, 0, 1, 0}, 100);
  EXPECT_EQ(apart.share, 0.5);
  EXPECT_EQ(apart.cases, 6);
  EXPECT_EQ(apart.degrees, 5);
}

TEST(MeanShare, CountsEveryEpisodeWhereRunsDifferByChanceOnly) {
  EXPECT_EQ(mean_share(Values{0.5, 0.5, 0.5}, 100).cases, 300);
  EXPECT_TRUE(std::isinf(mean_share(Values{0.5, 0.5, 0.5}, 100).degrees)) << "nothing is estimated then";
  // Deviation 0.1 about 0.5: 0.25 / 0.01 cases a run.
  EXPECT_NEAR(mean_share(Values{0.4, 0.5, 0.6}, 100).cases, 3 * 0.25 / 0.01, 1e-9);
}

TEST(MeanShare, OfOneSideShowsNothingOfHowRunsDiffer) {
  const ShareEstimate all = mean_share(Values(20, 1.0), 1000);
  EXPECT_EQ(all.cases, 20);
  const double z2 = 1.959963984540 * 1.959963984540;
  EXPECT_NEAR(score_interval(all)->low, 20 / (20 + z2), 1e-9) << "Wilson's interval for 20 of 20";
  EXPECT_EQ(score_interval(all)->high, 1);
  EXPECT_FALSE(score_interval(mean_share(Values{1}, 1000))) << "one run says nothing of others";
}

TEST(ScoreInterval, OfEstimatedCasesIsWiderByStudentsQuantile) {
  const ShareEstimate known{0.3, 40}, estimated{0.3, 40, 4};
  EXPECT_LT(score_interval(estimated)->low, score_interval(known)->low);
  EXPECT_GT(score_interval(estimated)->high, score_interval(known)->high);
  EXPECT_GE(score_interval(estimated)->low, 0);
}

}  // namespace
}  // namespace coppice
