#include "engine/vocabulary/model_problem.h"

#include <fmt/format.h>

#include <stdexcept>

namespace coppice::detail {
namespace {

/// "speed = nan": the first thing that is wrong.
std::string fault(const Spaces& spaces, std::span<const double> state, double reward) {
  if (state.size() != spaces.state_size()) {
    return fmt::format("the state has {} components instead of {}", state.size(), spaces.state_size());
  }
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (!std::isfinite(state[i])) return fmt::format("state '{}' is {}", spaces.states[i].name, state[i]);
  }
  return fmt::format("the reward is {}", reward);
}

}  // namespace

void check_spaces(const std::string& problem, const Spaces& spaces, std::size_t state_capacity) {
  try {
    spaces.check();
  } catch (const std::invalid_argument& wrong) {
    throw std::logic_error(fmt::format("problem <{}>: {}", problem, wrong.what()));
  }
  if (spaces.state_size() > state_capacity) {
    throw std::logic_error(fmt::format("problem <{}>: {} state axes do not fit into a state of capacity {}",
                                       problem, spaces.state_size(), state_capacity));
  }
}

void throw_bad_state(const std::string& problem, const Spaces& spaces, const Draws& draws,
                     std::span<const double> state, double reward) {
  throw std::runtime_error(fmt::format("problem <{}>, scenario {}, step {}: {}", problem, draws.scenario(),
                                       draws.step(), fault(spaces, state, reward)));
}

// Several chunks per thread even out rollouts of different lengths.
std::size_t chunk_count(std::size_t rollouts, std::size_t threads) {
  return threads <= 1 ? std::min<std::size_t>(rollouts, 1) : std::min(rollouts, 8 * threads);
}

}  // namespace coppice::detail
