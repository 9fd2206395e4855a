#include <numbers>

#include "engine/vocabulary/elementary.h"
#include "engine/vocabulary/objective.h"

namespace coppice {
namespace {

/// Minus Branin's function, with three equal optima, and noise.
class BraninFunction : public ObjectiveFunction {
 public:
  explicit BraninFunction(double noise) : noise_(noise) {}

  const Space& box() const override { return box_; }
  double evaluate(std::span<const double> x, const Draws& draws) const override {
    return value(x) + (noisy() ? draws.normal("noise", 0, noise_) : 0);
  }
  bool noisy() const override { return noise_ > 0; }
  std::optional<double> true_value(std::span<const double> x) const override { return value(x); }
  /// At (pi, 2.275) cosine is -1 and the square 0: 10 - 10 (1 - 1 / (8 pi)).
  std::optional<double> optimum() const override { return -10 / (8 * std::numbers::pi); }

 private:
  static double value(std::span<const double> x) {
    constexpr double kPi = std::numbers::pi;
    const double t = x[1] - 5.1 / (4 * kPi * kPi) * x[0] * x[0] + 5 / kPi * x[0] - 6;
    return -(t * t + 10 * (1 - 1 / (8 * kPi)) * elementary::cos(x[0]) + 10);
  }
  double noise_;
  Space box_{{"x0", "", -5, 10}, {"x1", "", 0, 15}};
};

struct Branin : Objective {
  double noise = 0;
  std::unique_ptr<const ObjectiveFunction> draw(const Draws&) const override {
    return std::make_unique<BraninFunction>(noise);
  }
  static Parameters<Branin> parameters() {
    return Parameters<Branin>().add("noise", &Branin::noise, "", "Deviation of an evaluation.", at_least(0));
  }
};

const Component<Objective, Branin> kComponent("branin",
                                              "Minus Branin's function of two inputs: three equal optima.",
                                              "Dixon and Szego, Towards Global Optimization 2 (1978)");

}  // namespace
}  // namespace coppice
