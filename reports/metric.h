#pragma once

#include <string>
#include <vector>

#include "engine/graph/node.h"
#include "engine/statistics/estimates.h"
#include "engine/statistics/mean_estimate.h"

namespace coppice {

/// What a table shows of an evaluation; from rmse on, of a fit.
enum class Metric {
  cost,
  returns,
  discounted_return,
  discounted_cost,
  steps,
  terminal_rate,
  rmse,
  r2,
  leaves
};

std::vector<std::string> metric_names();  ///< as users write them, in the order of the enumeration
/// Throws std::invalid_argument when the nodes are not what the metric is of.
void require_metric(const std::vector<InputNode>& nodes, Metric metric);
std::string metric_doc(Metric metric);  ///< "cost (minus the sum of rewards)"
Better better(Metric metric);

/// What one evaluation, or fit, says about a metric.
struct Observation {
  std::int64_t episodes = 0;  ///< of a fit, the samples it is scored on
  double mean = 0;
  double skewness = 0;           ///< over the episodes; 0 for a share
  MeanEstimate error;            ///< of the mean, over the episodes
  std::optional<Interval> ci95;  ///< likewise
  bool is_fit = false;           ///< of a function learned in this very node
};
/// Reads a node's evaluation.csv, or the last row of its scores.csv: of the test set where it has one. Throws
/// ConfigError when it is none.
Observation observe(const InputNode& node, Metric metric);

/// The value of each episode, by scenario; none when the evaluation did not keep them.
std::vector<double> observe_episodes(const InputNode& node, Metric metric);

}  // namespace coppice
