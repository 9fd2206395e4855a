#include "reports/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "engine/statistics/cautions.h"
#include "reports/units.h"

namespace coppice {
namespace {

/// Of what a side's mean is one of several; the means of runs, else the episodes as they were summarized.
MeanEstimate estimate_of(const Side& side) {
  return side.are_runs ? mean_estimate(side.means) : side.last.error;
}

std::string caution_of(const Side& side) {
  return side.are_runs
             ? caution(static_cast<double>(side.means.size()), sample_skewness(side.means), "training runs")
             : caution(static_cast<double>(side.last.episodes), side.last.skewness, "episodes");
}

bool paired_runs(const Side& a, const Side& b) {
  return a.are_runs && b.are_runs && a.replicates == b.replicates;
}

bool paired_episodes(const Side& a, const Side& b) {
  return !a.are_runs && !b.are_runs && !a.episodes.empty() && a.stream == b.stream &&
         a.episodes.size() == b.episodes.size();
}

/// Of learned policies against one that is known but for the error of its evaluation.
Improvement improvement_over(const std::vector<double>& means, double value, Better better) {
  const std::vector<double> single = {value};
  Improvement result = probability_of_improvement(means, single, better);
  result.ci95 = share_interval(result.probability, static_cast<double>(means.size()));
  return result;
}

Improvement improvement(const Side& first, const Side& second, Better better) {
  if (first.are_runs && second.are_runs) return probability_of_improvement(first.means, second.means, better);
  if (first.are_runs) return improvement_over(first.means, second.last.mean, better);
  if (second.are_runs) {
    const Improvement other = improvement_over(second.means, first.last.mean, better);
    return {1 - other.probability, Interval{1 - other.ci95->high, 1 - other.ci95->low}};
  }
  return probability_of_improvement(first.episodes, second.episodes, better);
}

}  // namespace

Side read_side(const std::vector<InputNode>& nodes, const TableCell& cell, Metric metric) {
  Units units = units_of(nodes, cell, metric);
  std::stable_sort(units.runs.begin(), units.runs.end(),
                   [](const Run& a, const Run& b) { return a.replicate < b.replicate; });
  Side side;
  side.are_runs = units.are_runs;
  side.last = units.last;
  for (const Run& run : units.runs) {
    side.replicates.push_back(run.replicate);
    side.means.push_back(run.mean);
  }
  const InputNode& last = nodes[cell.entries.back()];
  if (!last.streams.empty()) side.stream = last.streams.front();
  if (!side.are_runs) side.episodes = observe_episodes(last, metric);
  return side;
}

Comparison compare(const Side& first, const Side& second, Metric metric) {
  Comparison result;
  result.replicates = std::min(first.means.size(), second.means.size());
  result.episodes = std::min(first.last.episodes, second.last.episodes);
  result.mean_first = mean(first.means);
  result.mean_second = mean(second.means);
  const bool by_run = paired_runs(first, second);
  if (by_run || paired_episodes(first, second)) {
    const std::vector<double> differences = by_run ? paired_differences(first.means, second.means)
                                                   : paired_differences(first.episodes, second.episodes);
    result.difference = mean_estimate(differences);
    result.method = by_run ? "paired runs" : "paired episodes";
    result.caution = caution(static_cast<double>(differences.size()), sample_skewness(differences),
                             by_run ? "pairs of training runs" : "pairs of episodes");
  } else {
    result.difference = difference(estimate_of(first), estimate_of(second));
    result.method = "Welch";
    result.caution = caution_of(first);
    if (const std::string other = caution_of(second); !other.empty() && other != result.caution) {
      result.caution += (result.caution.empty() ? "" : "; ") + other;
    }
  }
  result.p_value = p_value(result.difference);
  result.improvement = improvement(first, second, better(metric));
  return result;
}

}  // namespace coppice
