#include "engine/cli/policy_measures.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace coppice::cli {
namespace {

using Clock = std::chrono::steady_clock;

double seconds(Clock::duration taken) {
  return std::chrono::duration<double>(taken).count();
}

/// The q-quantile of some values, which it puts into another order.
double quantile(std::vector<double>& values, double q) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// What it takes to read the clock twice.
double clock_time() {
  std::vector<double> times(1001);
  for (double& time : times) {
    const auto begin = Clock::now();
    time = seconds(Clock::now() - begin);
  }
  return quantile(times, 0.5);
}

/// A state that is uniform over the state space; `purpose` tells independent ones apart.
void draw_state(const Space& axes, const Draws& draws, Purpose purpose, std::span<double> state) {
  for (std::size_t k = 0; k < axes.size(); ++k) {
    state[k] = draws.uniform(purpose, axes[k].low, axes[k].high, static_cast<std::uint32_t>(k));
  }
}

/// Acts in states one by one, each the first of an episode.
class FreshActor {
 public:
  explicit FreshActor(const ReadyPolicy& ready) : ready_(ready), memory_(ready.policy->memory_size()) {}

  const Action& act(std::span<const double> state, const Draws& draws) {
    ready_.policy->reset(memory_);
    ready_.policy->act(state, memory_, draws, action_);
    return action_;
  }

 private:
  const ReadyPolicy& ready_;
  std::vector<double> memory_;
  Action action_;
};

/// Half the squared distance of two actions: its mean over independent pairs is their variance.
double half_square(const std::vector<ActionBox>& boxes, const Action& a, const Action& b) {
  if (a.id != b.id) return 0.5;
  double sum = 0;
  const Space& axes = boxes[static_cast<std::size_t>(a.id)].axes;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const double width = axes[i].high - axes[i].low;
    const double part = std::isfinite(width) && width > 0 ? (a.values[i] - b.values[i]) / width : 0.0;
    sum += 0.5 * part * part;
  }
  return sum;
}

bool bounded(const Space& axes) {
  return std::all_of(axes.begin(), axes.end(),
                     [](const Axis& axis) { return std::isfinite(axis.low) && std::isfinite(axis.high); });
}

}  // namespace

Latency measure_latency(const ReadyPolicy& ready) {
  constexpr std::size_t kStates = 256, kRounds = 41;
  const Draws draws(0, "latency", 0);
  const Space& axes = ready.spaces.states;
  std::vector<double> states(kStates * axes.size());
  const auto state = [&](std::size_t i) {
    return std::span<double>(states).subspan(i * axes.size(), axes.size());
  };
  for (std::size_t i = 0; i < kStates; ++i) draw_state(axes, draws.scenario(i), "state", state(i));
  const double clock = clock_time();
  std::vector<double> memory(ready.policy->memory_size());
  Action action;
  std::vector<std::vector<double>> times(kStates);
  for (std::size_t round = 0; round < kRounds; ++round) {
    ready.policy->reset(memory);
    for (std::size_t i = 0; i < kStates; ++i) {
      const Draws of_state = draws.scenario(i);
      const auto begin = Clock::now();
      ready.policy->act(state(i), memory, of_state, action);
      times[i].push_back(std::max(0.0, seconds(Clock::now() - begin) - clock));
    }
  }
  Latency latency;
  std::vector<double> all;
  for (std::vector<double>& of_state : times) {
    all.insert(all.end(), of_state.begin(), of_state.end());
    latency.worst_state = std::max(latency.worst_state, quantile(of_state, 0.5));
  }
  latency.p99 = quantile(all, 0.99);
  latency.median = quantile(all, 0.5);
  return latency;
}

std::vector<double> importance(const ReadyPolicy& ready) {
  constexpr std::size_t kPairs = 4096;
  const Space& axes = ready.spaces.states;
  if (!bounded(axes)) return {};
  const Draws draws(0, "importance", 0);
  FreshActor actor(ready);
  std::vector<double> state(axes.size()), other(axes.size());
  std::vector<double> lost(axes.size());
  double variance = 0;
  for (std::size_t i = 0; i < kPairs; ++i) {
    const Draws of_pair = draws.scenario(i);
    draw_state(axes, of_pair, "state", state);
    draw_state(axes, of_pair, "other", other);
    const Action here = actor.act(state, of_pair);
    variance += half_square(ready.spaces.actions, here, actor.act(other, of_pair));
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const double kept = state[k];
      state[k] = other[k];
      lost[k] += half_square(ready.spaces.actions, here, actor.act(state, of_pair));
      state[k] = kept;
    }
  }
  if (variance == 0) return {};
  for (double& part : lost) part /= variance;
  return lost;
}

}  // namespace coppice::cli
