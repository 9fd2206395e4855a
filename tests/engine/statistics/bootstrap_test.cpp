#include "engine/statistics/bootstrap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace coppice {
namespace {

using Values = std::vector<double>;

const Values kValues = {3.1, 4.7, 2.2, 8.9, 5.5, 4.1, 6.3, 2.8, 7.7, 5.0, 3.9, 4.4};

TEST(BootstrapInterval, IsDecidedByItsDraws) {
  const Draws draws(1, "bootstrap", 0);
  const Interval a = *bootstrap_interval(kValues, studentized_mean, draws);
  const Interval b = *bootstrap_interval(kValues, studentized_mean, draws);
  const Interval c = *bootstrap_interval(kValues, studentized_mean, Draws(2, "bootstrap", 0));
  EXPECT_EQ(a.low, b.low);
  EXPECT_EQ(a.high, b.high);
  EXPECT_NE(a.low, c.low);
  EXPECT_NEAR(a.low, c.low, 0.2) << "and little by them";
}

TEST(BootstrapInterval, MovesAndScalesWithTheValues) {
  const Draws draws(1, "bootstrap", 0);
  const Interval plain = *bootstrap_interval(kValues, studentized_iqm, draws);
  Values moved = kValues;
  for (double& value : moved) value = 100 + 2 * value;
  const Interval other = *bootstrap_interval(moved, studentized_iqm, draws);
  EXPECT_NEAR(other.low, 100 + 2 * plain.low, 1e-9);
  EXPECT_NEAR(other.high, 100 + 2 * plain.high, 1e-9);
}

TEST(BootstrapInterval, DependsOnTheUnit) {
  // Runs whose episodes hardly vary: by episode the interval looks far too narrow.
  std::vector<Values> runs;
  for (int run = 0; run < 12; ++run) {
    runs.emplace_back();
    for (int episode = 0; episode < 30; ++episode) runs.back().push_back(run + 0.01 * (episode % 7));
  }
  const Draws draws(1, "bootstrap", 0);
  const Interval by_run = *bootstrap_interval(runs, Unit::training_run, studentized_mean, draws);
  const Interval by_episode = *bootstrap_interval(runs, Unit::episode, studentized_mean, draws);
  EXPECT_GT(by_run.high - by_run.low, 3 * (by_episode.high - by_episode.low));
}

TEST(BootstrapInterval, KnowsItsLimits) {
  const Draws draws(1, "bootstrap", 0);
  EXPECT_FALSE(bootstrap_interval(Values{1, 2, 3, 4, 5, 6, 7, 8, 9}, studentized_mean, draws));
  Values one_differs(12, 3.0);
  one_differs.back() = 4;
  EXPECT_FALSE(bootstrap_interval(one_differs, studentized_mean, draws)) << "many resamples do not vary";
  EXPECT_FALSE(bootstrap_interval({Values(100, 1.0)}, Unit::training_run, studentized_mean, draws));
  const Interval same = *bootstrap_interval(Values(20, 3.0), studentized_iqm, draws);
  EXPECT_EQ(same.low, 3);
  EXPECT_EQ(same.high, 3);
}

}  // namespace
}  // namespace coppice
