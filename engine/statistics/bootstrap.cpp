#include "engine/statistics/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace coppice {
namespace {

/// The quantile of sorted values at position p (n + 1), as for order statistics of a continuous sample.
double order_quantile(const std::vector<double>& sorted, double p) {
  const double position =
      std::clamp(p * static_cast<double>(sorted.size() + 1) - 1, 0.0, static_cast<double>(sorted.size() - 1));
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double part = position - static_cast<double>(below);
  if (part == 0 || sorted[below] == sorted[above]) return sorted[below];
  return sorted[below] + part * (sorted[above] - sorted[below]);
}

/// The value of each unit of one resample.
void resample(const std::vector<std::vector<double>>& runs, Stream& stream, std::vector<double>& units) {
  for (double& unit : units) {
    const std::vector<double>& run = runs[stream.below(runs.size())];
    if (run.size() == 1) {
      unit = run.front();
      continue;
    }
    double sum = 0;
    for (std::size_t i = 0; i < run.size(); ++i) sum += run[stream.below(run.size())];
    unit = sum / static_cast<double>(run.size());
  }
}

/// Infinitely far when the resample does not vary at all.
double studentized(const Studentized& resampled, double centre) {
  const double away = resampled.value - centre;
  if (resampled.error > 0) return away / resampled.error;
  return away == 0 ? 0 : std::copysign(std::numeric_limits<double>::infinity(), away);
}

}  // namespace

std::optional<Interval> bootstrap_interval(const std::vector<std::vector<double>>& runs, Unit unit,
                                           const Statistic& statistic, const Draws& draws, double confidence,
                                           int resamples) {
  std::vector<std::vector<double>> groups;
  for (const std::vector<double>& run : runs) {
    if (unit == Unit::training_run) {
      groups.push_back(run);
    } else {
      for (const double episode : run) groups.push_back({episode});
    }
  }
  if (groups.size() < kUnitsForBootstrap) return std::nullopt;
  std::vector<double> units;
  for (const std::vector<double>& group : groups) units.push_back(mean(group));
  const Studentized seen = statistic(units);
  std::vector<double> ratios;
  for (int i = 0; i < resamples; ++i) {
    Stream stream = draws.stream("resample", static_cast<std::uint64_t>(i));
    resample(groups, stream, units);
    ratios.push_back(studentized(statistic(units), seen.value));
  }
  std::sort(ratios.begin(), ratios.end());
  const double tail = (1 - confidence) / 2;
  if (!(seen.error > 0)) return Interval{seen.value, seen.value};
  const double high = order_quantile(ratios, 1 - tail), low = order_quantile(ratios, tail);
  if (!std::isfinite(low) || !std::isfinite(high)) return std::nullopt;
  return Interval{seen.value - high * seen.error, seen.value - low * seen.error};
}

std::optional<Interval> bootstrap_interval(std::span<const double> units, const Statistic& statistic,
                                           const Draws& draws, double confidence, int resamples) {
  std::vector<std::vector<double>> runs;
  for (const double unit : units) runs.push_back({unit});
  return bootstrap_interval(runs, Unit::training_run, statistic, draws, confidence, resamples);
}

}  // namespace coppice
