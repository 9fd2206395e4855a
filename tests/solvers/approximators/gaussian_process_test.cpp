#include "solvers/approximators/gaussian_process.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "engine/vocabulary/approximator.h"
#include "tests/support/make.h"

namespace coppice {
namespace {

/// A few samples of two inputs with weights.
struct Example {
  std::vector<std::array<double, 2>> x;
  std::vector<double> y, weights;
  Example() {
    Stream stream = Draws(7, "gaussian", 0).stream("samples");
    for (int i = 0; i < 12; ++i) {
      x.push_back({stream.uniform(-1, 1), stream.uniform(0, 4)});
      y.push_back(std::sin(3 * x.back()[0]) + 0.2 * x.back()[1] + 0.1 * stream.normal());
      weights.push_back(stream.uniform(0.5, 2));
    }
  }
  GaussianProcess process(const GaussianKernel& kernel) const {
    GaussianProcess process(kernel);
    for (std::size_t i = 0; i < x.size(); ++i) process.append(x[i], weights[i]);
    process.set_values(y);
    return process;
  }
  std::vector<std::vector<double>> covariance(const GaussianKernel& kernel) const {
    std::vector<std::vector<double>> a(x.size(), std::vector<double>(x.size()));
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (std::size_t j = 0; j < x.size(); ++j) {
        const double s = (x[i][0] - x[j][0]) / kernel.lengths[0], t = (x[i][1] - x[j][1]) / kernel.lengths[1];
        a[i][j] = std::exp(-0.5 * (s * s + t * t)) + (i == j ? kernel.noise / weights[i] : 0);
      }
    }
    return a;
  }
};

/// Gauss-Jordan: a^-1 b, and the logarithm of a's determinant.
std::vector<double> solve(std::vector<std::vector<double>> a, std::vector<double> b,
                          double* log_determinant) {
  const std::size_t n = b.size();
  double sum = 0;
  for (std::size_t k = 0; k < n; ++k) {
    sum += std::log(a[k][k]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double f = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= f * a[k][j];
      b[i] -= f * b[k];
    }
  }
  for (std::size_t k = 0; k < n; ++k) b[k] /= a[k][k];
  if (log_determinant != nullptr) *log_determinant = sum;
  return b;
}

const GaussianKernel kKernel{{0.7, 2.5}, 0.03};

/// log N(y; c 1, s A), written down as it is defined.
double density(const Example& example, const GaussianKernel& kernel, double constant, double scale) {
  std::vector<double> r = example.y;
  for (double& v : r) v -= constant;
  double log_determinant = 0;
  const std::vector<double> solved = solve(example.covariance(kernel), r, &log_determinant);
  double square = 0;
  for (std::size_t i = 0; i < r.size(); ++i) square += r[i] * solved[i];
  const auto n = static_cast<double>(r.size());
  return -0.5 * (square / scale + log_determinant + n * std::log(2 * std::numbers::pi * scale));
}

TEST(GaussianProcess, LikelihoodIsTheNormalDensityAtItsLargest) {
  const Example example;
  const GaussianProcess process = example.process(kKernel);
  const double c = process.constant(), s = process.scale();
  EXPECT_NEAR(process.log_likelihood(), density(example, kKernel, c, s), 1e-9);
  for (const double step : {-1e-3, 1e-3}) {
    EXPECT_LT(density(example, kKernel, c + step, s), process.log_likelihood());
    EXPECT_LT(density(example, kKernel, c, s * (1 + step)), process.log_likelihood());
  }
}

TEST(GaussianProcess, GradientOfTheLikelihoodMatchesFiniteDifferences) {
  const Example example;
  std::array<double, 3> gradient{};
  example.process(kKernel).log_likelihood(gradient);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto at = [&](double step) {
      GaussianKernel kernel = kKernel;
      (k < 2 ? kernel.lengths[k] : kernel.noise) *= std::exp(step);
      return example.process(kernel).log_likelihood();
    };
    EXPECT_NEAR(gradient[k], (at(1e-5) - at(-1e-5)) / 2e-5, 1e-6 * std::max(1.0, std::abs(gradient[k]))) << k;
  }
}

