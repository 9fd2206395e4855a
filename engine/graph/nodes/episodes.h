#pragma once

#include <chrono>

#include "engine/graph/node.h"
#include "engine/vocabulary/problem.h"

namespace coppice {

/// Says when a checkpoint is worth its cost: every five seconds, and rarer when saving takes long.
class CheckpointClock {
 public:
  bool due() const { return Clock::now() - last_ > pause_; }
  void save(NodeContext& context, const Archive& archive);

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
  Clock::duration pause_ = std::chrono::seconds(5);
};

/// Runs the scenarios 0, 1, ... of a simulation in batches, so that a node can show progress and stop in
/// between. Batches follow the clock; results do not depend on them.
class EpisodeRun {
 public:
  /// `simulation.rollouts` episodes in all. With `resumable` it goes on from the context's checkpoint; a
  /// recorder then hears the later episodes only.
  EpisodeRun(const Problem& problem, const Simulation& simulation, NodeContext& context, bool resumable);

  /// Runs at most so many further episodes.
  void advance(std::size_t episodes, Parallel& parallel, Recorder* recorder);
  /// Runs the rest. Throws Interrupted when the run should stop.
  void finish();

  const Returns& returns() const { return returns_; }  ///< of the episodes run so far
  std::size_t done() const { return returns_.total.size(); }

 private:
  void restore(Archive archive);
  Archive state() const;

  const Problem& problem_;
  const Simulation simulation_;
  NodeContext& context_;
  const bool resumable_;
  Returns returns_;
};

/// Throws std::invalid_argument when the policy was made with the draws of the node that judges it.
void require_other_draws(const InputNode& policy, const NodeContext& judge);

}  // namespace coppice
