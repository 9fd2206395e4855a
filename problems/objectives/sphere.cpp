#include "problems/objectives/placed_function.h"

namespace coppice {
namespace {

struct Sphere : PlacedFamily {
  std::unique_ptr<const ObjectiveFunction> draw(const Draws& draws) const override {
    return placed(Frame::Axes::straight, draws, [](const auto& z) {
      double sum = 0;
      for (std::size_t i = 0; i < z.size(); ++i) sum += z[i] * z[i];
      return sum;
    });
  }
  static Parameters<Sphere> parameters() { return placed_parameters<Sphere>(); }
};

const Component<Objective, Sphere> kSphere("sphere",
                                           "Minus the squared distance from an optimum that is drawn.",
                                           "Hansen et al., INRIA RR-6829 (2009), f1");

}  // namespace
}  // namespace coppice
