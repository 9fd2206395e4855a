#include "solvers/policies/greedy_policy.h"

#include <fmt/format.h>

#include <stdexcept>

namespace coppice {

void GreedyPolicy::prepare(const Spaces& spaces, const Simulator*) {
  if (spaces.actions.size() != 1) {
    throw std::invalid_argument(fmt::format(
        "<greedy_policy> chooses the parameters of one action; the problem has {}", spaces.actions.size()));
  }
  const std::size_t expected = spaces.state_size() + spaces.actions.front().axes.size();
  if (function->inputs() != expected) {
    throw std::invalid_argument(
        fmt::format("<greedy_policy>: its value function has {} inputs; the problem's state "
                    "and action have {}",
                    function->inputs(), expected));
  }
  actions_ = spaces.actions;
}

void GreedyPolicy::act(std::span<const double> state, std::span<double>, const Draws&, Action& action) const {
  action.id = 0;
  action.values = function->maximize(state, actions_.front().axes, {maximization, max_leaves}).at;
  clamp_in_place(action, actions_);
}

PolicyModel GreedyPolicy::exported() const {
  throw std::invalid_argument(
      "searches its value function for the best action in every state; learn with <fpf>, which fits a forest "
      "to those actions");
}

Parameters<GreedyPolicy> GreedyPolicy::parameters() {
  Parameters<GreedyPolicy> parameters;
  parameters.component("function", &GreedyPolicy::function, "Value of each state and action.", true);
  return declare_maximization(parameters);
}

namespace {
const Component<Policy, GreedyPolicy> kGreedyPolicy(
    GreedyPolicy::kName, "The action of the largest value under a learned function.",
    "L. Hofer's thesis (2017), Eq. 2.10", 2);
}  // namespace

}  // namespace coppice
