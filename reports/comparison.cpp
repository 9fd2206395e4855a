#include "reports/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/statistics/cautions.h"
#include "reports/units.h"

namespace coppice {
namespace {

/// Of what a side's mean is one of several; the means of runs, else the episodes as they were summarized.
MeanEstimate estimate_of(const Side& side) {
  return mean_estimate(side.are_runs ? moments(side.means) : side.last.moments);
}

std::string caution_of(const Side& side) {
  if (side.are_runs) return caution(moments(side.means), "training runs");
  return side.share ? "" : caution(side.last.moments, "episodes");
}

std::string caution_of(const Side& first, const Side& second) {
  std::string both = caution_of(first);
  const std::string other = caution_of(second);
  if (!other.empty() && other != both) both += (both.empty() ? "" : "; ") + other;
  return both;
}

bool paired_runs(const Side& a, const Side& b) {
  return a.are_runs && b.are_runs && a.replicates == b.replicates;
}

bool paired_episodes(const Side& a, const Side& b) {
  return !a.are_runs && !b.are_runs && !a.episodes.empty() && a.stream == b.stream &&
         a.episodes.size() == b.episodes.size();
}

/// Of learned policies against one that is known but for the error of its evaluation, or the other way
/// round.
Improvement improvement_over(const std::vector<double>& means, double value, Better better, bool swapped) {
  const std::vector<double> single = {value};
  Improvement result = swapped ? probability_of_improvement(single, means, better)
                               : probability_of_improvement(means, single, better);
  result.ci95 = share_interval(result.probability, static_cast<double>(means.size()));
  return result;
}

Improvement improvement(const Side& first, const Side& second, Better better) {
  if (first.are_runs && second.are_runs) return probability_of_improvement(first.means, second.means, better);
  if (first.are_runs) return improvement_over(first.means, second.last.mean, better, false);
  if (second.are_runs) {
    return improvement_over(second.means, first.last.mean, better, true);
  }
  return probability_of_improvement(first.episodes, second.episodes, better);
}

void take_means(Comparison& result, const MeanEstimate& difference) {
  result.difference = difference.mean;
  result.ci95 = confidence_interval(difference);
  result.p_value = p_value(difference);
}

/// Differences of shares have width where none of the cases differ, too.
void take_shares(Comparison& result, const ShareDifference& difference) {
  result.difference = difference.value();
  result.ci95 = difference.interval();
  result.p_value = difference.p_value();
}

void compare_runs(Comparison& result, const Side& first, const Side& second) {
  const std::vector<double> differences = paired_differences(first.means, second.means);
  const Moments known = moments(differences);
  result.method = "paired runs";
  result.caution = caution(known, "pairs of training runs");
  take_means(result, mean_estimate(known));
  if (!first.share) return;
  if (!(known.deviation > 0)) return take_shares(result, {*first.share, *second.share});
  if (result.ci95) result.ci95 = Interval{std::fmax(-1, result.ci95->low), std::fmin(1, result.ci95->high)};
}

void compare_episodes(Comparison& result, const Side& first, const Side& second) {
  result.method = "paired episodes";
  if (first.share) {
    take_shares(result, {*first.share, *second.share, case_correlation(first.episodes, second.episodes)});
    return;
  }
  const Moments known = moments(paired_differences(first.episodes, second.episodes));
  result.caution = caution(known, "pairs of episodes");
  take_means(result, mean_estimate(known));
}

void compare_independent(Comparison& result, const Side& first, const Side& second) {
  result.method = first.share ? "Newcombe" : "Welch";
  result.caution = caution_of(first, second);
  if (first.share) return take_shares(result, {*first.share, *second.share});
  take_means(result, difference(estimate_of(first), estimate_of(second)));
}

}  // namespace

Side read_side(const std::vector<InputNode>& nodes, const TableCell& cell, Metric metric) {
  Units units = units_of(nodes, cell, metric);
  std::stable_sort(units.runs.begin(), units.runs.end(),
                   [](const Run& a, const Run& b) { return a.replicate < b.replicate; });
  Side side;
  side.are_runs = units.are_runs;
  side.last = units.last;
  if (is_share(metric)) side.share = share_of(units);
  for (const Run& run : units.runs) {
    side.replicates.push_back(run.replicate);
    side.means.push_back(run.mean);
  }
  const InputNode& last = nodes[cell.entries.back()];
  if (!last.streams.empty()) side.stream = last.streams.front();
  if (!side.are_runs) side.episodes = observe_episodes(last, metric);
  return side;
}

Comparison compare(const Side& first, const Side& second, Better better) {
  Comparison result;
  result.replicates = std::min(first.means.size(), second.means.size());
  result.episodes = std::min(first.last.episodes, second.last.episodes);
  result.mean_first = mean(first.means);
  result.mean_second = mean(second.means);
  if (paired_runs(first, second)) {
    compare_runs(result, first, second);
  } else if (paired_episodes(first, second)) {
    compare_episodes(result, first, second);
  } else {
    compare_independent(result, first, second);
  }
  result.improvement = improvement(first, second, better);
  return result;
}

}  // namespace coppice
