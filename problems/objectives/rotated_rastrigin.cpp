#include <numbers>

#include "engine/vocabulary/elementary.h"
#include "problems/objectives/placed_function.h"

namespace coppice {
namespace {

struct RotatedRastrigin : PlacedFamily {
  std::unique_ptr<const ObjectiveFunction> draw(const Draws& draws) const override {
    return placed(Frame::Axes::turned, draws, [](const auto& z) {
      double sum = 0;
      for (std::size_t i = 0; i < z.size(); ++i) {
        const double t = z[i];
        sum += t * t + 10 * (1 - elementary::cos(2 * std::numbers::pi * t));
      }
      return sum;
    });
  }
  static Parameters<RotatedRastrigin> parameters() { return placed_parameters<RotatedRastrigin>(); }
};

const Component<Objective, RotatedRastrigin> kRotatedRastrigin(
    "rotated_rastrigin",
    "Minus Rastrigin's function in coordinates that are turned at random: a local optimum near every point "
    "of a grid.",
    "Muehlenbein, Schomisch and Born, Parallel Computing 17 (1991)");

}  // namespace
}  // namespace coppice
