#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/graph/node.h"
#include "engine/statistics/running_times.h"
#include "reports/cells.h"

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

/// A table about searches of objectives whose optimum is known; columns of sweeps and the like tell its rows
/// apart.
struct SearchReport : Node {
  References of;
  std::vector<std::string> rows;

  std::vector<std::string> makes() const override { return {"table", "timing"}; }
  bool gathers(std::string_view) const override { return true; }
  bool shows_labels() const override { return true; }
  bool random() const override { return false; }
  std::string published_in() const override { return "tables"; }
  void check(const NodeContext& context) const override;

 protected:
  TableKeys keys() const { return {rows, {}, "rows", "rows", "rows"}; }
};

/// Parameters of T, a SearchReport.
template <class T>
Parameters<T> search_report_parameters() {
  return node_parameters<T>()
      .references("of", &T::of, "search", "Searches of objectives whose optimum is known.")
      .add("rows", static_cast<std::vector<std::string> T::*>(&T::rows), "",
           "What tells the rows apart: columns of sweeps, objective, node (the search's id).");
}

/// When the search first tried a point within the gap.
SearchRun run_to(const SearchLog& search, double gap);

}  // namespace coppice
