#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "engine/vocabulary/policy.h"

namespace coppice {
namespace {

/// Explores: any action is as likely as any other, and so are its parameters within their box.
class RandomPolicy : public Policy {
 public:
  void prepare(const Spaces& spaces, const Simulator*) override {
    for (const ActionBox& box : spaces.actions) {
      for (const Axis& axis : box.axes) {
        if (std::isfinite(axis.low) && std::isfinite(axis.high)) continue;
        throw std::invalid_argument(
            fmt::format("<random>: '{}' of action '{}' has no limits", axis.name, box.name));
      }
    }
    actions_ = spaces.actions;
  }

  void act(std::span<const double>, std::span<double>, const Draws& draws, Action& action) const override {
    action.id = static_cast<int>(draws.below("action", actions_.size()));
    const Space& axes = actions_[static_cast<std::size_t>(action.id)].axes;
    action.values.resize(axes.size());
    for (std::size_t i = 0; i < axes.size(); ++i) {
      action.values[i] = draws.uniform("parameter", axes[i].low, axes[i].high, static_cast<std::uint32_t>(i));
    }
  }

  PolicyModel exported() const override { throw std::invalid_argument("draws its actions at random"); }

  static Parameters<RandomPolicy> parameters() { return {}; }

 private:
  std::vector<ActionBox> actions_;
};

const Component<Policy, RandomPolicy> kRandomPolicy(
    "random", "Act at random: uniform over the actions, then over the box.", "no publication");

}  // namespace
}  // namespace coppice
