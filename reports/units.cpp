#include "reports/units.h"

#include <algorithm>
#include <string>

#include "engine/statistics/estimates.h"

namespace coppice {

Units units_of(const std::vector<InputNode>& nodes, const TableCell& cell, Metric metric) {
  Units units;
  std::vector<std::string> trainings;  // of each run; empty: not learned
  std::vector<std::vector<double>> values;
  for (const std::size_t i : cell.entries) {
    const InputNode& node = nodes[i];
    units.last = observe(node, metric);
    units.learned = units.learned || units.last.is_fit || !node.training.empty();
    units.are_runs = units.are_runs || units.learned || node.replicate;
    const auto known = node.training.empty() ? trainings.end()
                                             : std::find(trainings.begin(), trainings.end(), node.training);
    const auto run = static_cast<std::size_t>(known - trainings.begin());
    if (known == trainings.end()) {
      trainings.push_back(node.training);
      values.emplace_back();
      units.runs.push_back({node.replicate, 0, {}});
    }
    units.runs[run].evaluations.push_back(i);
    values[run].push_back(units.last.mean);
  }
  for (std::size_t run = 0; run < values.size(); ++run) units.runs[run].mean = mean(values[run]);
  return units;
}

std::vector<double> means_of(const Units& units) {
  std::vector<double> means;
  for (const Run& run : units.runs) means.push_back(run.mean);
  return means;
}

ShareEstimate share_of(const Units& units) {
  const std::vector<double> means = means_of(units);
  const auto episodes = static_cast<double>(units.last.episodes);
  if (units.learned) return mean_share(means, episodes);
  return {mean(means), episodes * static_cast<double>(means.size())};
}

}  // namespace coppice
