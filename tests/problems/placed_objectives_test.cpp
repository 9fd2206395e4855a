#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "engine/vocabulary/objective.h"
#include "tests/support/make.h"

namespace coppice {
namespace {

std::unique_ptr<const ObjectiveFunction> drawn(const std::string& xml, std::uint64_t seed = 1) {
  return make_from_xml<Objective>(xml)->draw(Draws(seed, "", 0));
}
double value(const std::string& xml, const std::vector<double>& x, std::uint64_t seed = 1) {
  return *drawn(xml, seed)->true_value(x);
}

TEST(PlacedObjectives, HaveValuesMadeByHandAboutTheOrigin) {
  EXPECT_EQ(value("<sphere n='2' spread='0'/>", {3, 4}), -25);
  EXPECT_NEAR(value("<ellipsoid n='3' spread='0'/>", {1, -1, 1}), -1001001, 1e-6);
  EXPECT_NEAR(value("<ellipsoid n='3' spread='0' condition='16'/>", {2, 1, 1}), -(4 + 4 + 16), 1e-12);
  // Rosenbrock's own start (-1.2, 1), seen from his optimum (1, 1).
  EXPECT_NEAR(value("<rosenbrock n='2' spread='0'/>", {-2.2, 0}), -24.2, 1e-12);
  EXPECT_NEAR(value("<rosenbrock n='3' spread='0'/>", {-1, -1, -1}), -2, 1e-12);
  // Of one input a rotation is at most a mirror.
  EXPECT_NEAR(value("<rotated_rastrigin n='1' spread='0'/>", {1}), -1, 1e-12);
  EXPECT_NEAR(value("<rotated_rastrigin n='1' spread='0'/>", {0.5}), -20.25, 1e-12);
  EXPECT_EQ(value("<step n='1' spread='0'/>", {0.04}), 0);
  EXPECT_NEAR(value("<step n='1' spread='0'/>", {0.31}), -0.09, 1e-12);
  EXPECT_NEAR(value("<step n='1' spread='0'/>", {1.3}), -1, 1e-12);
}

const std::vector<std::string> kNames = {"sphere",     "ellipsoid",         "rotated_ellipsoid",
                                         "rosenbrock", "rotated_rastrigin", "step"};

TEST(PlacedObjectives, AreLargestAtTheirOptimum) {
  for (const std::string& name : kNames) {
    const auto function = drawn("<" + name + " n='4' spread='0'/>");
    const std::vector<double> origin(4, 0.0);
    EXPECT_EQ(*function->true_value(origin), 0) << name;
    EXPECT_EQ(*function->optimum(), 0) << name;
    EXPECT_FALSE(function->noisy());
    Stream stream = Draws(7, "", 0).stream("points");
    for (int i = 0; i < 100; ++i) {
      std::vector<double> x;
      for (std::size_t d = 0; d < 4; ++d) x.push_back(stream.uniform(-3, 3));
      EXPECT_LE(*function->true_value(x), 0) << name;
    }
  }
}

/// The optimum of a drawn quadratic is where its gradient, by differences that are exact for it, vanishes.
TEST(PlacedObjectives, DrawTheirOptimumWithinTheSpread) {
  double sum = 0, square = 0, most = 0;
  constexpr int kSeeds = 400;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const auto function = drawn("<sphere n='1' spread='2'/>", seed);
    const double at_0 = *function->true_value(std::vector<double>{0}),
                 at_1 = *function->true_value(std::vector<double>{1});
    const double optimum = (at_1 - at_0 + 1) / 2;  // -(1 - o)^2 + o^2 = 2 o - 1
    sum += optimum;
    square += optimum * optimum;
    most = std::max(most, std::fabs(optimum));
  }
  EXPECT_LE(most, 2);
  EXPECT_GT(most, 1.9);
  EXPECT_NEAR(sum / kSeeds, 0, 5 * 2 / std::sqrt(3.0 * kSeeds));  // 5 standard errors
  EXPECT_NEAR(square / kSeeds, 4.0 / 3, 5 * 4 * std::sqrt((0.2 - 1.0 / 9) / kSeeds));
}

TEST(PlacedObjectives, TurnTheirAxesWithoutStretchingThem) {
  constexpr std::size_t kN = 20;
  const auto ellipsoid = drawn("<rotated_ellipsoid n='20' spread='0' condition='100'/>");
  const auto loss = [&](std::size_t i, std::size_t j) {
    std::vector<double> x(kN, 0.0);
    x[i] += 1;
    x[j] += 1;
    return -*ellipsoid->true_value(x);
  };
  double trace = 0, square = 0, off_diagonal = 0;  // of the matrix of the quadratic form
  for (std::size_t i = 0; i < kN; ++i) {
    for (std::size_t j = 0; j < kN; ++j) {
      const double entry = i == j ? loss(i, i) / 4 : (loss(i, j) - loss(i, i) / 4 - loss(j, j) / 4) / 2;
      if (i == j) trace += entry;
      square += entry * entry;
      if (i != j) off_diagonal = std::max(off_diagonal, std::fabs(entry));
    }
  }
  double weights = 0, squares = 0;
  for (std::size_t i = 0; i < kN; ++i) {
    const double weight = std::pow(100.0, static_cast<double>(i) / (kN - 1));
    weights += weight;
    squares += weight * weight;
  }
  EXPECT_NEAR(trace, weights, 1e-9 * weights);
  EXPECT_NEAR(square, squares, 1e-9 * squares);
  EXPECT_GT(off_diagonal, 1) << "it is turned";
}

/// The expected square of an entry of a uniform rotation is 1 / n: the mean loss at a unit vector is the mean
/// weight, whichever the axis.
TEST(PlacedObjectives, TurnTheirAxesUniformly) {
  constexpr int kSeeds = 2000;
  for (const std::size_t axis : {0u, 2u}) {
    std::vector<double> losses;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      std::vector<double> x(3, 0.0);
      x[axis] = 1;
      losses.push_back(-value("<rotated_ellipsoid n='3' spread='0' condition='100'/>", x, seed));
    }
    const double mean = std::accumulate(losses.begin(), losses.end(), 0.0) / kSeeds;
    double square = 0;
    for (const double loss : losses) square += (loss - mean) * (loss - mean);
    const double error = std::sqrt(square / kSeeds / kSeeds);
    EXPECT_NEAR(mean, (1 + 10 + 100) / 3.0, 5 * error) << axis;
  }
}

