#pragma once

#include <optional>
#include <vector>

#include "engine/statistics/shares.h"
#include "reports/cells.h"
#include "reports/metric.h"

namespace coppice {

/// The evaluations of one training run, or one independent repetition of what was not learned.
struct Run {
  std::optional<int> replicate;          ///< of the first of its evaluations
  double mean = 0;                       ///< of its evaluations' means
  std::vector<std::size_t> evaluations;  ///< which of the nodes
};

/// What was drawn independently. Of a learned policy that is the training run, also when there is only one;
/// evaluating it several times makes no more of them. Of others it is the replicate, and without replicates
/// the episode.
struct Units {
  std::vector<Run> runs;  ///< by their first appearance; without replicates one, if nothing was learned
  bool are_runs = false;  ///< false: the unit is the episode
  bool learned = false;   ///< false: runs are repetitions of what does not differ
  Observation last;       ///< of the last evaluation
};

/// `nodes` are evaluations.
Units units_of(const std::vector<InputNode>& nodes, const TableCell& cell, Metric metric);

std::vector<double> means_of(const Units& units);  ///< of the runs
/// For a metric that is a share: over training runs; of what was not learned, over the episodes of all
/// repetitions together.
ShareEstimate share_of(const Units& units);

}  // namespace coppice
