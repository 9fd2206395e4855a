#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/statistics/estimates.h"
#include "engine/statistics/studentized.h"
#include "engine/vocabulary/random.h"

namespace coppice {

/// Of fewer, too many resamples do not vary at all.
inline constexpr std::size_t kUnitsForBootstrap = 10;

/// Studentized bootstrap interval of a statistic (Efron and Tibshirani 1993, chapter 12). `unit` is what was
/// drawn independently. With Unit::training_run, runs are drawn with replacement, then the episodes of each,
/// and the statistic is of the runs' means; with Unit::episode it is of all episodes, drawn alike. Nothing
/// for fewer than ten units, or where too few of them differ. The draws decide the resamples: equal draws
/// give equal intervals.
std::optional<Interval> bootstrap_interval(const std::vector<std::vector<double>>& runs, Unit unit,
                                           const Statistic& statistic, const Draws& draws,
                                           double confidence = 0.95, int resamples = 1999);
/// The same of units that are one value each.
std::optional<Interval> bootstrap_interval(std::span<const double> units, const Statistic& statistic,
                                           const Draws& draws, double confidence = 0.95,
                                           int resamples = 1999);

}  // namespace coppice
