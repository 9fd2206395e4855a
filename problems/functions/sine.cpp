#include <numbers>

#include "engine/vocabulary/elementary.h"
#include "engine/vocabulary/test_function.h"

namespace coppice {
namespace {

/// sin(x) over a period.
struct Sine : TestFunction {
  Space inputs() const override { return {{"x", "", -std::numbers::pi, std::numbers::pi}}; }
  double value(std::span<const double> x) const override { return elementary::sin(x[0]); }

  static Parameters<Sine> parameters() { return {}; }
};

const Component<TestFunction, Sine> kSine("sine", "sin(x) between -pi and pi.",
                                          "L. Hofer's thesis (2017), Fig. 2.2");

}  // namespace
}  // namespace coppice
