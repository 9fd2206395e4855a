#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/vocabulary/random.h"
#include "engine/vocabulary/space.h"
#include "registry/component.h"

namespace coppice {

/// A function to be made large by an optimizer, one of a family (its optimum and rotation drawn). Immutable,
/// thread-safe.
class ObjectiveFunction {
 public:
  virtual ~ObjectiveFunction() = default;
  virtual const Space& box() const = 0;  ///< sides may be infinite
  /// Where a search begins; empty: the box's centre.
  virtual std::vector<double> guess() const { return {}; }
  /// The larger the better. Evaluations with equal draws meet the same randomness. Does not allocate.
  virtual double evaluate(std::span<const double> x, const Draws& draws) const = 0;
  /// False when the draws play no part.
  virtual bool noisy() const = 0;
  /// The expectation of evaluate, where it is known.
  virtual std::optional<double> true_value(std::span<const double>) const { return std::nullopt; }
  /// The largest true value, where it is known.
  virtual std::optional<double> optimum() const { return std::nullopt; }
};

/// A family of test functions. Holds the parameters only.
class Objective {
 public:
  static constexpr const char* kInterface = "objective";
  virtual ~Objective() = default;
  /// Throws std::invalid_argument for parameters that make none.
  virtual std::unique_ptr<const ObjectiveFunction> draw(const Draws& draws) const = 0;
};

}  // namespace coppice
