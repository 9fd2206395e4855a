#include <fmt/format.h>

#include <stdexcept>

#include "engine/vocabulary/policy.h"

namespace coppice {
namespace {

/// Linear state feedback, as the linear-quadratic regulator's: u = offset - K s, moved into the action's box.
/// With the minus sign of the textbooks, positive gains pull towards the origin.
class LinearFeedback : public Policy {
 public:
  int action = 0;
  std::vector<double> gains;
  std::vector<double> offset;

  void prepare(const Spaces& spaces, const Simulator*) override {
    if (static_cast<std::size_t>(action) >= spaces.actions.size()) {
      throw std::invalid_argument(
          fmt::format("<linear_feedback>: action is {}, but the problem has the actions 0 to {}", action,
                      spaces.actions.size() - 1));
    }
    actions_ = spaces.actions;
    const std::size_t states = spaces.state_size();
    const std::size_t axes = actions_[static_cast<std::size_t>(action)].axes.size();
    if (gains.size() != axes * states) {
      throw std::invalid_argument(
          fmt::format("<linear_feedback>: gains has {} numbers, expected are {} x {} = {}: a row of {} for "
                      "each action parameter",
                      gains.size(), axes, states, axes * states, states));
    }
    if (!offset.empty() && offset.size() != axes) {
      throw std::invalid_argument(fmt::format(
          "<linear_feedback>: offset has {} numbers, expected is one for each of the {} action parameters",
          offset.size(), axes));
    }
    offset_ = offset.empty() ? std::vector<double>(axes, 0.0) : offset;
    for (double& value : offset_) value += 0.0;  // makes 0 of -0: u - f and u + -f are then equal to the bit
  }

  void act(std::span<const double> state, std::span<double>, const Draws&, Action& chosen) const override {
    chosen.id = action;
    chosen.values.resize(offset_.size());
    for (std::size_t a = 0; a < offset_.size(); ++a) {
      double feedback = 0;
      for (std::size_t s = 0; s < state.size(); ++s) feedback += gains[a * state.size() + s] * state[s];
      chosen.values[a] = offset_[a] - feedback;
    }
    clamp_in_place(chosen, actions_);
  }

  PolicyModel exported() const override {
    LinearModel linear{.slopes = gains, .bias = offset_, .bias_last = true};
    for (double& slope : linear.slopes) slope = -slope;
    return {action, std::move(linear)};
  }

  static Parameters<LinearFeedback> parameters() {
    return Parameters<LinearFeedback>()
        .add("action", &LinearFeedback::action, "", "Which action, counted from 0.", at_least(0))
        .require("gains", &LinearFeedback::gains, "",
                 "K of u = offset - K s: for each action parameter a row of one gain for each state axis.")
        .add("offset", &LinearFeedback::offset, "", "One for each action parameter; empty: 0.");
  }

 private:
  std::vector<ActionBox> actions_;
  std::vector<double> offset_;  ///< one for each action parameter
};

const Component<Policy, LinearFeedback> kLinearFeedback(
    "linear_feedback", "Linear state feedback u = offset - K s, moved into its box.", "no publication");

}  // namespace
}  // namespace coppice
