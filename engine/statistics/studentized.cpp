#include "engine/statistics/studentized.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/statistics/estimates.h"
#include "engine/statistics/student.h"

namespace coppice {
namespace {

constexpr std::size_t kFewestUnits = 5;

}  // namespace

Studentized studentized_mean(std::span<const double> units) {
  const auto n = static_cast<double>(units.size());
  return {mean(units), standard_deviation(units) / std::sqrt(n), n - 1};
}

Studentized studentized_iqm(std::span<const double> units) {
  std::vector<double> order(units.begin(), units.end());
  std::sort(order.begin(), order.end());
  const std::size_t cut = order.size() / 4;
  const std::size_t kept = order.size() - 2 * cut;
  const double value = mean(std::span<const double>(order).subspan(cut, kept));
  std::fill_n(order.begin(), cut, order[cut]);
  std::fill_n(order.end() - static_cast<std::ptrdiff_t>(cut), cut, order[order.size() - 1 - cut]);
  const double n = static_cast<double>(order.size()), h = static_cast<double>(kept);
  return {value, standard_deviation(order) * std::sqrt((n - 1) / (h * (h - 1))), h - 1};
}

std::optional<Interval> iqm_interval(std::span<const double> units, double confidence) {
  if (units.size() < kFewestUnits) return std::nullopt;
  const Studentized iqm = studentized_iqm(units);
  const auto [low, high] = std::minmax_element(units.begin(), units.end());
  if (*low == *high) return Interval{*low, *low};
  if (!(iqm.error > 0)) return std::nullopt;
  const double half = student_t_quantile(0.5 + confidence / 2, iqm.degrees) * iqm.error;
  return Interval{iqm.value - half, iqm.value + half};
}

}  // namespace coppice
