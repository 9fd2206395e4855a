#pragma once

#include <string>
#include <vector>

#include "engine/statistics/comparisons.h"
#include "engine/statistics/shares.h"
#include "reports/cells.h"
#include "reports/metric.h"

namespace coppice {

/// One of two things that are compared.
struct Side {
  bool are_runs = false;                       ///< as Units::are_runs; else its unit is the episode
  std::vector<std::optional<int>> replicates;  ///< of each run
  std::vector<double> means;                   ///< of each run
  std::vector<double> episodes;        ///< not of runs: the value of each episode, where they were kept
  std::string stream;                  ///< of the evaluation's scenarios
  Observation last;                    ///< of its last evaluation
  std::optional<ShareEstimate> share;  ///< of a metric that is a share
};
Side read_side(const std::vector<InputNode>& nodes, const TableCell& cell, Metric metric);

/// First minus second.
struct Comparison {
  std::size_t replicates = 1;
  std::int64_t episodes = 0;
  double mean_first = 0, mean_second = 0;
  double difference = 0;
  std::optional<Interval> ci95;  ///< of the difference
  double p_value = 0;
  Improvement improvement;
  std::string method;
  std::string caution;
};

/// Pairs replicates where both have the same, and scenarios where neither has any; else the samples count as
/// independent.
Comparison compare(const Side& first, const Side& second, Better better);

}  // namespace coppice
