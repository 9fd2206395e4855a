// Some evaluations of each objective.

#include <gtest/gtest.h>

#include "engine/vocabulary/objective.h"
#include "tests/support/golden.h"

namespace coppice {
namespace {

class Objectives : public testing::TestWithParam<std::string> {};

TEST_P(Objectives, EvaluationsAreTheRecordedOnes) {
  const Sub<Objective> objective = make_for_golden<Objective>(GetParam());
  const Draws draws(2017, "golden", 0);
  const auto function = objective->draw(draws);
  NamedValues values;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const Draws place = draws.fork("place").step(i);
    std::vector<double> x;
    for (const Axis& axis : function->box()) {
      const bool finite = std::isfinite(axis.low) && std::isfinite(axis.high);
      x.push_back(place.uniform("x", finite ? axis.low : -4, finite ? axis.high : 4,
                                static_cast<std::uint32_t>(x.size())));
    }
    const double value = function->evaluate(x, draws.scenario(i));
    EXPECT_EQ(value, function->evaluate(x, draws.scenario(i)));
    if (!function->noisy()) {
      EXPECT_EQ(value, function->evaluate(x, draws.scenario(i + 1)));
    }
    if (function->optimum() && function->true_value(x)) {
      EXPECT_LE(*function->true_value(x), *function->optimum());
    }
    values.add(fmt::format("evaluation {}", i), value);
  }
  if (function->optimum()) values.add("optimum", *function->optimum());
  expect_golden("objective", GetParam(), values.table(), versions_of(objective));
}

INSTANTIATE_TEST_SUITE_P(All, Objectives, testing::ValuesIn(Catalogue::instance().names("objective")),
                         component_name);

}  // namespace
}  // namespace coppice
