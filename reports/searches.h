#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/graph/node.h"
#include "engine/statistics/running_times.h"

namespace coppice {

/// What the files of an optimize node say of its search.
struct SearchLog {
  std::int64_t evaluations = 0;
  std::int64_t dimension = 0;
  std::optional<double> gap;  ///< of the point that was found, where the optimum is known
  bool to_optimum = false;    ///< whether the values below are gaps to it
  std::vector<std::int64_t> improved_at;
  std::vector<double> values;  ///< best so far, then
};

/// Throws ConfigError when the node has none.
SearchLog read_search(const InputNode& node);

/// Throws std::invalid_argument for a search whose optimum is not known.
void require_optimum(const std::vector<InputNode>& searches);

/// When the search first tried a point within the gap.
SearchRun run_to(const SearchLog& search, double gap);

}  // namespace coppice
