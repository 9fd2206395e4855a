#pragma once

#include "engine/vocabulary/approximator.h"
#include "engine/vocabulary/policy.h"

namespace coppice {

/// The action is what a fitted function says in the state, moved into its box: all that a robot has to carry
/// after fitted policy forests (thesis, Algorithm 15).
class FittedPolicy : public Policy {
 public:
  static constexpr const char* kName = "fitted_policy";
  Sub<Function> function;  ///< state axes to action axes

  void prepare(const Spaces& spaces, const Simulator* model) override;
  void act(std::span<const double> state, std::span<double> memory, const Draws& draws,
           Action& action) const override;
  void save(Archive& archive) const override { function->save(archive); }
  void load(Archive& archive) override { function.object->load(archive); }
  std::vector<std::pair<std::string, double>> facts() const override { return function->facts(); }
  PolicyModel exported() const override { return {0, function->exported()}; }

  static Parameters<FittedPolicy> parameters();

 private:
  std::vector<ActionBox> actions_;
};

}  // namespace coppice
