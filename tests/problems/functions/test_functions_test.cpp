#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/vocabulary/random.h"
#include "engine/vocabulary/test_function.h"
#include "tests/support/make.h"

namespace coppice {
namespace {

TEST(TestFunctions, SineIsOneQuarterPeriodFromItsMiddle) {
  const auto sine = make_from_xml<TestFunction>("<sine/>");
  EXPECT_EQ(sine->inputs().front().high, std::numbers::pi);
  EXPECT_NEAR(sine->value(std::vector{std::numbers::pi / 2}), 1, 1e-15);
  EXPECT_EQ(sine->value(std::vector{0.0}), 0);
}

TEST(TestFunctions, Friedman1HasItsPublishedMoments) {
  // Over the unit cube E = 10 E[sin(pi u v)] + 20/12 + 5 + 2.5. With m = E sin(pi u v) = 0.5246 (the integral
  // of (1 - cos(pi u)) / (pi u)), this is 14.41; the standard deviation is 4.88 (Breiman 1996 adds unit
  // noise).
  const auto function = make_from_xml<TestFunction>("<friedman_1 dimensions=\"9\"/>");
  ASSERT_EQ(function->inputs().size(), 9u);
  Stream stream(Draws(1, "moments", 0).stream("points"));
  double sum = 0, squares = 0;
  constexpr int kPoints = 200000;
  std::vector<double> x(9);
  for (int i = 0; i < kPoints; ++i) {
    for (double& value : x) value = stream.uniform(0, 1);
    const double y = function->value(x);
    sum += y;
    squares += y * y;
  }
  const double mean = sum / kPoints;
  EXPECT_NEAR(mean, 14.41, 0.05);
  EXPECT_NEAR(std::sqrt(squares / kPoints - mean * mean), 4.88, 0.04);
  EXPECT_DOUBLE_EQ(function->value(std::vector{0.5, 1.0, 0.0, 1.0, 1.0, 9.0, 9.0, 9.0, 9.0}),
                   10 + 5 + 10 + 5.0)
      << "inputs after the fifth say nothing";
}

}  // namespace
}  // namespace coppice
