#include <fmt/format.h>

#include <stdexcept>

#include "engine/vocabulary/policy.h"

namespace coppice {
namespace {

/// Always the same action.
class ConstantPolicy : public Policy {
 public:
  int action = 0;
  std::vector<double> values;

  void prepare(const Spaces& spaces, const Simulator*) override {
    if (static_cast<std::size_t>(action) >= spaces.actions.size()) {
      throw std::invalid_argument(
          fmt::format("<constant>: action is {}, but the problem has the actions 0 to {}", action,
                      spaces.actions.size() - 1));
    }
    const ActionBox& box = spaces.actions[static_cast<std::size_t>(action)];
    action_.id = action;
    action_.values.resize(box.axes.size());  // zeros
    if (!values.empty()) {
      if (values.size() != box.axes.size()) {
        throw std::invalid_argument(
            fmt::format("<constant>: values has {} numbers, but action '{}' has {} parameters", values.size(),
                        box.name, box.axes.size()));
      }
      action_.values = Vec<kMaxActionSize>(std::span<const double>(values));
    }
    clamp_in_place(action_, spaces.actions);
  }

  void act(std::span<const double>, std::span<double>, const Draws&, Action& chosen) const override {
    chosen = action_;
  }

  PolicyModel exported() const override {
    return {action_.id, ConstantModel{{action_.values.begin(), action_.values.end()}}};
  }

  static Parameters<ConstantPolicy> parameters() {
    return Parameters<ConstantPolicy>()
        .add("action", &ConstantPolicy::action, "", "Which action, counted from 0.", at_least(0))
        .add("values", &ConstantPolicy::values, "",
             "The action's parameters, moved into their box; empty: 0 for each.");
  }

 private:
  Action action_;
};

const Component<Policy, ConstantPolicy> kConstantPolicy("constant", "Always take the same action.",
                                                        "no publication");

}  // namespace
}  // namespace coppice
