#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "engine/vocabulary/objective.h"
#include "solvers/optimizers/acquisition.h"
#include "solvers/optimizers/hedge.h"
#include "tests/support/make.h"
#include "tests/support/search.h"

namespace coppice {
namespace {

TEST(Acquisition, ExpectedImprovementIsTheIntegral) {
  const double mean = 0.3, deviation = 0.5, best = 0.8;
  double sum = 0;  // midpoint rule for E max(0, Y - best)
  const double step = 1e-4;
  for (double y = best + step / 2; y < mean + 10 * deviation; y += step) {
    const double z = (y - mean) / deviation;
    sum += step * (y - best) * std::exp(-0.5 * z * z) / (deviation * std::sqrt(2 * M_PI));
  }
  EXPECT_NEAR(std::exp(log_expected_improvement(mean, deviation, best).value), sum, 1e-7);
}

TEST(Acquisition, DerivativesMatchFiniteDifferencesNearAndFar) {
  for (const double best : {-1.0, 0.8, 4.0, 7.0, 20.0}) {
    for (const auto acquisition : {log_expected_improvement, log_improvement_probability}) {
      const double m = 0.3, s = 0.5, h = 1e-6;
      const Promise at = acquisition(m, s, best);
      const double by_mean =
          (acquisition(m + h, s, best).value - acquisition(m - h, s, best).value) / (2 * h);
      const double by_deviation =
          (acquisition(m, s + h, best).value - acquisition(m, s - h, best).value) / (2 * h);
      EXPECT_NEAR(at.by_mean / by_mean, 1, 2e-5) << best;
      EXPECT_NEAR(at.by_deviation / by_deviation, 1, 2e-5) << best;
    }
  }
}

TEST(Acquisition, SeriesJoinTheFormulas) {
  const double ei =
      log_expected_improvement(-12 + 1e-9, 1, 0).value - log_expected_improvement(-12 - 1e-9, 1, 0).value;
  const double pi = log_improvement_probability(-30 + 1e-9, 1, 0).value -
                    log_improvement_probability(-30 - 1e-9, 1, 0).value;
  EXPECT_NEAR(ei, 0, 1e-4);
  EXPECT_NEAR(pi, 0, 1e-4);
}

TEST(Hedge, DrawsArmsByTheirGains) {
  Hedge hedge(2);
  EXPECT_EQ(hedge.choose(0.49, 10), 0u);
  EXPECT_EQ(hedge.choose(0.51, 10), 1u);
  hedge.reward(1, 2);
  // eta = sqrt(8 ln 2 / 10) = 0.7447; arm 0 has 1 / (1 + e^1.489) = 0.184
  EXPECT_EQ(hedge.choose(0.183, 10), 0u);
  EXPECT_EQ(hedge.choose(0.185, 10), 1u);
}

/// Gap of the best point to the optimum.
double gap(const std::string& optimizer, const std::string& objective, std::int64_t budget, bool noisy) {
  const auto function = make_from_xml<Objective>(objective)->draw(Draws(1, "", 0));
  SearchTask task;
  task.box = function->box();
  task.budget = budget;
  task.noisy = noisy;
  task.draws = Draws(5, "bayesian", 0);
  const std::unique_ptr<Search> search = make_from_xml<Optimizer>(optimizer)->start(task);
  run_search(*search, task, 100, [&](std::span<const double> x, std::uint64_t scenario) {
    return function->evaluate(x, task.draws.scenario(scenario));
  });
  return *function->optimum() - *function->true_value(search->best());
}

TEST(Bayesian, FindsTheOptimumOfBraninByEveryAcquisition) {
  for (const char* name : {"portfolio", "expected_improvement", "upper_bound", "improvement_probability"}) {
    EXPECT_LT(gap(std::string("<bayesian acquisition='") + name + "'/>", "<branin/>", 60, false), 0.02)
        << name;
  }
}

TEST(Bayesian, ReturnsAPointOfLargeMeanUnderNoise) {
  EXPECT_LT(gap("<bayesian/>", "<branin noise='2'/>", 60, true), 1.5);
}

TEST(Bayesian, RefusesWhatItCannotSearch) {
  const auto optimizer = make_from_xml<Optimizer>("<bayesian/>");
  const auto start = [&](std::size_t axes, double high, std::int64_t budget) {
    SearchTask task;
    for (std::size_t i = 0; i < axes; ++i) task.box.push_back({"x" + std::to_string(i), "", 0, high});
    task.budget = budget;
    optimizer->start(task);
  };
  EXPECT_NO_THROW(start(20, 1, 1000));
  EXPECT_THROW(start(21, 1, 100), std::invalid_argument);
  EXPECT_THROW(start(2, std::numeric_limits<double>::infinity(), 100), std::invalid_argument);
  EXPECT_THROW(start(2, 1, 1001), std::invalid_argument);
}

}  // namespace
}  // namespace coppice
