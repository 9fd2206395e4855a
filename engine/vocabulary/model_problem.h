#pragma once

// The template bodies of engine/vocabulary/problem.h: how a plain struct becomes a Problem.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/vocabulary/problem.h"

namespace coppice {

namespace detail {
/// Throws std::logic_error naming the problem when a model declares unusable spaces.
void check_spaces(const std::string& problem, const Spaces& spaces, std::size_t state_capacity);
/// Throws std::runtime_error naming the problem, the scenario, the step, and what is not finite or of the
/// wrong size.
[[noreturn]] void throw_bad_state(const std::string& problem, const Spaces& spaces, const Draws& draws,
                                  std::span<const double> state, double reward);
/// In how many pieces rollouts are handed to threads; changes no result.
std::size_t chunk_count(std::size_t rollouts, std::size_t threads);
}  // namespace detail

template <Model M>
class ModelProblem final : public Problem, public Simulator {
 public:
  ModelProblem(M model, std::string name)
      : model_(std::move(model)), name_(std::move(name)), spaces_{model_.states(), model_.actions()} {
    detail::check_spaces(name_, spaces_, State::kCapacity);
  }

  const Spaces& spaces() const override { return spaces_; }
  const Simulator* simulator() const override { return this; }
  double discount() const override {
    if constexpr (requires {
                    { model_.discount() } -> std::convertible_to<double>;
                  })
      return model_.discount();
    else if constexpr (requires {
                         { model_.discount } -> std::convertible_to<double>;
                       })
      return model_.discount;
    else
      return 1.0;
  }
  int horizon() const override {
    if constexpr (requires {
                    { model_.horizon() } -> std::convertible_to<int>;
                  })
      return model_.horizon();
    else if constexpr (requires {
                         { model_.horizon } -> std::convertible_to<int>;
                       })
      return model_.horizon;
    else
      return 100;
  }

  void start(const Draws& draws, std::span<double> state) const override {
    const State first = first_state(draws);
    std::copy(first.begin(), first.end(), state.begin());
  }
  void step(std::span<const double> state, const Action& action, const Draws& draws, std::span<double> next,
            double& reward, bool& terminal) const override {
    const Transition<State> made = transition(State(state), clamp(action, spaces_.actions), draws);
    std::copy(made.next.begin(), made.next.end(), next.begin());
    reward = made.reward;
    terminal = made.terminal;
  }
  Returns simulate(const Simulation& simulation, const Draws& draws, Parallel& parallel) const override;
  Returns episodes(const Simulation& simulation, const Draws& draws, Parallel& parallel) const override {
    if (simulation.starts != nullptr || !simulation.first_actions.empty()) {
      throw std::invalid_argument(
          "episodes begin where the problem starts: no start states, no first actions");
    }
    return simulate(simulation, draws, parallel);
  }

 private:
  using State = typename M::State;

  /// What one thread needs for its rollouts, allocated once.
  struct Buffers {
    Action action;
    std::vector<double> memory;
    Episode episode;
  };

  /// Starts draw from a family of their own: a model may use a purpose both in start and in step.
  State first_state(const Draws& draws) const {
    const State state = model_.start(draws.fork("start"));
    check(state, 0, draws);
    return state;
  }
  Transition<State> transition(const State& state, const Action& action, const Draws& draws) const {
    const Transition<State> made = model_.step(state, ActionRef{action.id, action.values}, draws);
    check(made.next, made.reward, draws);
    return made;
  }
  void check(const State& state, double reward, const Draws& draws) const {
    bool good = state.size() == spaces_.state_size() && std::isfinite(reward);
    for (double x : state) good = good && std::isfinite(x);
    if (!good) detail::throw_bad_state(name_, spaces_, draws, state, reward);
  }
  State start_of(const Simulation& simulation, std::size_t rollout, const Draws& draws) const {
    if (simulation.starts == nullptr) return first_state(draws);
    State state;
    state.resize(simulation.starts->columns());
    simulation.starts->row(rollout, state);
    check(state, 0, draws);
    return state;
  }
  static double value_of(const State& state, const Simulation& simulation) {
    double value = 0;
    simulation.terminal_value->predict(state, {&value, 1});
    return value;
  }
  void roll(const Simulation&, std::size_t rollout, const Draws&, Buffers&, Returns&) const;

  M model_;
  std::string name_;
  Spaces spaces_;
};

template <Model M>
Returns ModelProblem<M>::simulate(const Simulation& simulation, const Draws& draws,
                                  Parallel& parallel) const {
  simulation.check(spaces_);
  Returns returns(simulation.rollouts);
  const std::size_t chunks = detail::chunk_count(simulation.rollouts, parallel.width());
  parallel.for_each(chunks, [&](std::size_t chunk) {
    Buffers buffers;
    if (simulation.policy != nullptr) buffers.memory.resize(simulation.policy->memory_size());
    const std::size_t end = simulation.rollouts * (chunk + 1) / chunks;
    for (std::size_t i = simulation.rollouts * chunk / chunks; i < end; ++i) {
      roll(simulation, i, draws, buffers, returns);
    }
  });
  return returns;
}

template <Model M>
void ModelProblem<M>::roll(const Simulation& simulation, std::size_t rollout, const Draws& draws,
                           Buffers& buffers, Returns& returns) const {
  const Draws world = draws.scenario(simulation.scenario(rollout));
  const Draws agent = draws.fork("policy").scenario(world.scenario());
  const bool recorded = simulation.recorder != nullptr;
  State state = start_of(simulation, rollout, world);
  if (simulation.policy != nullptr) simulation.policy->reset(buffers.memory);
  if (recorded) buffers.episode.begin(state);

  double total = 0, discounted = 0, weight = 1;
  bool terminal = false;
  int t = 0;
  for (; t < simulation.horizon && !terminal; ++t) {
    const auto step = static_cast<std::uint32_t>(t);
    if (t == 0 && !simulation.first_actions.empty()) {
      buffers.action = simulation.first_actions[rollout];
    } else {
      simulation.policy->act(state, buffers.memory, agent.step(step), buffers.action);
    }
    clamp_in_place(buffers.action, spaces_.actions);
    const Transition<State> made = transition(state, buffers.action, world.step(step));
    total += made.reward;
    discounted += weight * made.reward;
    weight *= simulation.discount;
    terminal = made.terminal;
    state = made.next;
    if (recorded) buffers.episode.add(buffers.action, made.reward, state);
  }
  if (!terminal && simulation.terminal_value != nullptr) discounted += weight * value_of(state, simulation);
  if (recorded) {
    buffers.episode.terminal = terminal;
    simulation.recorder->episode(rollout, world.scenario(), buffers.episode);
  }
  returns.total[rollout] = total;
  returns.discounted[rollout] = discounted;
  returns.steps[rollout] = t;
  returns.terminal[rollout] = terminal;
}

}  // namespace coppice
