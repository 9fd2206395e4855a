#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "engine/vocabulary/approximator.h"
#include "tests/support/make.h"

namespace coppice {
namespace {

/// y0 = 1 + 2 x0 - 3 x1, y1 = x1 at random places; the last sample is wrong.
struct LinearSamples {
  Matrix x{41, 2}, y{41, 2};
  LinearSamples() {
    Stream stream = Draws(2017, "linear", 0).stream("samples");
    for (std::size_t i = 0; i < 41; ++i) {
      x.set_row(i, std::array{stream.uniform(-1, 1), stream.uniform(3, 4)});
      y.set_row(i, std::array{1 + 2 * x(i, 0) - 3 * x(i, 1), x(i, 1)});
    }
    y(40, 0) = 1000;
  }
  MadeFunction fit(double last_weight) const {
    std::vector<double> weights(41, 1.5);
    weights[40] = last_weight;
    Serial serial;
    return make_from_xml<Approximator>("<linear/>")->fit({x, y, weights}, Draws(1, "", 0), serial);
  }
};

TEST(LinearApproximator, FindsALinearFunction) {
  const MadeFunction function = LinearSamples().fit(0);
  std::array<double, 2> y{};
  function->predict(std::array{0.5, -2.0}, y);
  EXPECT_NEAR(y[0], 8, 1e-12);
  EXPECT_NEAR(y[1], -2, 1e-12);
  LinearSamples().fit(1)->predict(std::array{0.5, -2.0}, y);
  EXPECT_GT(std::abs(y[0] - 8), 1) << "weights count";
}

TEST(LinearFunction, IsLargestInACorner) {
  const Maximum best = LinearSamples().fit(0)->maximize(std::vector<double>{0.5}, {{"x1", "", -1, 4}}, {});
  EXPECT_EQ(best.at[0], -1);
  EXPECT_NEAR(best.value, 5, 1e-12);
  const Maximum both = LinearSamples().fit(0)->maximize({}, {{"x0", "", -1, 4}, {"x1", "", -1, 4}}, {});
  EXPECT_EQ(both.at, (Vec<kMaxActionSize>{4, -1}));
}

TEST(LinearFunction, RefusesArraysThatMakeNone) {
  const auto load = [](std::vector<double> slopes, std::vector<double> bias) {
    Archive archive;
    archive.put("slopes", std::move(slopes));
    archive.put("bias", std::move(bias));
    make_from_xml<Function>("<linear/>").object->load(archive);
  };
  EXPECT_NO_THROW(load({1, 2, 3, 4}, {1, 2}));
  EXPECT_THROW(load({1, 2, 3}, {1, 2}), std::runtime_error);
  EXPECT_THROW(load({1}, {}), std::runtime_error);
  EXPECT_THROW(load({std::numeric_limits<double>::quiet_NaN()}, {1}), std::runtime_error);
}

}  // namespace
}  // namespace coppice
