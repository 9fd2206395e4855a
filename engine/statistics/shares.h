#pragma once

#include <limits>
#include <optional>
#include <span>

#include "engine/statistics/intervals.h"

namespace coppice {

/// An estimated share, or mean of shares, with what it is worth.
struct ShareEstimate {
  double share = 0;
  double cases = 0;  ///< so many independent cases would tell as much; 0: not known
  double degrees =
      std::numeric_limits<double>::infinity();  ///< of freedom of `cases`, where these are estimated
};

/// The mean of the shares of runs of so many episodes each. `cases` follow from how much the runs differ: at
/// least one for each run, at most one for each episode (effective sample size: Korn and Graubard, Survey
/// Methodology 24, 1998). Shares that are all 0, or all 1, do not show how much runs may differ; there every
/// run is one case.
ShareEstimate mean_share(std::span<const double> shares, double episodes);

/// Wilson's score interval (1927), with Student's quantile where `cases` are estimated; within [0, 1], and
/// never without width. Nothing without cases.
std::optional<Interval> score_interval(const ShareEstimate& estimate, double confidence = 0.95);

/// The difference of two shares, first minus second: Newcombe's hybrid score interval, whose limits are made
/// of those of both (Statistics in Medicine 17, 1998: 873-890, method 10; with a correlation 2635-2650,
/// method 10). Within [-1, 1], and never without width.
struct ShareDifference {
  ShareEstimate first, second;
  double correlation = 0;  ///< of paired cases; 0: independent

  double value() const { return first.share - second.share; }
  std::optional<Interval> interval(double confidence = 0.95) const;
  /// The significance at which the interval just contains 0, at least 1e-15; NaN without interval.
  double p_value() const;
};

/// Newcombe's correlation of paired cases, each 0 or 1: phi, nearer to 0 by a continuity correction.
double case_correlation(std::span<const double> first, std::span<const double> second);

}  // namespace coppice
