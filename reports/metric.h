#pragma once

#include <optional>
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
/// True when each episode counts 0 or 1.
bool is_share(Metric metric);
std::string metric_doc(Metric metric);  ///< "cost (minus the sum of rewards)"

/// What a node says about which values are good; automatic: what the metric says.
enum class Direction { automatic, higher, lower };
std::vector<std::string> direction_names();  ///< as users write them, in the order of the enumeration
/// Nothing for steps and terminal_rate unless `given` says it: an episode may end in success or in failure.
std::optional<Better> better(Metric metric, Direction given);
/// The same where it must be known: throws std::invalid_argument that asks for it.
Better require_better(Metric metric, Direction given);

/// What one evaluation, or fit, says about a metric.
struct Observation {
  std::int64_t episodes = 0;  ///< of a fit, the samples it is scored on
  double mean = 0;
  Moments moments;               ///< over the episodes
  std::optional<Interval> ci95;  ///< likewise
  bool is_fit = false;           ///< of a function learned in this very node
};
/// Reads a node's evaluation.csv, or the last row of its scores.csv: of the test set where it has one. Throws
/// ConfigError when it is none.
Observation observe(const InputNode& node, Metric metric);

/// The value of each episode, by scenario; none when the evaluation did not keep them.
std::vector<double> observe_episodes(const InputNode& node, Metric metric);

}  // namespace coppice
