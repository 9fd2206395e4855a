#include "engine/statistics/shares.h"

#include <algorithm>
#include <cmath>

#include "engine/statistics/estimates.h"
#include "engine/statistics/student.h"
#include "engine/vocabulary/elementary.h"

namespace coppice {
namespace {

/// How far a limit of the difference is away, from how far those of the shares are.
double hybrid(double a, double b, double correlation) {
  return std::sqrt(std::fmax(0, a * a - 2 * correlation * a * b + b * b));
}

}  // namespace

ShareEstimate mean_share(std::span<const double> shares, double episodes) {
  const auto runs = static_cast<double>(shares.size());
  const double share = mean(shares), deviation = standard_deviation(shares);
  if (!(runs >= 2)) return {share, 0};
  const double spread = share * (1 - share);
  if (!(spread > 0)) return {share, runs};
  const double cases = spread * runs / (deviation * deviation);  // the variance of a share is spread / cases
  const double most = runs * std::fmax(1, episodes);
  if (!(cases < most)) return {share, most};  // no more than chance: the episodes are the cases
  return {share, std::fmax(cases, runs), runs - 1};
}

std::optional<Interval> score_interval(const ShareEstimate& estimate, double confidence) {
  const double n = estimate.cases, p = estimate.share, level = 0.5 + confidence / 2;
  if (!(n > 0)) return std::nullopt;
  const double z =
      std::isinf(estimate.degrees) ? normal_quantile(level) : student_t_quantile(level, estimate.degrees);
  const double scale = 1 + z * z / n;
  const double center = (p + z * z / (2 * n)) / scale;
  const double half = z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / scale;
  // At the ends they are 0 and 1; rounding must not move them.
  return Interval{p <= 0 ? 0 : std::fmax(0, center - half), p >= 1 ? 1 : std::fmin(1, center + half)};
}

std::optional<Interval> ShareDifference::interval(double confidence) const {
  const std::optional<Interval> a = score_interval(first, confidence);
  const std::optional<Interval> b = score_interval(second, confidence);
  if (!a || !b) return std::nullopt;
  const double p = first.share, q = second.share;
  return Interval{std::fmax(-1, value() - hybrid(p - a->low, b->high - q, correlation)),
                  std::fmin(1, value() + hybrid(a->high - p, q - b->low, correlation))};
}

double ShareDifference::p_value() const {
  if (!interval()) return std::numeric_limits<double>::quiet_NaN();
  double inside = 0, outside = 1;  // significances: at 0 everything is inside
  for (int i = 0; i < 50; ++i) {
    const double middle = (inside + outside) / 2;
    const Interval limits = *interval(1 - middle);
    (limits.low <= 0 && 0 <= limits.high ? inside : outside) = middle;
  }
  return outside;
}

double case_correlation(std::span<const double> first, std::span<const double> second) {
  double both = 0, only_first = 0, only_second = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const bool a = first[i] > 0, b = second[i] > 0;
    both += a && b;
    only_first += a && !b;
    only_second += !a && b;
  }
  const auto n = static_cast<double>(first.size());
  const double neither = n - both - only_first - only_second;
  const double product =
      (both + only_first) * (neither + only_second) * (both + only_second) * (neither + only_first);
  if (!(product > 0)) return 0;
  const double excess = both * neither - only_first * only_second;
  return (excess > 0 ? std::fmax(0, excess - n / 2) : excess) / std::sqrt(product);
}

}  // namespace coppice
