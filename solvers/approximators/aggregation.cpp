#include "solvers/approximators/aggregation.h"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace coppice {
namespace {

// The kRank-th smallest and the kRank-th largest value. Without branches, which would be guessed wrongly.
template <std::size_t kRank>
std::pair<double, double> order_statistics(std::span<const double> values) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<double, kRank> lowest;
  std::array<double, kRank> highest;
  lowest.fill(kInfinity);
  highest.fill(-kInfinity);
  for (const double value : values) {
    double above = value;
    double below = value;
    for (std::size_t i = 0; i < kRank; ++i) {
      const double low = std::min(lowest[i], above);
      above = std::max(lowest[i], above);
      lowest[i] = low;
      const double high = std::max(highest[i], below);
      below = std::min(highest[i], below);
      highest[i] = high;
    }
  }
  return {lowest[kRank - 1], highest[kRank - 1]};
}

constexpr std::array kOrderStatistics = {order_statistics<1>, order_statistics<2>, order_statistics<3>,
                                         order_statistics<4>, order_statistics<5>, order_statistics<6>};

std::pair<double, double> order_statistics(std::span<double> values, std::size_t rank) {
  if (rank <= kOrderStatistics.size()) return kOrderStatistics[rank - 1](values);
  std::sort(values.begin(), values.end());
  return {values[rank - 1], values[values.size() - rank]};
}

}  // namespace

// Values that equal the last one left out stay as often as that leaves them. The order of the sum is that of
// the trees, or of size where they are many: never one that a library chooses.
double trimmed_mean(std::span<double> values) {
  const double sum_of_all = std::accumulate(values.begin(), values.end(), 0.0);
  if (std::isnan(sum_of_all)) return sum_of_all;
  const std::size_t cut = trimmed_on_each_side(values.size());
  const std::size_t left = values.size() - 2 * cut;
  if (cut == 0) return sum_of_all / static_cast<double>(left);
  const auto [low, high] = order_statistics(values, cut);
  double sum = 0;
  std::size_t not_above = 0;
  std::size_t not_below = 0;
  for (const double value : values) {
    sum += value > low && value < high ? value : 0.0;
    not_above += value <= low ? 1 : 0;
    not_below += value >= high ? 1 : 0;
  }
  if (low == high) return low;
  const auto lows = static_cast<double>(not_above - cut);
  const auto highs = static_cast<double>(not_below - cut);
  return (sum + lows * low + highs * high) / static_cast<double>(left);
}

}  // namespace coppice
