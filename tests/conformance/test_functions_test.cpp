// A few values of each test function.

#include <gtest/gtest.h>

#include <cmath>

#include "engine/vocabulary/random.h"
#include "engine/vocabulary/test_function.h"
#include "tests/support/golden.h"

namespace coppice {
namespace {

class TestFunctionGoldens : public testing::TestWithParam<std::string> {};

TEST_P(TestFunctionGoldens, ValuesAreTheRecordedOnes) {
  const Sub<TestFunction> function = make_for_golden<TestFunction>(GetParam());
  const Space space = function->inputs();
  ASSERT_FALSE(space.empty());
  Stream stream = Draws(2017, "golden", 0).stream("points");
  NamedValues values;
  std::vector<double> x(space.size());
  for (int i = 0; i < 8; ++i) {
    for (std::size_t d = 0; d < x.size(); ++d) {
      ASSERT_TRUE(std::isfinite(space[d].low) && space[d].low < space[d].high) << space[d].name;
      x[d] = stream.uniform(space[d].low, space[d].high);
    }
    values.add(fmt::format("value {}", i), function->value(x));
  }
  expect_golden("test_function", GetParam(), values.table(), versions_of(function));
}

INSTANTIATE_TEST_SUITE_P(All, TestFunctionGoldens,
                         testing::ValuesIn(Catalogue::instance().names("test_function")), component_name);

}  // namespace
}  // namespace coppice
