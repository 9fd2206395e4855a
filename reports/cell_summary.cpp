#include "reports/cell_summary.h"

#include "engine/statistics/bootstrap.h"
#include "engine/statistics/cautions.h"
#include "engine/statistics/studentized.h"
#include "reports/units.h"

namespace coppice {
namespace {

/// The episodes of each run; the means of the runs when not all have kept their episodes.
std::vector<std::vector<double>> values_of(const std::vector<InputNode>& nodes, const Units& units,
                                           Metric metric) {
  std::vector<std::vector<double>> values, means;
  bool all_kept = true;
  for (const Run& run : units.runs) {
    means.push_back({run.mean});
    std::vector<double>& episodes = values.emplace_back();
    for (const std::size_t i : run.evaluations) {
      const std::vector<double> more = observe_episodes(nodes[i], metric);
      all_kept = all_kept && !more.empty();
      episodes.insert(episodes.end(), more.begin(), more.end());
    }
  }
  return all_kept ? values : means;
}

std::optional<Interval> bootstrapped(const std::vector<InputNode>& nodes, const Units& units, Metric metric) {
  return bootstrap_interval(values_of(nodes, units, metric),
                            units.are_runs ? Unit::training_run : Unit::episode, studentized_mean,
                            Draws(0, "table", 0));
}

}  // namespace

CellSummary summarize(const std::vector<InputNode>& nodes, const TableCell& cell, Metric metric,
                      IntervalMethod method) {
  CellSummary summary;
  const Units units = units_of(nodes, cell, metric);
  const Observation& last = units.last;
  for (const Run& run : units.runs) summary.replicates.push_back(run.mean);
  const std::vector<double>& means = summary.replicates;
  summary.episodes = last.episodes;
  summary.estimate = estimate(means, better(metric));
  if (units.are_runs) {
    summary.iqm_ci95 = iqm_interval(means);
    summary.caution = caution(static_cast<double>(means.size()), summary.estimate.skewness, "training runs");
  } else {
    summary.estimate.ci95 = last.ci95;
    summary.caution = caution(static_cast<double>(last.episodes), last.skewness, "episodes");
  }
  if (method == IntervalMethod::bootstrap) summary.estimate.ci95 = bootstrapped(nodes, units, metric);
  return summary;
}

}  // namespace coppice