TEST(PlacedObjectives, OfOneSeedShareTheirOptimum) {
  const std::vector<double> x = {0.3, -1.2, 2.5};
  EXPECT_NEAR(value("<rotated_ellipsoid n='3' condition='1'/>", x), value("<sphere n='3'/>", x), 1e-12);
  EXPECT_NEAR(value("<ellipsoid n='3' condition='1'/>", x), value("<sphere n='3'/>", x), 1e-12);
  EXPECT_NE(value("<sphere n='3'/>", x, 1), value("<sphere n='3'/>", x, 2));
}

TEST(PlacedObjectives, AddNoiseOfTheirDeviation) {
  for (const std::string& name : kNames) {
    const auto function = drawn("<" + name + " n='3' noise='0.5'/>");
    EXPECT_TRUE(function->noisy());
    const std::vector<double> x(3, 0.4);
    double sum = 0, square = 0;
    for (std::uint64_t i = 0; i < 2000; ++i) {
      const double noise = function->evaluate(x, Draws(3, "", 0).scenario(i)) - *function->true_value(x);
      sum += noise;
      square += noise * noise;
    }
    EXPECT_NEAR(sum / 2000, 0, 5 * 0.5 / std::sqrt(2000.0)) << name;
    EXPECT_NEAR(std::sqrt(square / 2000), 0.5, 0.04) << name;  // 5 standard errors
  }
}

}  // namespace
}  // namespace coppice
