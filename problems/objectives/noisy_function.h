#pragma once

#include <optional>
#include <span>

#include "engine/vocabulary/objective.h"

namespace coppice {

/// A function that is known, with N(0, noise) added to each evaluation.
class NoisyFunction : public ObjectiveFunction {
 public:
  explicit NoisyFunction(double noise) : noise_(noise) {}

  double evaluate(std::span<const double> x, const Draws& draws) const final {
    return noise_ > 0 ? value(x) + draws.normal("noise", 0, noise_) : value(x);
  }
  bool noisy() const final { return noise_ > 0; }
  std::optional<double> true_value(std::span<const double> x) const final { return value(x); }

  /// The parameter of the families that make such functions.
  template <class T>
  static Parameters<T> with_noise(Parameters<T> parameters) {
    return parameters.add("noise", static_cast<double T::*>(&T::noise), "", "Deviation of an evaluation.",
                          at_least(0));
  }

 protected:
  virtual double value(std::span<const double> x) const = 0;

 private:
  double noise_;
};

}  // namespace coppice
