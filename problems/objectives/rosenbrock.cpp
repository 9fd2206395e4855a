#include "problems/objectives/placed_function.h"

namespace coppice {
namespace {

struct Rosenbrock : PlacedFamily {
  std::unique_ptr<const ObjectiveFunction> draw(const Draws& draws) const override {
    return placed(Frame::Axes::straight, draws, [](const auto& z) {
      double sum = 0;
      for (std::size_t i = 0; i + 1 < z.size(); ++i) {
        const double a = z[i] + 1, bend = z[i + 1] + 1 - a * a;
        sum += 100 * bend * bend + (a - 1) * (a - 1);
      }
      return sum;
    });
  }
  static Parameters<Rosenbrock> parameters() { return placed_parameters<Rosenbrock>(2); }
};

const Component<Objective, Rosenbrock> kRosenbrock(
    "rosenbrock", "Minus Rosenbrock's function: a bent valley to an optimum that is drawn.",
    "Rosenbrock, The Computer Journal 3(3) (1960); Hansen et al., INRIA RR-6829 (2009), f8 without its "
    "scale");

}  // namespace
}  // namespace coppice
