#include "solvers/optimizers/cma_es.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "solvers/optimizers/cma_es_box.h"
#include "solvers/optimizers/cma_es_distribution.h"
#include "solvers/optimizers/cma_es_rates.h"
#include "solvers/optimizers/cma_es_run.h"
#include "solvers/optimizers/lower_triangle.h"
#include "solvers/optimizers/rank_change_test.h"

namespace coppice {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(CmaRates, AreTheTutorialsForTenParametersAndFasterOfTheCovariance) {
  const CmaRates rates = cma_rates(10, default_population(10), true, false);
  EXPECT_EQ(rates.population, 10u);  // Table 1: 4 + floor(3 ln 10)
  // ln 5.5 - ln i = 1.704748, 1.011601, 0.606136, 0.318454, 0.095310; their sum 3.736249
  EXPECT_NEAR(rates.weights[0], 1.704748 / 3.736249, 1e-6);
  EXPECT_NEAR(rates.weights[4], 0.095310 / 3.736249, 1e-6);
  EXPECT_NEAR(rates.mu_eff, 3.167299, 1e-5);  // 3.736249^2 / 4.407395
  EXPECT_NEAR(rates.c_sigma, (3.167299 + 2) / (10 + 3.167299 + 5), 1e-6);
  EXPECT_NEAR(rates.c_1, 1.25 * 2 / (11.3 * 11.3 + 3.167299), 1e-7);
  EXPECT_NEAR(rates.c_mu, 1.25 * 2 * (0.25 + 3.167299 + 1 / 3.167299 - 2) / (144 + 3.167299), 1e-7);
  double negative = 0;
  for (const double w : rates.weights) negative += std::min(0.0, w);
  EXPECT_NEAR(negative, -(1 + rates.c_1 / rates.c_mu), 1e-9);  // the least of Eqs. 50 to 52
}

/// One generation in two dimensions by the formulas of the tutorial, with the symmetric root of a matrix that
/// is a multiple of the identity, written without any code under test.
TEST(CmaDistribution, UpdatesAsTheTutorialInOneGeneration) {
  CmaDistribution distribution({1, 2}, 0.5, false);
  CmaRates rates;
  rates.population = 4;
  rates.weights = {0.7, 0.3, -0.2, -0.4};
  rates.weight_sum = 0.4;
  rates.mu_eff = 1 / (0.49 + 0.09);
  rates.c_sigma = 0.4, rates.d_sigma = 1.2, rates.c_c = 0.5, rates.c_1 = 0.1, rates.c_mu = 0.2;
  rates.expected_length = 1.2542727;
  const std::vector<double> z = {1, 0, 0, 1, 1, 1, -1, 2};
  const std::vector<std::uint32_t> order = {2, 0, 1, 3};  // (1, 1), (1, 0), (0, 1), (-1, 2)
  ASSERT_TRUE(distribution.update(rates, z, order));

  // z_w = 0.7 (1, 1) + 0.3 (1, 0) = (1, 0.7); m = (1, 2) + 0.5 z_w
  EXPECT_NEAR(distribution.mean()[0], 1.5, 1e-15);
  EXPECT_NEAR(distribution.mean()[1], 2.35, 1e-15);
  // p_sigma = sqrt(0.4 * 1.6 / 0.58) (1, 0.7) = 1.0504515 (1, 0.7), |p_sigma| = 1.2822452;
  // sigma = 0.5 exp(0.4 / 1.2 (1.2822452 / 1.2542727 - 1))
  EXPECT_NEAR(distribution.sigma(), 0.5037308, 1e-6);
  // 1.2822452 / sqrt(1 - 0.36) = 1.6028 < (1.4 + 2/3) 1.2543: h_sigma = 1;
  // p_c = sqrt(0.75 / 0.58) (1, 0.7) = 1.1371470 (1, 0.7), p_c p_c' = 1.2931034 (1, 0.7, 0.49)
  // negative steps by 2 / |z|^2: -0.2 * 2 / 1 for (0, 1); -0.4 * 2 / 5 for (-1, 2)
  // C = (1 - 0.1 - 0.2 * 0.4) I + 0.1 p_c p_c'
  //     + 0.2 [0.7 (1, 1, 1) + 0.3 (1, 0, 0) - 0.4 (0, 0, 1) - 0.16 (1, -2, 4)]  as (11, 12, 22)
  const double c11 = 0.82 + 0.12931034 + 0.2 * (0.7 + 0.3 - 0.16);
  const double c12 = 0.12931034 * 0.7 + 0.2 * (0.7 + 0.32);
  const double c22 = 0.82 + 0.12931034 * 0.49 + 0.2 * (0.7 - 0.4 - 0.64);
  Archive archive;
  distribution.save(archive);
  const auto& c = archive.get<std::vector<double>>("covariance");
  EXPECT_NEAR(c[0], c11, 1e-7);
  EXPECT_NEAR(c[1], c12, 1e-7);
  EXPECT_NEAR(c[3], c22, 1e-7);
  const auto& l = archive.get<std::vector<double>>("factor");
  EXPECT_NEAR(l[0] * l[0], c11, 1e-7);
  EXPECT_NEAR(l[1] * l[0], c12, 1e-7);
  EXPECT_NEAR(l[1] * l[1] + l[3] * l[3], c22, 1e-7);
}

TEST(LowerTriangle, RefusesAMatrixThatIsNotPositiveDefinite) {
  std::vector<double> factor(4);
  EXPECT_FALSE(lower_triangle::factorize({1, 2, 0, 1}, 2, factor));
  EXPECT_TRUE(lower_triangle::factorize({4, 2, 0, 5}, 2, factor));
  EXPECT_EQ(factor[0], 2);
  EXPECT_EQ(factor[1], 1);
  EXPECT_EQ(factor[3], 2);
}

TEST(BoxMap, MirrorsAtFiniteSidesAndLeavesInfiniteOnesAlone) {
  const BoxMap map({{"a", "", -5, 5}, {"b", "", -kInfinity, kInfinity}, {"c", "", 1, kInfinity}});
  std::vector<double> point(3);
  const auto at = [&](double a, double b, double c) {
    map.into(std::vector<double>{a, b, c}, point);
    return point;
  };
  EXPECT_EQ(at(0.25, 7, 3), (std::vector<double>{-2.5, 7, 3}));
  EXPECT_EQ(at(1.25, -7, 0), (std::vector<double>{2.5, -7, 2}));
  EXPECT_EQ(at(-0.25, 0, 1), (std::vector<double>{-2.5, 0, 1}));
  EXPECT_EQ(at(2.25, 0, 1), (std::vector<double>{-2.5, 0, 1}));
}

TEST(CmaDistribution, DrawsAgainWhatFallsOutsideTheBox) {
  const BoxMap box({{"a", "", -5, 5}, {"b", "", -kInfinity, 0.1}});
  const CmaDistribution distribution({0.9, 0}, 0.2, false);
  const auto outside = [&](int attempts) {
    Stream stream = Draws(1, "test", 0).stream("sample");
    std::vector<double> steps, points;
    distribution.sample(stream, box, attempts, 1000, steps, points);
    int count = 0;
    for (std::size_t k = 0; k < 1000; ++k) {
      count += box.contains({points.data() + 2 * k, 2}) ? 0 : 1;
      EXPECT_NEAR(points[2 * k], 0.9 + 0.2 * steps[2 * k], 1e-12);
    }
    return count;
  };
  EXPECT_NEAR(outside(1), 1000 * (1 - 0.6915 * 0.6915), 50);  // both must be below 0.5 deviations
  EXPECT_NEAR(outside(3), 1000 * std::pow(1 - 0.6915 * 0.6915, 3), 35);
  EXPECT_EQ(outside(100), 0);
}

/// The population at the end of `generations` of a run that began with 60.
std::size_t population_after(int generations, const std::function<double(double)>& value) {
  const BoxMap everywhere({{"a", "", -kInfinity, kInfinity}, {"b", "", -kInfinity, kInfinity}});
  CmaRun run({.population = 60, .refining_population = 6, .sigma = 1, .tolerance = 0}, {3, -2});
  for (int g = 0; g < generations && run.stop_reason().empty(); ++g) {
    const std::vector<double> points =
        run.sample(Draws(2, "test", 0).stream("sample", static_cast<std::uint64_t>(g)), everywhere);
    std::vector<double> values;
    for (std::size_t k = 0; k < run.population(); ++k) {
      values.push_back(value(points[2 * k]) + value(points[2 * k + 1]));
    }
    run.update(values, -kInfinity, {});
  }
  return run.population();
}

TEST(CmaRun, GoesOnWithASmallPopulationOnceItConvergesToOneOptimum) {
  EXPECT_EQ(population_after(40, [](double x) { return -x * x; }), 6u);
  EXPECT_EQ(population_after(40, [](double x) { return x; }), 60u) << "while it travels";
  EXPECT_EQ(population_after(5, [](double x) { return -x * x; }), 60u) << "too early to say";
}

TEST(RankChangeTest, NoticesChangedRanksAndAsksRarelyWhereNothingChanges) {
  RankChangeTest quiet;
  std::int64_t asked = 0;
  for (std::int64_t g = 0; g < 160; ++g) {
    if (quiet.repetitions(g) == 0) continue;
    ++asked;
    quiet.learn(g, std::vector<double>{3, 1, 2}, std::vector<double>{3, 1, 2});
  }
  EXPECT_LE(asked, 15);
  EXPECT_FALSE(quiet.values_differ());
  RankChangeTest shifted;  // another scenario shifts all values alike: no rank changes
  for (std::int64_t g = 0; g < 20; ++g) {
    shifted.learn(g, std::vector<double>{3, 1, 2}, std::vector<double>{13, 11, 12});
  }
  EXPECT_TRUE(shifted.values_differ());
  EXPECT_FALSE(shifted.disturbed());
  for (std::int64_t g = 20; g < 23; ++g) {
    shifted.learn(g, std::vector<double>{3, 1, 2}, std::vector<double>{1, 3, 2});
  }
  EXPECT_TRUE(shifted.disturbed());
}

/// Evaluations until -sum (x - 0.3)^2 exceeds -1e-8.
std::int64_t evaluations_to_solve(const CmaEs& method, bool noisy) {
  SearchTask task;
  task.box.assign(6, {"x", "", -1, 1});
  task.budget = 20000;
  task.noisy = noisy;
  task.draws = Draws(3, "cma_es", 0);
  const auto search = method.start(task);
  std::int64_t spent = 0;
  while (true) {
    const Candidates candidates = search->ask(1000);
    std::vector<double> values;
    for (std::size_t i = 0; i < candidates.points.rows(); ++i) {
      double value = 0;
      for (std::size_t j = 0; j < 6; ++j) {
        value -= (candidates.points(i, j) - 0.3) * (candidates.points(i, j) - 0.3);
      }
      ++spent;
      if (value > -1e-8) return spent;
      values.push_back(value);
    }
    if (values.empty()) return task.budget + 1;
    search->tell(values);
  }
}

TEST(CmaEs, SolvesASphereInEveryModeWithinTwiceTheDefaultsEvaluations) {
  const std::int64_t plain = evaluations_to_solve({}, false);
  EXPECT_LT(plain, 1500);
  EXPECT_LE(static_cast<double>(evaluations_to_solve({}, true)), 1.25 * static_cast<double>(plain));
  CmaEs separable;
  separable.covariance = CmaEs::Covariance::separable;
  EXPECT_LT(evaluations_to_solve(separable, false), 2 * plain);
  CmaEs elitist;
  elitist.elitist = true;
  EXPECT_LT(evaluations_to_solve(elitist, false), 2 * plain);
  CmaEs passive;
  passive.active = false;
  EXPECT_LT(evaluations_to_solve(passive, false), 2 * plain);
}

}  // namespace
}  // namespace coppice
