#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/make.h"
#include "tests/support/search.h"

namespace coppice {
namespace {

SearchTask square(std::int64_t budget, bool noisy) {
  SearchTask task;
  task.box = {{"a", "", 0, 10}, {"b", "", -5, 5}};
  task.guess = {5, 0};
  task.budget = budget;
  task.noisy = noisy;
  task.draws = Draws(3, "test", 0);
  return task;
}

// With 2 elites of 4 samples, p and q, in units of the sides (10): mean (p + q) / 2, variances ((p - q) /
// 2)^2 / 100; smoothed: 0.6 * 0.3^2 + 0.4 of these, 0.3 being the first deviation. The measure is the root of
// their mean.
TEST(CrossEntropy, OneGenerationIsTheOneComputedByHand) {
  const auto optimizer = make_from_xml<Optimizer>(
      R"(<cross_entropy population="4" elite_share="0.5" smoothing="0.4" deviation="0.3" mean_smoothing="1"/>)");
  const auto search = optimizer->start(square(8, true));
  const Matrix points = search->ask(4).points;
  ASSERT_EQ(points.rows(), 4u);
  search->tell(std::vector<double>{-3, 7, -1, std::numeric_limits<double>::quiet_NaN()});
  const std::vector<double> mean = search->best();
  double variance = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(mean[i], (points(1, i) + points(2, i)) / 2, 1e-12);
    const double half = (points(1, i) - points(2, i)) / 2;
    variance += (0.6 * 0.09 + 0.4 * half * half / 100) / 2;
  }
  EXPECT_NEAR(search->measures()[0], std::sqrt(variance), 1e-12);
}

TEST(CrossEntropy, GenerationsMeetOneScenarioEachAndTheMeanIsReturnedUnderNoise) {
  const auto optimizer = make_from_xml<Optimizer>(R"(<cross_entropy population="10"/>)");
  const SearchTask task = square(100, true);
  const auto search = optimizer->start(task);
  const SearchRecord record = run_search(*search, task, 1000, [&](std::span<const double> x, std::uint64_t) {
    return -(x[0] - 7) * (x[0] - 7) - x[1] * x[1];
  });
  ASSERT_EQ(record.values.size(), 100u);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(record.scenarios[i], i / 10);
  EXPECT_EQ(std::count(record.points.begin(), record.points.end(), search->best()), 0);
  EXPECT_NEAR(search->best()[0], 7, 0.05);
  EXPECT_EQ(search->stop_reason(), "budget");
}

TEST(CrossEntropy, EndsByToleranceAndRefusesAnInfiniteSide) {
  const auto optimizer = make_from_xml<Optimizer>(R"(<cross_entropy tolerance="0.01"/>)");
  SearchTask task = square(100000, false);
  const auto search = optimizer->start(task);
  run_search(*search, task, 1000, [](std::span<const double> x, std::uint64_t) { return -x[0] * x[0]; });
  EXPECT_EQ(search->stop_reason(), "tolerance");
  task.box[1].high = std::numeric_limits<double>::infinity();
  EXPECT_THROW(optimizer->start(task), std::invalid_argument);
}

}  // namespace
}  // namespace coppice
