#include "problems/objectives/placed_function.h"

namespace coppice {
namespace {

template <Frame::Axes axes>
struct Ellipsoid : PlacedFamily {
  double condition = 1e6;

  std::unique_ptr<const ObjectiveFunction> draw(const Draws& draws) const override {
    return placed(axes, draws, [weights = ellipsoid_weights(size(), condition)](const auto& z) {
      double sum = 0;
      for (std::size_t i = 0; i < z.size(); ++i) {
        const double t = z[i];
        sum += weights[i] * t * t;
      }
      return sum;
    });
  }
  static Parameters<Ellipsoid> parameters() {
    return placed_parameters<Ellipsoid>().add("condition", &Ellipsoid::condition, "",
                                              "Ratio of the largest curvature to the least.", at_least(1));
  }
};

const Component<Objective, Ellipsoid<Frame::Axes::straight>> kStraight(
    "ellipsoid", "Minus a sum of weighted squares about an optimum that is drawn.",
    "Hansen et al., INRIA RR-6829 (2009), f2 without its oscillation");
const Component<Objective, Ellipsoid<Frame::Axes::turned>> kTurned(
    "rotated_ellipsoid", "Minus a sum of weighted squares in coordinates that are turned at random.",
    "Hansen et al., INRIA RR-6829 (2009), f10 without its oscillation");

}  // namespace
}  // namespace coppice
