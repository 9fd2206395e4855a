#pragma once

#include <string>
#include <vector>

#include "reports/cells.h"
#include "reports/metric.h"

namespace coppice {

/// What a cell shows; what its intervals are over, see Units.
struct CellSummary {
  std::vector<double> replicates;  ///< the mean of each run
  std::int64_t episodes = 0;       ///< of each evaluation
  Estimate estimate;
  std::optional<Interval> iqm_ci95;
  std::string caution;
};

/// How the interval of a mean is made: Student's, wider where values are skewed, or the studentized bootstrap
/// over units, and over the episodes of each run where they were kept.
enum class IntervalMethod { t, bootstrap };

/// `nodes` are evaluations; `better` as estimate has it.
CellSummary summarize(const std::vector<InputNode>& nodes, const TableCell& cell, Metric metric,
                      std::optional<Better> better = {}, IntervalMethod method = IntervalMethod::t);

}  // namespace coppice
