#include "solvers/policies/fitted_policy.h"

#include <fmt/format.h>

#include <stdexcept>

namespace coppice {

void FittedPolicy::prepare(const Spaces& spaces, const Simulator*) {
  if (spaces.actions.size() != 1) {
    throw std::invalid_argument(fmt::format(
        "<fitted_policy> chooses the parameters of one action; the problem has {}", spaces.actions.size()));
  }
  const std::size_t states = spaces.state_size(), axes = spaces.actions.front().axes.size();
  if (function->inputs() != states || function->outputs() != axes) {
    throw std::invalid_argument(
        fmt::format("<fitted_policy>: its function leads from {} to {} numbers; the problem's "
                    "state has {} and its action {}",
                    function->inputs(), function->outputs(), states, axes));
  }
  actions_ = spaces.actions;
}

void FittedPolicy::act(std::span<const double> state, std::span<double>, const Draws&, Action& action) const {
  action.id = 0;
  action.values.resize(actions_.front().axes.size());
  function->predict(state, action.values);
  clamp_in_place(action, actions_);
}

Parameters<FittedPolicy> FittedPolicy::parameters() {
  return Parameters<FittedPolicy>().component("function", &FittedPolicy::function,
                                              "The action parameters in each state.", true);
}

namespace {
const Component<Policy, FittedPolicy> kFittedPolicy(FittedPolicy::kName,
                                                    "The action that a fitted function says.",
                                                    "L. Hofer's thesis (2017), Algorithm 15");
}  // namespace

}  // namespace coppice
