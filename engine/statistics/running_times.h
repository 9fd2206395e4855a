#pragma once

#include <optional>
#include <span>

#include "engine/statistics/intervals.h"
#include "engine/vocabulary/random.h"

namespace coppice {

/// A search towards a target: the evaluations until it was reached, or in all where it was not.
struct SearchRun {
  double evaluations = 0;
  bool reached = false;
};

/// The expected number of evaluations until a success when a search is begun anew after each failure: the
/// evaluations of all runs divided by the number of successes (Hansen et al., INRIA RR-6828, 2009, section
/// 4.3). Infinite without a success.
double expected_running_time(std::span<const SearchRun> runs);

/// Percentile bootstrap interval of it over runs; its upper end is infinite where resamples without a success
/// reach. Nothing for fewer than ten runs, nor without a success. The draws decide the resamples.
std::optional<Interval> running_time_interval(std::span<const SearchRun> runs, const Draws& draws,
                                              double confidence = 0.95, int resamples = 1999);

/// The order statistic that is no less than the median of a distribution with this confidence (one-sided, by
/// the sign test, whatever the distribution). Nothing where there are too few values: four, for 95 %.
std::optional<double> median_upper_bound(std::span<const double> values, double confidence = 0.95);

}  // namespace coppice