TEST(GaussianProcess, PosteriorIsTheConditionalDistribution) {
  const Example example;
  const GaussianProcess process = example.process(kKernel);
  const std::array<double, 2> x{0.3, 1.7};
  std::vector<double> k, r = example.y;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const double s = (x[0] - example.x[i][0]) / 0.7, t = (x[1] - example.x[i][1]) / 2.5;
    k.push_back(std::exp(-0.5 * (s * s + t * t)));
    r[i] -= process.constant();
  }
  const std::vector<double> a = solve(example.covariance(kKernel), k, nullptr);
  double mean = process.constant(), rest = 1;
  for (std::size_t i = 0; i < r.size(); ++i) {
    mean += a[i] * r[i];
    rest -= a[i] * k[i];
  }
  const GaussianPosterior at = process.posterior(x);
  EXPECT_NEAR(at.mean, mean, 1e-10);
  EXPECT_NEAR(at.variance, process.scale() * rest, 1e-10);
}

TEST(GaussianProcess, GradientsOfThePosteriorMatchFiniteDifferences) {
  const GaussianProcess process = Example().process(kKernel);
  std::array<double, 2> mean{}, variance{};
  const std::array<double, 2> x{0.3, 1.7};
  process.posterior(x, mean, variance);
  for (std::size_t k = 0; k < 2; ++k) {
    std::array<double, 2> up = x, down = x;
    up[k] += 1e-5;
    down[k] -= 1e-5;
    EXPECT_NEAR(mean[k], (process.posterior(up).mean - process.posterior(down).mean) / 2e-5, 1e-7);
    EXPECT_NEAR(variance[k], (process.posterior(up).variance - process.posterior(down).variance) / 2e-5,
                1e-7);
  }
}

TEST(GaussianProcess, SamplesOneByOneOrAtOnceGiveTheSameBits) {
  const Example example;
  GaussianProcess process = example.process({{1, 1}, 0.1});
  process.set_kernel(kKernel);
  process.set_values(example.y);
  const std::array<double, 2> x{-0.4, 3};
  EXPECT_EQ(process.posterior(x).mean, example.process(kKernel).posterior(x).mean);
  EXPECT_EQ(process.posterior(x).variance, example.process(kKernel).posterior(x).variance);
}

TEST(GaussianProcess, TuningClimbsToAStationaryPoint) {
  GaussianProcess process = Example().process(kKernel);
  const double before = process.log_likelihood();
  tune(process, {{0.02, 0.04}, {40, 80}, 1e-8, 10, 100}, 3);
  std::array<double, 3> gradient{};
  EXPECT_GT(process.log_likelihood(gradient), before);
  const auto inside = [](double v, double low, double high) { return v > 1.001 * low && v < 0.999 * high; };
  const GaussianKernel& kernel = process.kernel();
  if (inside(kernel.lengths[0], 0.02, 40)) {
    EXPECT_NEAR(gradient[0], 0, 1e-3);
  }
  if (inside(kernel.lengths[1], 0.04, 80)) {
    EXPECT_NEAR(gradient[1], 0, 1e-3);
  }
  EXPECT_TRUE(inside(kernel.lengths[0], 0.02, 40)) << "the first input matters";
}

/// y0 = sin(3 x0) + x1, y1 = 5 x1 - 2, without noise; x2 does not vary.
struct Smooth {
  Matrix x{80, 3}, y{80, 2};
  Smooth() {
    Stream stream = Draws(2017, "gaussian", 0).stream("samples");
    for (std::size_t i = 0; i < 80; ++i) {
      x.set_row(i, std::array{stream.uniform(-1, 1), stream.uniform(3, 5), 4.0});
      y.set_row(i, std::array{std::sin(3 * x(i, 0)) + x(i, 1), 5 * x(i, 1) - 2});
    }
  }
  MadeFunction fit(const std::string& xml = "<gaussian_process/>", std::vector<double> weights = {}) const {
    Serial serial;
    return make_from_xml<Approximator>(xml)->fit({x, y, weights}, Draws(1, "", 0), serial);
  }
};

