#include <cmath>

#include "problems/objectives/placed_function.h"

namespace coppice {
namespace {

/// To whole numbers outside of [-1/2, 1/2], to tenths inside (f7's rounding).
double rounded(double z) {
  return std::fabs(z) > 0.5 ? std::floor(0.5 + z) : std::floor(0.5 + 10 * z) / 10;
}

struct Step : PlacedFamily {
  double condition = 100;

  std::unique_ptr<const ObjectiveFunction> draw(const Draws& draws) const override {
    return placed(Frame::Axes::turned, draws,
                  [weights = ellipsoid_weights(size(), condition)](const auto& z) {
                    double sum = 0;
                    for (std::size_t i = 0; i < z.size(); ++i) {
                      const double t = rounded(z[i]);
                      sum += weights[i] * t * t;
                    }
                    return sum;
                  });
  }
  static Parameters<Step> parameters() {
    return placed_parameters<Step>().add("condition", &Step::condition, "",
                                         "Ratio of the largest weight of a square to the least.",
                                         at_least(1));
  }
};

const Component<Objective, Step> kStep(
    "step",
    "Minus an ellipsoid of steps, turned at random: constant but for jumps, 0 in a cube about its optimum.",
    "Hansen et al., INRIA RR-6829 (2009), f7 without its scale, slope and penalty");

}  // namespace
}  // namespace coppice
