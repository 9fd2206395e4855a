#include "engine/statistics/profiles.h"

#include <algorithm>
#include <stdexcept>

namespace coppice {

std::vector<ProfilePoint> performance_profile(std::span<const double> units,
                                              std::span<const double> thresholds, Better better) {
  if (units.empty()) throw std::logic_error("a performance profile needs units");
  std::vector<ProfilePoint> profile;
  const auto n = static_cast<double>(units.size());
  for (const double threshold : thresholds) {
    const auto reached = std::count_if(units.begin(), units.end(), [&](double value) {
      return better == Better::higher ? value > threshold : value < threshold;
    });
    const double share = static_cast<double>(reached) / n;
    profile.push_back({threshold, share, share_interval(share, n)});
  }
  return profile;
}

double optimality_gap(std::span<const double> units, double target, Better better) {
  std::vector<double> missed;
  for (const double value : units) {
    const double away = better == Better::higher ? target - value : value - target;
    missed.push_back(away < 0 ? 0 : away);  // NaN stays
  }
  return mean(missed);
}

}  // namespace coppice
