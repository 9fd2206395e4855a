#pragma once

#include <optional>
#include <span>

namespace coppice {

/// A confidence interval.
struct Interval {
  double low = 0;
  double high = 0;
};

/// Student's interval of the mean; nothing for fewer than two values. Exact for normal values, and good for
/// others from some dozens on, fewer when they are not skewed.
std::optional<Interval> t_interval(std::span<const double> values, double confidence = 0.95);

/// Wilson's score interval of a share of n (Journal of the American Statistical Association 22, 1927): a
/// share of 0 or 1 leaves some doubt, too. One to three cases, or all but so many, have the limit of a
/// Poisson variable where Wilson's would leave small shares out too often (Brown, Cai and DasGupta,
/// Statistical Science 16, 2001, section 4.1.1).
Interval share_interval(double share, double n, double confidence = 0.95);

}  // namespace coppice
