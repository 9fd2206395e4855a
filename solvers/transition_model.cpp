#include "solvers/transition_model.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

#include "solvers/for_rows.h"

namespace coppice {
namespace {

using Rows = std::vector<std::size_t>;
using Column = std::function<double(std::size_t row)>;

/// The way from one value of an axis to another; on a circle the shorter one.
double change(const Axis& axis, double from, double to) {
  const double turn = axis.high - axis.low;
  return axis.circular ? to - from - turn * std::round((to - from) / turn) : to - from;
}

double moved(const Axis& axis, double from, double by) {
  const double to = from + by;
  const double turn = axis.high - axis.low;
  return axis.circular ? to - turn * std::floor((to - axis.low) / turn) : to;
}

Matrix of_rows(const Rows& rows, const std::vector<Column>& columns) {
  Matrix matrix(rows.size(), columns.size());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    for (std::size_t i = 0; i < rows.size(); ++i) matrix(i, c) = columns[c](rows[i]);
  }
  return matrix;
}

struct Step {
  Vec<kMaxStateSize> next;
  double reward = 0;
  bool terminal = false;
};

class TransitionModel {
 public:
  TransitionModel(const Dataset& samples, const Approximator& approximator, const Draws& draws,
                  Parallel& parallel);
  /// `state_action`: the state's axes, then the action's.
  Step step(std::span<const double> state_action) const;

 private:
  const Space& states_;
  MadeFunction change_;       ///< of the state
  MadeFunction reward_;       ///< of steps that go on; empty: none does
  MadeFunction last_reward_;  ///< of steps that end; empty: none does
  MadeFunction end_;          ///< 1 for next states that end an episode, 0 for others; empty: all or none
};

TransitionModel::TransitionModel(const Dataset& samples, const Approximator& approximator, const Draws& draws,
                                 Parallel& parallel)
    : states_(samples.spaces.states) {
  std::vector<Column> state_action, changes, next;
  for (std::size_t c = 0; c < states_.size(); ++c) {
    state_action.push_back([&samples, c](std::size_t row) { return samples.states(row, c); });
    next.push_back([&samples, c](std::size_t row) { return samples.next(row, c); });
    changes.push_back([&samples, &axis = states_[c], c](std::size_t row) {
      return change(axis, samples.states(row, c), samples.next(row, c));
    });
  }
  for (std::size_t c = 0; c < samples.spaces.actions.front().axes.size(); ++c) {
    state_action.push_back([&samples, c](std::size_t row) { return samples.actions(row, c); });
  }
  const Column reward = [&samples](std::size_t row) { return samples.reward[row]; };
  const Column terminal = [&samples](std::size_t row) { return samples.terminal[row]; };

  Rows all, on, ended;
  for (std::size_t row = 0; row < samples.rows(); ++row) {
    all.push_back(row);
    (samples.terminal[row] != 0 ? ended : on).push_back(row);
  }
  const auto fit = [&](Purpose part, const Rows& rows, const std::vector<Column>& x,
                       const std::vector<Column>& y) {
    return approximator.fit({of_rows(rows, x), of_rows(rows, y), {}}, draws.fork(part), parallel);
  };
  change_ = fit("change", all, state_action, changes);
  if (!on.empty()) reward_ = fit("reward", on, state_action, {reward});
  if (!ended.empty()) last_reward_ = fit("last_reward", ended, state_action, {reward});
  if (!on.empty() && !ended.empty()) end_ = fit("end", all, next, {terminal});
}

Step TransitionModel::step(std::span<const double> state_action) const {
  Step step;
  step.next.resize(states_.size());
  change_->predict(state_action, step.next);
  for (std::size_t c = 0; c < states_.size(); ++c) {
    step.next[c] = moved(states_[c], state_action[c], step.next[c]);
  }
  double end = reward_ ? 0 : 1;
  if (end_) end_->predict(step.next, {&end, 1});
  step.terminal = end > 0.5;
  (step.terminal ? last_reward_ : reward_)->predict(state_action, {&step.reward, 1});
  return step;
}

void refuse_unlimited(const Space& axes) {
  for (const Axis& axis : axes) {
    if (std::isfinite(axis.low) && std::isfinite(axis.high)) continue;
    throw std::invalid_argument(
        fmt::format("model_samples are drawn between the limits of every axis; '{}' has none", axis.name));
  }
}

}  // namespace

Dataset model_transitions(const Dataset& samples, const Approximator& model, std::size_t count,
                          const Draws& draws, Parallel& parallel) {
  const Space& states = samples.spaces.states;
  const Space& actions = samples.spaces.actions.front().axes;
  refuse_unlimited(states);
  refuse_unlimited(actions);
  const TransitionModel fitted(samples, model, draws, parallel);
  Dataset made(samples.spaces, count);
  for_rows(count, parallel, [&](std::size_t row) {
    const Draws at = draws.scenario(row);
    Vec<kMaxStateSize + kMaxActionSize> state_action;
    state_action.resize(states.size() + actions.size());
    for (std::size_t c = 0; c < state_action.size(); ++c) {
      const Axis& axis = c < states.size() ? states[c] : actions[c - states.size()];
      state_action[c] = at.uniform("state_action", axis.low, axis.high, static_cast<std::uint32_t>(c));
      (c < states.size() ? made.states(row, c) : made.actions(row, c - states.size())) = state_action[c];
    }
    const Step step = fitted.step(state_action);
    made.episode[row] = static_cast<std::int64_t>(row);  // each is an episode of one step
    made.next.set_row(row, step.next);
    made.reward[row] = step.reward;
    made.terminal[row] = step.terminal ? 1 : 0;
  });
  return made;
}

}  // namespace coppice
