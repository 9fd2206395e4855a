#include <gtest/gtest.h>

#include "tests/support/make.h"
#include "tests/support/search.h"

namespace coppice {
namespace {

SearchTask segment(std::int64_t budget, bool noisy, std::uint64_t seed) {
  SearchTask task;
  task.box = {{"a", "", 0, 1}};
  task.guess = {0.9};
  task.budget = budget;
  task.noisy = noisy;
  task.draws = Draws(seed, "test", 0);
  return task;
}

// An unsampled cell's bound is infinite: after the root's sample both halves are sampled before any quarter.
TEST(Hoo, SamplesEveryCellBeforeItsParts) {
  const SearchTask task = segment(3, true, 1);
  const auto search = make_from_xml<Optimizer>("<hoo/>")->start(task);
  const SearchRecord record =
      run_search(*search, task, 1, [](std::span<const double> x, std::uint64_t) { return x[0]; });
  ASSERT_EQ(record.points.size(), 3u);
  EXPECT_EQ(record.points[0], task.guess);
  EXPECT_NE(record.points[1][0] < 0.5, record.points[2][0] < 0.5);
  EXPECT_EQ(search->measures()[0], 3) << "cells";
}

// f(x) = 1 - (x - 0.3)^2 / 0.49 plus noise of deviation 0.2: means over 20 seeds.
TEST(Hoo, ComesNearTheOptimumOfANoisyFunctionAndNearerWithMoreSamples) {
  double regret[2] = {0, 0};
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (const int size : {0, 1}) {
      const SearchTask task = segment(size == 0 ? 100 : 4000, true, seed);
      const auto search = make_from_xml<Optimizer>("<hoo/>")->start(task);
      run_search(*search, task, 1, [&](std::span<const double> x, std::uint64_t scenario) {
        const double noise = Draws(seed, "noise", 1).scenario(scenario).normal("noise", 0, 0.2);
        return 1 - (x[0] - 0.3) * (x[0] - 0.3) / 0.49 + noise;
      });
      const double error = search->best()[0] - 0.3;
      regret[size] += error * error / 0.49 / 20;
    }
  }
  EXPECT_LT(regret[0], 0.05);
  EXPECT_LT(regret[1], 0.005);
}

}  // namespace
}  // namespace coppice
