#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/vocabulary/approximator.h"
#include "engine/vocabulary/dataset.h"
#include "engine/vocabulary/parallel.h"
#include "engine/vocabulary/policy.h"
#include "engine/vocabulary/random.h"

namespace coppice {

/// One episode as it is recorded: actions[t] was taken in states row t and led to states row t + 1.
struct Episode {
  std::vector<double> states;  ///< (steps + 1) x state_size, step after step
  std::vector<Action> actions;
  std::vector<double> rewards;
  bool terminal = false;  ///< ended in a terminal state (else cut at the horizon)

  void begin(std::span<const double> state);  ///< empties it and sets the start state
  void add(const Action& action, double reward, std::span<const double> next);
};

/// Receives episodes. Called from several threads, in any order, once for each rollout.
class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual void episode(std::size_t rollout, std::uint64_t scenario, const Episode& episode) = 0;
};

/// What to simulate. Rollout i runs on scenario scenarios[i], or first_scenario + i; it starts in row i of
/// `starts`, or where the problem starts in that scenario.
struct Simulation {
  const Policy* policy = nullptr;
  std::size_t rollouts = 0;
  int horizon = 0;        ///< steps at most
  double discount = 1.0;  ///< in [0, 1]
  std::uint64_t first_scenario = 0;
  std::span<const std::uint64_t> scenarios;  ///< empty, or one for each rollout
  const Matrix* starts = nullptr;            ///< null, or rollouts x state_size
  std::span<const Action> first_actions;     ///< empty, or the action of step 0 of each rollout
  const Function* terminal_value = nullptr;  ///< value of the state where the horizon cut; null: 0
  Recorder* recorder = nullptr;

  std::uint64_t scenario(std::size_t rollout) const {
    return scenarios.empty() ? first_scenario + rollout : scenarios[rollout];
  }
  /// Throws std::invalid_argument naming what does not fit (sizes, discount, horizon, ...).
  void check(const Spaces& spaces) const;
};

/// What came out, by rollout.
struct Returns {
  std::vector<double> total;       ///< sum of rewards (undiscounted; without the terminal value)
  std::vector<double> discounted;  ///< sum of discount^t reward_t, plus discount^T terminal value when cut
  std::vector<std::int32_t> steps;
  std::vector<std::uint8_t> terminal;

  Returns() = default;
  explicit Returns(std::size_t rollouts)
      : total(rollouts), discounted(rollouts), steps(rollouts), terminal(rollouts) {}
};

/// Keeps every episode and makes a dataset of them, in order of rollouts whatever the order of calls.
class DatasetRecorder : public Recorder {
 public:
  DatasetRecorder(Spaces spaces, std::size_t rollouts);
  void episode(std::size_t rollout, std::uint64_t scenario, const Episode& episode) override;
  Dataset dataset() const;

 private:
  Spaces spaces_;
  std::vector<Episode> episodes_;
};

}  // namespace coppice
