#include "solvers/approximators/least_squares.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "engine/vocabulary/random.h"

namespace coppice {
namespace {

struct Fit {
  double bias = 0, residual = 0;
  std::vector<double> slopes;
};

/// Rows of x, then y, then weight.
struct Rows {
  std::vector<std::vector<double>> rows;
  std::size_t inputs() const { return rows[0].size() - 2; }

  Moments moments(std::size_t end) const {
    Moments moments(inputs());
    moments.reset(std::span(rows[0]).first(inputs() + 1));
    for (std::size_t i = 0; i < end; ++i) moments.add(rows[i].data(), rows[i].back());
    return moments;
  }
  static Fit fit(Moments moments, std::size_t inputs) {
    Fit fit;
    fit.slopes.resize(inputs);
    fit.residual = moments.fit(fit.bias, fit.slopes);
    return fit;
  }
  /// By a QR decomposition of the rows from `begin` on.
  Fit by_qr(std::size_t begin) const {
    const auto n = static_cast<Eigen::Index>(rows.size() - begin);
    const auto d = static_cast<Eigen::Index>(inputs());
    Eigen::MatrixXd a(n, d + 1);
    Eigen::VectorXd b(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::vector<double>& row = rows[begin + static_cast<std::size_t>(i)];
      const double root = std::sqrt(row.back());
      for (Eigen::Index c = 0; c < d; ++c) a(i, c) = root * row[static_cast<std::size_t>(c)];
      a(i, d) = root;
      b(i) = root * row[inputs()];
    }
    const Eigen::VectorXd x = a.colPivHouseholderQr().solve(b);
    return {x(d), (a * x - b).squaredNorm(), {x.data(), x.data() + d}};
  }
};

Rows random_rows(std::uint64_t trial, std::size_t n, std::size_t inputs, double centre) {
  Stream stream = Draws(2017, "least squares", 0).stream("trial", trial);
  Rows made;
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<double> row;
    for (std::size_t c = 0; c < inputs; ++c) row.push_back(centre + stream.uniform(-1, 1));
    row.push_back(row[0] - 0.5 * row[inputs - 1] + 0.1 * stream.normal());
    row.push_back(stream.uniform(0.5, 2));
    made.rows.push_back(row);
  }
  return made;
}

void expect_near(const Fit& fit, const Fit& expected, double tolerance) {
  EXPECT_NEAR(fit.residual, expected.residual, tolerance);
  EXPECT_NEAR(fit.bias, expected.bias, tolerance);
  for (std::size_t c = 0; c < fit.slopes.size(); ++c) {
    EXPECT_NEAR(fit.slopes[c], expected.slopes[c], tolerance);
  }
}

TEST(Moments, FitsAsAQrDecompositionDoes) {
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    const std::size_t inputs = 1 + trial % 6;
    const Rows rows = random_rows(trial, inputs + 2 + trial % 40, inputs, 0);
    expect_near(Rows::fit(rows.moments(rows.rows.size()), inputs), rows.by_qr(0), 1e-8);
  }
}

TEST(Moments, FitsFarFromTheOrigin) {
  const Rows rows = random_rows(0, 50, 2, 1e6);
  const Fit fit = Rows::fit(rows.moments(50), 2), expected = rows.by_qr(0);
  EXPECT_NEAR(fit.slopes[0], expected.slopes[0], 1e-6);
  EXPECT_NEAR(fit.slopes[1], expected.slopes[1], 1e-6);
  EXPECT_NEAR(fit.residual, expected.residual, 1e-6);
}

TEST(Moments, OfADifferenceAreThoseOfTheOtherSamples) {
  for (std::uint64_t trial = 0; trial < 100; ++trial) {
    const std::size_t inputs = 1 + trial % 4;
    const Rows rows = random_rows(trial, 60, inputs, 0);
    Moments rest(inputs);
    rest.set_difference(rows.moments(60), rows.moments(25));
    expect_near(Rows::fit(rest, inputs), rows.by_qr(25), 1e-8);
  }
}

TEST(Moments, AnInputThatDoesNotVaryGetsSlope0) {
  Rows rows = random_rows(1, 30, 3, 0);
  for (auto& row : rows.rows) row[1] = 0.1;
  const Fit fit = Rows::fit(rows.moments(30), 3);
  EXPECT_EQ(fit.slopes[1], 0);
  Rows without;
  for (const auto& row : rows.rows) without.rows.push_back({row[0], row[2], row[3], row[4]});
  const Fit expected = without.by_qr(0);
  EXPECT_NEAR(fit.slopes[0], expected.slopes[0], 1e-9);
  EXPECT_NEAR(fit.slopes[2], expected.slopes[1], 1e-9);
  EXPECT_NEAR(fit.bias, expected.bias, 1e-9);
}

// x1 = 2 x0: many slopes are as good; those found are small and lose next to nothing.
TEST(Moments, DependentInputsGetSmallSlopes) {
  Rows rows = random_rows(2, 40, 2, 0);
  for (auto& row : rows.rows) row[1] = 2 * row[0];
  const Fit fit = Rows::fit(rows.moments(40), 2), best = rows.by_qr(0);
  EXPECT_NEAR(fit.residual, best.residual, 1e-4 * best.residual);
  EXPECT_NEAR(fit.slopes[0] + 2 * fit.slopes[1], best.slopes[0] + 2 * best.slopes[1], 1e-4);
  EXPECT_LT(std::hypot(fit.slopes[0], fit.slopes[1]), 2);
}

TEST(Moments, OneSampleIsItsOutput) {
  const Rows rows = random_rows(3, 1, 2, 0);
  const Fit fit = Rows::fit(rows.moments(1), 2);
  EXPECT_EQ(fit.slopes, (std::vector<double>{0, 0}));
  EXPECT_EQ(fit.bias, rows.rows[0][2]);
  EXPECT_EQ(fit.residual, 0);
}

TEST(Moments, FewerSamplesThanUnknownsGoThroughAll) {
  const Rows rows = random_rows(4, 3, 4, 0);
  const Fit fit = Rows::fit(rows.moments(3), 4);
  for (const auto& row : rows.rows) {
    double value = fit.bias;
    for (std::size_t c = 0; c < 4; ++c) value += fit.slopes[c] * row[c];
    EXPECT_NEAR(value, row[4], 1e-3);
  }
}

}  // namespace
}  // namespace coppice
