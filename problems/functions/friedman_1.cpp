#include <fmt/format.h>

#include <numbers>

#include "engine/vocabulary/elementary.h"
#include "engine/vocabulary/test_function.h"

namespace coppice {
namespace {

/// 10 sin(pi x1 x2) + 20 (x3 - 0.5)^2 + 10 x4 + 5 x5 on the unit cube; further inputs say nothing.
struct Friedman1 : TestFunction {
  int dimensions = 10;

  Space inputs() const override {
    Space space;
    for (int i = 1; i <= dimensions; ++i) space.push_back({fmt::format("x{}", i), "", 0, 1});
    return space;
  }
  double value(std::span<const double> x) const override {
    const double bend = x[2] - 0.5;
    return 10 * elementary::sin(std::numbers::pi * x[0] * x[1]) + 20 * bend * bend + 10 * x[3] + 5 * x[4];
  }

  static Parameters<Friedman1> parameters() {
    return Parameters<Friedman1>().add("dimensions", &Friedman1::dimensions, "",
                                       "Number of inputs; those after the fifth say nothing.",
                                       between(5, 100));
  }
};

const Component<TestFunction, Friedman1> kFriedman1(
    "friedman_1", "Friedman's first test function: five inputs that matter, and others.",
    "Friedman, Annals of Statistics 19 (1991), 4.3; Breiman, Machine Learning 24 (1996)");

}  // namespace
}  // namespace coppice
