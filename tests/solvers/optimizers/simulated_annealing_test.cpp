#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/make.h"
#include "tests/support/search.h"

namespace coppice {
namespace {

SearchTask cooling_task(std::int64_t budget, bool noisy) {
  SearchTask task;
  task.box = {{"a", "", 0, 10}, {"b", "", -1, 1}};
  task.guess = {5, 0.5};
  task.budget = budget;
  task.noisy = noisy;
  task.draws = Draws(3, "test", 0);
  return task;
}

// Eq. A.1: T = 2 (10 - k) / 10. Eq. A.2: each coordinate of the point in memory plus amplitude * (10 - k) /
// 10 times a uniform number of [-1, 1], then moved into the box. Accepted with probability exp(-loss / T).
TEST(SimulatedAnnealing, EachStepIsTheOneComputedByHand) {
  const auto optimizer = make_from_xml<Optimizer>(R"(<simulated_annealing temperature="2"/>)");
  const SearchTask task = cooling_task(10, false);
  const auto search = optimizer->start(task);
  const double values[] = {-4, -3, -5, -4.5, -9, -2.5, -2.6, -2.7, -2.4, -8};
  std::vector<double> memory = task.guess;
  double memory_value = 0;
  int worse_accepted = 0, refused = 0;
  for (int k = 0; k < 10; ++k) {
    const double share = (10.0 - k) / 10;
    EXPECT_NEAR(search->measures()[0], 2 * share, 1e-15);
    const Draws draws = task.draws.scenario(static_cast<std::uint64_t>(k));
    std::vector<double> expected = memory;
    if (k > 0) {
      expected[0] = std::clamp(memory[0] + 10 * share * draws.uniform("neighbour", -1, 1, 0), 0.0, 10.0);
      expected[1] = std::clamp(memory[1] + 2 * share * draws.uniform("neighbour", -1, 1, 1), -1.0, 1.0);
    }
    const Candidates candidates = search->ask(100);
    ASSERT_EQ(candidates.points.rows(), 1u);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(candidates.points(0, i), expected[i], 1e-12) << k;
    search->tell({&values[k], 1});
    const bool better = k == 0 || values[k] >= memory_value;
    if (better || draws.uniform("accept", 0, 1) < std::exp((values[k] - memory_value) / (2 * share))) {
      worse_accepted += better ? 0 : 1;
      memory = expected;
      memory_value = values[k];
    } else {
      ++refused;
    }
  }
  EXPECT_GT(worse_accepted, 0);
  EXPECT_GT(refused, 0);
  EXPECT_EQ(search->best_value(), -2.4) << "the best, not the last";
  EXPECT_EQ(search->stop_reason(), "budget");
}

TEST(SimulatedAnnealing, FindsItsTemperatureFromTheFirstValues) {
  const auto optimizer = make_from_xml<Optimizer>("<simulated_annealing/>");
  const auto search = optimizer->start(cooling_task(40, false));  // a twentieth: 2 values
  for (const double value : {1.0, 3.0}) {
    search->ask(1);
    EXPECT_EQ(search->measures()[0], 0);
    search->tell({&value, 1});
  }
  EXPECT_NEAR(search->measures()[0], 0.01 * std::sqrt(2.0) * 38 / 40, 1e-15);
}

TEST(SimulatedAnnealing, EvaluatesBothPointsOnTheSameScenarioUnderNoise) {
  const auto optimizer = make_from_xml<Optimizer>("<simulated_annealing/>");
  const SearchTask task = cooling_task(101, true);
  const auto search = optimizer->start(task);
  const SearchRecord record =
      run_search(*search, task, 1, [](std::span<const double> x, std::uint64_t scenario) {
        return -x[0] * x[0] + 50 * static_cast<double>(scenario % 3);  // what all share does not mislead
      });
  EXPECT_EQ(record.values.size(), 101u);
  for (std::size_t k = 1; k < 45; ++k) {
    EXPECT_EQ(record.scenarios[2 * k - 1], k);
    EXPECT_EQ(record.scenarios[2 * k], k);
  }
  EXPECT_LT(search->best()[0], 0.5);
}

}  // namespace
}  // namespace coppice
