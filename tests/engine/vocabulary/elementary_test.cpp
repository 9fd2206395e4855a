#include "engine/vocabulary/elementary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "engine/vocabulary/random.h"

namespace coppice {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kSamples = 200000;

/// |value - exact| in units of the last place of `value`.
double ulps(double value, long double exact) {
  const double spacing =
      std::nextafter(std::fabs(value), std::numeric_limits<double>::infinity()) - std::fabs(value);
  return static_cast<double>(std::fabs(static_cast<long double>(value) - exact) / spacing);
}

/// The largest error over random arguments. The reference is the C library's long double, 2000 times finer.
double worst_error(double low, double high, const std::function<double(double)>& function,
                   const std::function<long double(long double)>& exact) {
  Stream stream = Draws(1, "elementary", 0).stream("arguments");
  double worst = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double x = stream.uniform(low, high);
    worst = std::max(worst, ulps(function(x), exact(x)));
  }
  return worst;
}

TEST(Elementary, ErrorsStayBelowOneUnitInTheLastPlace) {
  using L = long double;
  EXPECT_LT(worst_error(-10, 10, elementary::sin, [](L x) { return std::sin(x); }), 1.0);
  EXPECT_LT(worst_error(-1e5, 1e5, elementary::sin, [](L x) { return std::sin(x); }), 1.0);
  EXPECT_LT(worst_error(-10, 10, elementary::cos, [](L x) { return std::cos(x); }), 1.0);
  EXPECT_LT(worst_error(-1.5, 1.5, elementary::tan, [](L x) { return std::tan(x); }), 1.0);
  EXPECT_LT(worst_error(-700, 700, elementary::exp, [](L x) { return std::exp(x); }), 1.0);
  EXPECT_LT(worst_error(1e-3, 1e3, elementary::log, [](L x) { return std::log(x); }), 1.0);
  EXPECT_LT(worst_error(-0.5, 2, elementary::log1p, [](L x) { return std::log1p(x); }), 1.0);
  EXPECT_LT(worst_error(
                -5, 5, [](double x) { return elementary::atan2(x, 0.7); },
                [](L x) { return std::atan2(x, static_cast<L>(0.7)); }),
            1.0);
  EXPECT_LT(worst_error(
                -5, 5, [](double x) { return elementary::atan2(0.7, x); },
                [](L x) { return std::atan2(static_cast<L>(0.7), x); }),
            1.0);
  EXPECT_LT(worst_error(
                -20, 20, [](double x) { return elementary::pow(1.7, x); },
                [](L x) { return std::pow(static_cast<L>(1.7), x); }),
            1.0);
}

TEST(Elementary, SpecialArguments) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(elementary::sin(0.0), 0.0);
  EXPECT_EQ(elementary::cos(0.0), 1.0);
  EXPECT_EQ(elementary::exp(0.0), 1.0);
  EXPECT_EQ(elementary::exp(-infinity), 0.0);
  EXPECT_EQ(elementary::log(1.0), 0.0);
  EXPECT_EQ(elementary::log(0.0), -infinity);
  EXPECT_TRUE(std::isnan(elementary::log(-1.0)));
  EXPECT_TRUE(std::isnan(elementary::sin(infinity)));
  EXPECT_EQ(elementary::atan2(0.0, -1.0), kPi);
  EXPECT_EQ(elementary::pow(2.0, 10.0), 1024.0);
}

TEST(NormalizeAngle, KeepsWhatIsInRange) {
  for (double angle : {-kPi, -3.0, -1e-300, 0.0, 1.0, std::nextafter(kPi, 0.0)})
    EXPECT_EQ(normalize_angle(angle), angle);
}

TEST(NormalizeAngle, WrapsIntoTheHalfOpenRange) {
  EXPECT_EQ(normalize_angle(kPi), -kPi);
  EXPECT_NEAR(normalize_angle(3 * kPi), -kPi, 1e-15);
  EXPECT_NEAR(normalize_angle(2 * kPi + 0.5), 0.5, 1e-15);
  EXPECT_NEAR(normalize_angle(-2 * kPi - 0.5), -0.5, 1e-15);
  EXPECT_NEAR(normalize_angle(7.0), 7.0 - 2 * kPi, 1e-15);
  Stream stream = Draws(2, "angles", 0).stream("angles");
  for (int i = 0; i < 10000; ++i) {
    const double angle = stream.uniform(-100, 100);
    const double wrapped = normalize_angle(angle);
    EXPECT_TRUE(wrapped >= -kPi && wrapped < kPi) << angle;
    EXPECT_NEAR(std::remainder(angle - wrapped, 2 * kPi), 0, 1e-13) << angle;
  }
  const double just_below = std::nextafter(-kPi, -4.0);  // rounding would give pi
  EXPECT_GE(normalize_angle(just_below), -kPi);
  EXPECT_LT(normalize_angle(just_below), kPi);
}

// The first three are the test values of the paper (Wichura 1988); all agree with 40-digit arithmetic.
TEST(NormalQuantile, GivesThePublishedValues) {
  EXPECT_NEAR(normal_quantile(0.25), -0.6744897501960817, 1e-15);
  EXPECT_NEAR(normal_quantile(0.001), -3.090232306167814, 4e-15);
  EXPECT_NEAR(normal_quantile(1e-20), -9.262340089798408, 1e-14);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 2e-15);
  EXPECT_NEAR(normal_quantile(1e-5), -4.264890793922825, 4e-15);
  EXPECT_EQ(normal_quantile(0.5), 0.0);
}

TEST(NormalQuantile, InvertsTheDistributionFunction) {
  for (double p = 1e-6; p < 1; p += 0.00123) {
    const long double z = normal_quantile(p);
    const long double back = 0.5L * std::erfc(-z / std::sqrt(2.0L));
    EXPECT_NEAR(static_cast<double>(back / p), 1.0, 5e-15) << p;
    if (p > 0.1 && p < 0.9) {
      EXPECT_NEAR(normal_quantile(1 - p), -normal_quantile(p), 1e-15);
    }
  }
}

}  // namespace
}  // namespace coppice
