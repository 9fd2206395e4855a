#include "reports/cell_summary.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/statistics/bootstrap.h"
#include "engine/statistics/cautions.h"
#include "engine/statistics/studentized.h"
#include "reports/units.h"

namespace coppice {
namespace {

/// The episodes of each run; none when not all have kept their episodes.
std::vector<std::vector<double>> episodes_of(const std::vector<InputNode>& nodes, const Units& units,
                                             Metric metric) {
  std::vector<std::vector<double>> values;
  for (const Run& run : units.runs) {
    std::vector<double>& episodes = values.emplace_back();
    for (const std::size_t i : run.evaluations) {
      const std::vector<double> more = observe_episodes(nodes[i], metric);
      if (more.empty()) return {};
      episodes.insert(episodes.end(), more.begin(), more.end());
    }
  }
  return values;
}

const char* name_of_units(const Units& units) {
  return units.are_runs ? "training runs" : "episodes";
}

/// A share lies in [0, 1], and is never known exactly.
std::optional<Interval> of_share(const std::optional<Interval>& interval) {
  if (!interval || interval->low == interval->high) return std::nullopt;
  return Interval{std::max(0.0, interval->low), std::min(1.0, interval->high)};
}

void estimate_by_t(CellSummary& summary, const Units& units, Metric metric) {
  if (!units.are_runs) summary.estimate.ci95 = units.last.ci95;
  if (is_share(metric) && !units.learned) {  // a score interval holds for any number of episodes
    summary.estimate.ci95 = share_interval(summary.estimate.mean, share_of(units).cases);
    return;
  }
  if (is_share(metric)) summary.estimate.ci95 = score_interval(share_of(units));
  summary.caution =
      caution(units.are_runs ? moments(summary.replicates) : units.last.moments, name_of_units(units));
}

void estimate_by_bootstrap(CellSummary& summary, const std::vector<InputNode>& nodes, const Units& units,
                           Metric metric) {
  const char* name = name_of_units(units);
  std::vector<std::vector<double>> values = episodes_of(nodes, units, metric);
  summary.estimate.ci95.reset();
  if (values.empty() && !units.are_runs) {
    summary.caution = "the evaluation did not keep its episodes (returns=\"false\"): no interval";
    return;
  }
  if (values.empty()) {
    for (const double mean : summary.replicates) values.push_back({mean});
  }
  const std::size_t n = units.are_runs ? values.size() : values.front().size();
  if (n < kUnitsForBootstrap) {
    summary.caution =
        fmt::format("only {} {}, and the bootstrap needs {}: no interval", n, name, kUnitsForBootstrap);
    return;
  }
  const std::optional<Interval> interval = bootstrap_interval(
      values, units.are_runs ? Unit::training_run : Unit::episode, studentized_mean, Draws(0, "table", 0));
  summary.estimate.ci95 = is_share(metric) ? of_share(interval) : interval;
  summary.caution = caution(units.are_runs ? moments(summary.replicates) : units.last.moments, name);
  if (!summary.estimate.ci95)
    summary.caution = fmt::format("too few of the {} {} differ: no interval", n, name);
}

}  // namespace

CellSummary summarize(const std::vector<InputNode>& nodes, const TableCell& cell, Metric metric,
                      std::optional<Better> better, IntervalMethod method) {
  CellSummary summary;
  const Units units = units_of(nodes, cell, metric);
  summary.replicates = means_of(units);
  summary.episodes = units.last.episodes;
  summary.estimate = estimate(summary.replicates, better);
  if (units.are_runs) {
    const std::optional<Interval> iqm = iqm_interval(summary.replicates);
    summary.iqm_ci95 = is_share(metric) ? of_share(iqm) : iqm;
  }
  if (method == IntervalMethod::t) {
    estimate_by_t(summary, units, metric);
  } else {
    estimate_by_bootstrap(summary, nodes, units, metric);
  }
  return summary;
}

}  // namespace coppice
