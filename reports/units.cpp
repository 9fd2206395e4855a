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
    units.are_runs = units.are_runs || units.last.is_fit || node.replicate || !node.training.empty();
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

}  // namespace coppice
