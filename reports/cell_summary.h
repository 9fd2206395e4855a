#pragma once

#include <string>
#include <vector>

#include "reports/cells.h"
#include "reports/metric.h"

namespace coppice {

/// What a cell shows. The unit of replication is the training run; only without replicates it is the episode.
struct CellSummary {
  std::vector<double> replicates;  ///< the mean of each evaluation
  std::int64_t episodes = 0;       ///< of each of them
  Estimate estimate;
  std::optional<Interval> iqm_ci95;
  std::string caution;
};

/// `nodes` are evaluations.
CellSummary summarize(const std::vector<InputNode>& nodes, const TableCell& cell, Metric metric);

}  // namespace coppice
