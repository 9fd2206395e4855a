#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/statistics/estimates.h"
#include "engine/statistics/intervals.h"

namespace coppice {

/// A mean as a table has it.
struct Summary {
  double mean = 0;
  std::optional<Interval> ci95;  ///< over `units`
  std::int64_t units = 0;
};

/// The 95 % interval of the second mean minus the first, of independent samples with different variances
/// (Welch 1947, Satterthwaite's degrees of freedom); nothing unless both have an interval. It takes the width
/// of their intervals for Student's. Samples that share their random numbers are positively correlated: for
/// them it is too wide, never too narrow.
std::optional<Interval> welch_interval(const Summary& first, const Summary& second);

/// Differences first minus second, value by value: those of a scenario that both met.
std::vector<double> paired_differences(std::span<const double> first, std::span<const double> second);

/// Holm's adjusted p-values (Scandinavian Journal of Statistics 6, 1979), in the order given: those at most
/// 0.05 may be called significant together. NaN stands for no test, stays NaN and does not count.
std::vector<double> holm_adjusted(std::span<const double> p_values);

/// How likely a unit of the first is better than one of the second, ties counting half: the Mann-Whitney
/// statistic divided by the number of pairs (Agarwal et al., NeurIPS 2021).
struct Improvement {
  double probability = 0;
  std::optional<Interval> ci95;  ///< Newcombe, Statistics in Medicine 25 (2006), method 5
};
/// NaN when one of the samples is empty. Without interval when both are a single value.
Improvement probability_of_improvement(std::span<const double> first, std::span<const double> second,
                                       Better better);

}  // namespace coppice
