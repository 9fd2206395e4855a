#pragma once

#include <memory>

#include "engine/graph/nodes/search_target.h"
#include "engine/vocabulary/objective.h"

namespace coppice {

/// A test function, drawn for this search.
class ObjectiveTarget : public SearchTarget {
 public:
  /// Throws std::invalid_argument for a family that makes none.
  ObjectiveTarget(const Objective& family, const Draws& draws)
      : function_(family.draw(draws.fork("objective"))), draws_(draws.fork("evaluations")) {}

  const Space& box() const override { return function_->box(); }
  std::vector<double> guess() const override { return function_->guess(); }
  bool noisy() const override { return function_->noisy(); }
  /// Noise that is added would cancel in every comparison.
  bool has_scenarios() const override { return false; }
  double value(std::span<const double> x, std::uint64_t scenario, Parallel&) const override {
    return function_->evaluate(x, draws_.scenario(scenario));
  }
  std::optional<double> true_value(std::span<const double> x) const override {
    return function_->true_value(x);
  }
  std::optional<double> optimum() const override { return function_->optimum(); }

 private:
  const std::unique_ptr<const ObjectiveFunction> function_;
  const Draws draws_;
};

}  // namespace coppice
