#include <numbers>

#include "engine/vocabulary/elementary.h"
#include "problems/objectives/noisy_function.h"

namespace coppice {
namespace {

/// Minus Branin's function, with three equal optima, and noise.
class BraninFunction : public NoisyFunction {
 public:
  using NoisyFunction::NoisyFunction;

  const Space& box() const override { return box_; }
  /// At (pi, 2.275) cosine is -1 and the square 0: 10 - 10 (1 - 1 / (8 pi)).
  std::optional<double> optimum() const override { return -10 / (8 * std::numbers::pi); }

 protected:
  double value(std::span<const double> x) const override {
    constexpr double kPi = std::numbers::pi;
    const double t = x[1] - 5.1 / (4 * kPi * kPi) * x[0] * x[0] + 5 / kPi * x[0] - 6;
    return -(t * t + 10 * (1 - 1 / (8 * kPi)) * elementary::cos(x[0]) + 10);
  }

 private:
  Space box_{{"x0", "", -5, 10}, {"x1", "", 0, 15}};
};

struct Branin : Objective {
  double noise = 0;
  std::unique_ptr<const ObjectiveFunction> draw(const Draws&) const override {
    return std::make_unique<BraninFunction>(noise);
  }
  static Parameters<Branin> parameters() { return NoisyFunction::with_noise(Parameters<Branin>()); }
};

const Component<Objective, Branin> kBranin("branin",
                                           "Minus Branin's function of two inputs: three equal optima.",
                                           "Dixon and Szego, Towards Global Optimization 2 (1978)");

}  // namespace
}  // namespace coppice
