#include "engine/statistics/intervals.h"

#include <cmath>

#include "engine/statistics/estimates.h"
#include "engine/statistics/shares.h"
#include "engine/statistics/student.h"
#include "engine/vocabulary/elementary.h"

namespace coppice {

std::optional<Interval> t_interval(std::span<const double> values, double confidence) {
  if (values.size() < 2) return std::nullopt;
  const auto n = static_cast<double>(values.size());
  const double centre = mean(values);
  const double half =
      student_t_quantile(0.5 + confidence / 2, n - 1) * standard_deviation(values) / std::sqrt(n);
  return Interval{centre - half, centre + half};
}

namespace {

/// The mean of a Poisson variable that reaches k with probability p.
double poisson_mean(int k, double p) {
  double low = 0, high = k;  // p is small: the mean is below k
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    double term = elementary::exp(-middle), below = 0;
    for (int j = 0; j < k; ++j) {
      below += term;
      term *= middle / (j + 1);
    }
    (1 - below < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// How many cases of n are `share`, when they are few enough for a Poisson limit; else 0.
int few_cases(double share, double n) {
  const double cases = std::round(share * n);
  const bool whole = std::fabs(share * n - cases) < 1e-6;
  return whole && cases >= 1 && cases <= (n <= 50 ? 2 : 3) && 2 * cases <= n ? static_cast<int>(cases) : 0;
}

}  // namespace

Interval share_interval(double share, double n, double confidence) {
  Interval interval = *score_interval({share, n}, confidence);
  if (const int cases = few_cases(share, n)) interval.low = poisson_mean(cases, 1 - confidence) / n;
  if (const int others = few_cases(1 - share, n))
    interval.high = 1 - poisson_mean(others, 1 - confidence) / n;
  return interval;
}

}  // namespace coppice
