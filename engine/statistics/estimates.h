#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/statistics/intervals.h"

namespace coppice {

// Statistics of samples. Sums have a fixed order. An empty sample has the mean, quantiles and extremes NaN.

double mean(std::span<const double> values);
/// Of the sample (n - 1); NaN for fewer than two values.
double standard_deviation(std::span<const double> values);
/// Third central moment by the cube of the deviation, both without bias (k-statistics); 0 when nothing
/// varies, NaN for fewer than three values.
double sample_skewness(std::span<const double> values);
/// Linear interpolation between order statistics (definition 7 of Hyndman and Fan, The American Statistician
/// 50(4), 1996); p in [0, 1].
double quantile(std::span<const double> values, double p);
double median(std::span<const double> values);
/// Mean without the floor(n / 4) smallest and as many largest values (Agarwal et al., NeurIPS 2021).
double interquartile_mean(std::span<const double> values);

/// What was drawn independently: an interval is over units. Episodes of one learned policy tell nothing of
/// how the next training would turn out, so a learned policy's unit is the training run, its value the mean
/// of its episodes. A policy that was not learned has no training runs; its unit is the episode.
enum class Unit { training_run, episode };

/// Which values are good: returns (higher) or costs (lower).
enum class Better { higher, lower };

/// Summary over units.
struct Estimate {
  std::size_t units = 0;
  double mean = 0;
  double sd = 0;                 ///< over units; NaN for one
  double skewness = 0;           ///< over units; NaN for fewer than three
  std::optional<Interval> ci95;  ///< of the mean, as confidence_interval has it; nothing for one unit
  double median = 0;
  double iqm = 0;
  double worst = 0;  ///< NaN where it is not known which values are good
  double best = 0;   ///< likewise
};

/// Of independent values; worst and best are NaN unless it is said which values are good.
Estimate estimate(std::span<const double> units, std::optional<Better> better);

/// Of the episodes' values of each training run (or, for Unit::episode, of all groups together).
Estimate estimate(const std::vector<std::vector<double>>& runs, Unit unit, Better better);

}  // namespace coppice
