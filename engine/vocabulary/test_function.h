#pragma once

#include <span>

#include "engine/vocabulary/space.h"
#include "registry/component.h"

namespace coppice {

/// A known function of a box, whose samples supervised learning is tried on. Immutable.
class TestFunction {
 public:
  static constexpr const char* kInterface = "test_function";
  virtual ~TestFunction() = default;

  /// Its inputs, with limits: where it is sampled.
  virtual Space inputs() const = 0;
  /// x has inputs().size() items.
  virtual double value(std::span<const double> x) const = 0;
};

}  // namespace coppice
