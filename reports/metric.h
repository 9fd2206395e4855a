#pragma once

#include <string>
#include <vector>

#include "engine/graph/node.h"
#include "engine/statistics/estimates.h"
#include "engine/statistics/mean_estimate.h"

namespace coppice {

/// What a table shows of an evaluation.
enum class Metric { cost, returns, discounted_return, discounted_cost, steps, terminal_rate };

std::vector<std::string> metric_names();  ///< as users write them, in the order of the enumeration
std::string metric_doc(Metric metric);    ///< "cost (minus the sum of rewards)"
Better better(Metric metric);

/// What one evaluation says about a metric.
struct Observation {
  std::int64_t episodes = 0;
  double mean = 0;
  double skewness = 0;           ///< over the episodes; 0 for a share
  MeanEstimate error;            ///< of the mean, over the episodes
  std::optional<Interval> ci95;  ///< likewise
};
/// Reads a node's evaluation.csv. Throws ConfigError when it is none.
Observation observe(const InputNode& node, Metric metric);

/// The value of each episode, by scenario; none when the evaluation did not keep them.
std::vector<double> observe_episodes(const InputNode& node, Metric metric);

}  // namespace coppice
