#include "engine/vocabulary/rollout.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace coppice {
namespace {

void require(bool holds, std::string_view what) {
  if (!holds) throw std::invalid_argument(fmt::format("simulation: {}", what));
}

}  // namespace

void Episode::begin(std::span<const double> state) {
  states.assign(state.begin(), state.end());
  actions.clear();
  rewards.clear();
  terminal = false;
}

void Episode::add(const Action& action, double reward, std::span<const double> next) {
  states.insert(states.end(), next.begin(), next.end());
  actions.push_back(action);
  rewards.push_back(reward);
}

void Simulation::check(const Spaces& spaces) const {
  require(horizon >= 0, fmt::format("the horizon is {}, it must be at least 0", horizon));
  require(discount >= 0 && discount <= 1, fmt::format("the discount is {}, it must be in [0, 1]", discount));
  require(scenarios.empty() || scenarios.size() == rollouts,
          fmt::format("{} scenarios are given for {} rollouts", scenarios.size(), rollouts));
  require(first_actions.empty() || first_actions.size() == rollouts,
          fmt::format("{} first actions are given for {} rollouts", first_actions.size(), rollouts));
  require(policy != nullptr || horizon == 0 || (horizon == 1 && (rollouts == 0 || !first_actions.empty())),
          "a policy is needed");
  if (starts != nullptr) {
    require(starts->rows() == rollouts && starts->columns() == spaces.state_size(),
            fmt::format("the start states are a {} x {} table, {} x {} is expected", starts->rows(),
                        starts->columns(), rollouts, spaces.state_size()));
  }
  if (terminal_value != nullptr) {
    require(terminal_value->inputs() == spaces.state_size() && terminal_value->outputs() == 1,
            fmt::format("the terminal value maps {} inputs to {} outputs, {} to 1 is expected",
                        terminal_value->inputs(), terminal_value->outputs(), spaces.state_size()));
  }
}

DatasetRecorder::DatasetRecorder(Spaces spaces, std::size_t rollouts)
    : spaces_(std::move(spaces)), episodes_(rollouts) {}

// Each rollout has its own place: calls from several threads do not meet.
void DatasetRecorder::episode(std::size_t rollout, std::uint64_t, const Episode& episode) {
  episodes_.at(rollout) = episode;
}

Dataset DatasetRecorder::dataset() const {
  std::size_t rows = 0;
  for (const Episode& episode : episodes_) rows += episode.actions.size();
  const std::size_t states = spaces_.state_size();
  Dataset dataset(spaces_, rows);
  std::size_t row = 0;
  for (std::size_t e = 0; e < episodes_.size(); ++e) {
    const Episode& episode = episodes_[e];
    for (std::size_t t = 0; t < episode.actions.size(); ++t, ++row) {
      const std::span<const double> pair(episode.states.data() + t * states, 2 * states);
      dataset.episode[row] = static_cast<std::int64_t>(e);
      dataset.step[row] = static_cast<std::int64_t>(t);
      dataset.states.set_row(row, pair.first(states));
      dataset.next.set_row(row, pair.last(states));
      dataset.set_action(row, episode.actions[t]);
      dataset.reward[row] = episode.rewards[t];
      dataset.terminal[row] = episode.terminal && t + 1 == episode.actions.size();
    }
  }
  return dataset;
}

}  // namespace coppice
