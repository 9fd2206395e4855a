#include "reports/cell_summary.h"

#include "engine/statistics/bootstrap.h"
#include "engine/statistics/cautions.h"
#include "reports/units.h"

namespace coppice {

CellSummary summarize(const std::vector<InputNode>& nodes, const TableCell& cell, Metric metric) {
  CellSummary summary;
  const Units units = units_of(nodes, cell, metric);
  const Observation& last = units.last;
  for (const Run& run : units.runs) summary.replicates.push_back(run.mean);
  const std::vector<double>& means = summary.replicates;
  summary.episodes = last.episodes;
  summary.estimate = estimate(means, better(metric));
  if (units.are_runs) {
    summary.iqm_ci95 = bootstrap_interval(means, studentized_iqm, Draws(0, "table", 0));
    summary.caution = caution(static_cast<double>(means.size()), summary.estimate.skewness, "training runs");
  } else {
    summary.estimate.ci95 = last.ci95;
    summary.caution = caution(static_cast<double>(last.episodes), last.skewness, "episodes");
  }
  return summary;
}

}  // namespace coppice
