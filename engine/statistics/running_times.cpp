#include "engine/statistics/running_times.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace coppice {

double expected_running_time(std::span<const SearchRun> runs) {
  double evaluations = 0, successes = 0;
  for (const SearchRun& run : runs) {
    evaluations += run.evaluations;
    successes += run.reached ? 1 : 0;
  }
  return successes > 0 ? evaluations / successes : std::numeric_limits<double>::infinity();
}

std::optional<Interval> running_time_interval(std::span<const SearchRun> runs, const Draws& draws,
                                              double confidence, int resamples) {
  constexpr std::size_t kFewest = 10;
  const bool reached =
      std::any_of(runs.begin(), runs.end(), [](const SearchRun& run) { return run.reached; });
  if (runs.size() < kFewest || !reached) return std::nullopt;
  Stream stream = draws.stream("resample");
  std::vector<SearchRun> drawn(runs.size());
  std::vector<double> times;
  for (int r = 0; r < resamples; ++r) {
    for (SearchRun& run : drawn) run = runs[stream.below(runs.size())];
    times.push_back(expected_running_time(drawn));
  }
  std::sort(times.begin(), times.end());
  // 1999 resamples: their 50th and 1950th, for 95 % (p (B + 1), which is whole).
  const auto at = [&](double p) {
    const auto rank = static_cast<std::size_t>(std::llround(p * static_cast<double>(resamples + 1)));
    return times[std::clamp<std::size_t>(rank, 1, times.size()) - 1];
  };
  return Interval{at((1 - confidence) / 2), at((1 + confidence) / 2)};
}

std::optional<double> median_upper_bound(std::span<const double> values, double confidence) {
  // P(median <= k-th smallest of n) >= P(Bin(n, 1/2) < k): fewer than k values lie below the median.
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const auto n = static_cast<double>(sorted.size());
  double probability = std::ldexp(1.0, -static_cast<int>(sorted.size())), below = 0;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    below += probability;
    if (below >= confidence) return sorted[k];
    probability *= (n - static_cast<double>(k)) / static_cast<double>(k + 1);
  }
  return std::nullopt;
}

}  // namespace coppice
