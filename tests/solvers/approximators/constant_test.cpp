#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "engine/vocabulary/approximator.h"
#include "tests/support/make.h"

namespace coppice {
namespace {

MadeFunction fit(const Matrix& x, const Matrix& y, const std::vector<double>& weights = {}) {
  Serial serial;
  return make_from_xml<Approximator>("<constant/>")->fit({x, y, weights}, Draws(1, "", 0), serial);
}

Matrix column(const std::vector<double>& values) {
  Matrix matrix(values.size(), 1);
  std::copy(values.begin(), values.end(), matrix.column(0).begin());
  return matrix;
}

double value(const Function& function) {
  double y = 0;
  function.predict(std::vector<double>(function.inputs(), 0.5), {&y, 1});
  return y;
}

TEST(ConstantApproximator, IsTheWeightedMean) {
  const Matrix x(3, 2), y = column({1, 2, 6});
  EXPECT_EQ(value(*fit(x, y)), 3);
  EXPECT_EQ(value(*fit(x, y, {2, 1, 1})), 2.5);
  EXPECT_EQ(value(*fit(x, y, {0, 1, 0})), 2);
  EXPECT_EQ(fit(x, y)->inputs(), 2u);
}

TEST(ConstantFunction, IsLargestInTheCentre) {
  const MadeFunction function = fit(Matrix(2, 3), column({1, 3}));
  const Maximum best = function->maximize(std::vector<double>{0}, {{"a", "", -1, 2}, {"b", "", 0, 1}}, {});
  EXPECT_EQ(best.value, 2);
  EXPECT_EQ(best.at, (Vec<kMaxActionSize>{0.5, 0.5}));
}

TEST(ConstantFunction, RefusesArraysThatMakeNone) {
  const auto load = [](std::vector<std::int64_t> inputs, std::vector<double> values) {
    Archive archive;
    archive.put("inputs", std::move(inputs));
    archive.put("value", std::move(values));
    make_from_xml<Function>("<constant/>").object->load(archive);
  };
  EXPECT_NO_THROW(load({2}, {1}));
  EXPECT_THROW(load({-1}, {1}), std::runtime_error);
  EXPECT_THROW(load({1, 2}, {1}), std::runtime_error);
  EXPECT_THROW(load({2}, {}), std::runtime_error);
  EXPECT_THROW(load({2}, {std::numeric_limits<double>::infinity()}), std::runtime_error);
}

}  // namespace
}  // namespace coppice