TEST(GaussianProcessApproximator, FindsASmoothFunction) {
  for (const char* xml : {"<gaussian_process/>", "<gaussian_process mean='linear'/>"}) {
    const MadeFunction function = Smooth().fit(xml);
    std::array<double, 2> y{};
    function->predict(std::array{0.25, 4.2, 4.0}, y);
    EXPECT_NEAR(y[0], std::sin(0.75) + 4.2, 2e-3) << xml;
    EXPECT_NEAR(y[1], 19, 2e-3) << xml;
  }
}

TEST(GaussianProcessApproximator, WeighsSamples) {
  Smooth samples;
  std::vector<double> weights(80, 1.0);
  samples.y(5, 0) += 100;
  weights[5] = 0;
  std::array<double, 2> y{};
  samples.fit("<gaussian_process/>", weights)->predict(std::array{0.25, 4.2, 4.0}, y);
  EXPECT_NEAR(y[0], std::sin(0.75) + 4.2, 2e-3) << "weight 0 is no sample";
}

TEST(GaussianProcessApproximator, RefusesOrDrawsBeyondItsLimit) {
  EXPECT_THROW(Smooth().fit("<gaussian_process max_samples='79'/>"), std::invalid_argument);
  const MadeFunction part = Smooth().fit("<gaussian_process max_samples='60' beyond='draw'/>");
  EXPECT_EQ(part->facts().front().second, 60);
  std::array<double, 2> y{};
  part->predict(std::array{0.25, 4.2, 4.0}, y);
  EXPECT_NEAR(y[0], std::sin(0.75) + 4.2, 1e-2);
}

TEST(GaussianProcessApproximator, CopesWithConstantsAndSingleSamples) {
  const Matrix one_x(1, 1), same_y(4, 1);
  Matrix same_x(4, 1), one_y(1, 1);
  one_y(0, 0) = 7;
  Serial serial;
  std::array<double, 1> y{};
  const auto approximator = make_from_xml<Approximator>("<gaussian_process/>");
  approximator->fit({one_x, one_y, {}}, Draws(1, "", 0), serial)->predict(std::array{3.0}, y);
  EXPECT_NEAR(y[0], 7, 1e-12);
  approximator->fit({same_x, same_y, {}}, Draws(1, "", 0), serial)->predict(std::array{3.0}, y);
  EXPECT_EQ(y[0], 0);
}

TEST(GaussianFunction, FindsItsMaximumInABox) {
  const MadeFunction function = Smooth().fit();
  const Maximum best = function->maximize(std::array{0.5}, {{"x1", "", 3, 4.5}, {"x2", "", 4, 4}}, {});
  EXPECT_NEAR(best.at[0], 4.5, 1e-9);
  EXPECT_NEAR(best.value, std::sin(1.5) + 4.5, 5e-3);
  // sin has its maximum at pi / 6 when the first input is free
  const Maximum inside =
      function->maximize({}, {{"x0", "", -1, 1}, {"x1", "", 3, 4.5}, {"x2", "", 4, 4}}, {});
  EXPECT_NEAR(inside.at[0], std::numbers::pi / 6, 5e-3);
}

TEST(GaussianFunction, IsReadBackBitExactlyAndRefusesWhatIsNone) {
  const MadeFunction function = Smooth().fit();
  Archive archive;
  save_function(function, archive);
  const MadeFunction back = load_function(archive);
  std::array<double, 2> a{}, b{};
  function->predict(std::array{0.1, 4.0, 4.0}, a);
  back->predict(std::array{0.1, 4.0, 4.0}, b);
  EXPECT_EQ(a, b);

  Archive plain;
  function->save(plain);
  const auto load = [&](const std::string& name, std::vector<double> values) {
    Archive damaged = plain;
    damaged.put(name, std::move(values));
    make_from_xml<Function>("<gaussian_process/>").object->load(damaged);
  };
  EXPECT_THROW(load("0/lengths", {1, 1, 0}), std::runtime_error);
  EXPECT_THROW(load("0/lengths", {1, 1}), std::runtime_error);
  EXPECT_THROW(load("1/weights", {1}), std::runtime_error);
  EXPECT_THROW(load("1/slopes", {0, 0, std::nan("")}), std::runtime_error);
  EXPECT_THROW(load("places", {}), std::runtime_error);
}

}  // namespace
}  // namespace coppice
