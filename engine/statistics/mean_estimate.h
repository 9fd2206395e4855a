#pragma once

#include <optional>
#include <span>

#include "engine/statistics/intervals.h"

namespace coppice {

/// From so many units on an interval of a mean also follows the skewness of the values: of fewer it cannot
/// be told from chance.
inline constexpr double kUnitsForSkewness = 10;

/// What is known of n values: their mean, deviation (n - 1) and skewness (that of sample_skewness).
struct Moments {
  double n = 0;
  double mean = 0;
  double deviation = 0;
  double skewness = 0;
};
Moments moments(std::span<const double> values);

/// An estimated mean, or difference of means, with what is known of its error.
struct MeanEstimate {
  double mean = 0;
  double variance = 0;  ///< of the mean: the squared standard error
  double third = 0;     ///< third central moment of the mean; 0 where there are too few values to know it
  double degrees = 0;   ///< of freedom; 0: the variance is not known
};

/// Of independent values.
MeanEstimate mean_estimate(std::span<const double> values);
MeanEstimate mean_estimate(const Moments& values);

/// The first mean minus the second, of independent samples with variances of their own (Welch 1947;
/// Satterthwaite's degrees of freedom).
MeanEstimate difference(const MeanEstimate& first, const MeanEstimate& second);

/// The interval of the mean: the smallest one that contains Student's and the one that follows skewness
/// (Hall 1992; Willink 2005, with Student's quantiles). Nothing without degrees of freedom, and where
/// variance or limits are beyond the range of doubles. Its coverage is in docs/statistics.md.
std::optional<Interval> confidence_interval(const MeanEstimate& estimate, double confidence = 0.95);

/// The two-sided p-value of the hypothesis that the mean is 0: the largest significance at which the
/// interval contains it. NaN without degrees of freedom or a finite variance, or when nothing varies and the
/// mean is 0.
double p_value(const MeanEstimate& estimate);

}  // namespace coppice
