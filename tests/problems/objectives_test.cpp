#include <gtest/gtest.h>

#include <cmath>

#include "engine/vocabulary/objective.h"
#include "tests/support/make.h"

namespace coppice {
namespace {

double value(const char* xml, std::vector<double> x) {
  return *make_from_xml<Objective>(xml)->draw(Draws(1, "", 0))->true_value(x);
}
double optimum(const char* xml) {
  return *make_from_xml<Objective>(xml)->draw(Draws(1, "", 0))->optimum();
}

// Places and values as published by Dixon and Szego.
TEST(Objectives, HaveTheirPublishedOptima) {
  EXPECT_NEAR(optimum("<branin/>"), -0.397887, 1e-6);
  EXPECT_NEAR(value("<branin/>", {-3.14159265, 12.275}), optimum("<branin/>"), 1e-9);
  EXPECT_NEAR(value("<branin/>", {3.14159265, 2.275}), optimum("<branin/>"), 1e-9);
  EXPECT_NEAR(value("<branin/>", {9.42477796, 2.475}), optimum("<branin/>"), 1e-9);
  EXPECT_NEAR(optimum("<hartmann3/>"), 3.86278, 1e-5);
  EXPECT_NEAR(value("<hartmann3/>", {0.114589, 0.555649, 0.852547}), optimum("<hartmann3/>"), 1e-9);
  EXPECT_NEAR(optimum("<hartmann6/>"), 3.32237, 1e-5);
  EXPECT_NEAR(value("<hartmann6/>", {0.201690, 0.150011, 0.476874, 0.275332, 0.311652, 0.657301}),
              optimum("<hartmann6/>"), 1e-9);
}

TEST(Objectives, AddNoiseOfTheirDeviation) {
  for (const char* xml : {"<branin noise='0.5'/>", "<hartmann3 noise='0.5'/>", "<hartmann6 noise='0.5'/>"}) {
    const auto function = make_from_xml<Objective>(xml)->draw(Draws(1, "", 0));
    EXPECT_TRUE(function->noisy());
    const std::vector<double> x(function->box().size(), 0.4);
    double square = 0;
    for (std::uint64_t i = 0; i < 2000; ++i) {
      const double noise = function->evaluate(x, Draws(3, "", 0).scenario(i)) - *function->true_value(x);
      square += noise * noise;
    }
    EXPECT_NEAR(std::sqrt(square / 2000), 0.5, 0.04) << xml;  // 5 standard errors
  }
}

}  // namespace
}  // namespace coppice
