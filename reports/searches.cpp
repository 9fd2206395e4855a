#include "reports/searches.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"

namespace coppice {

SearchLog read_search(const InputNode& node) {
  SearchLog log;
  const Table summary = read_table(node.folder / kSearchFile);
  const std::vector<Cell>& row = summary.rows.at(0);
  log.evaluations = static_cast<std::int64_t>(number(row[summary.column("evaluations")]));
  log.dimension = static_cast<std::int64_t>(read_table(node.folder / kOptimumFile).rows.size());
  if (summary.has("gap")) {
    const double gap = number(row[summary.column("gap")]);
    if (!std::isnan(gap)) log.gap = gap;
  }
  const Table improvements = read_table(node.folder / kImprovementsFile);
  log.to_optimum = improvements.has("gap");
  const std::size_t at = improvements.column("evaluations"),
                    value = improvements.column(log.to_optimum ? "gap" : "value");
  for (const std::vector<Cell>& improvement : improvements.rows) {
    log.improved_at.push_back(static_cast<std::int64_t>(number(improvement[at])));
    log.values.push_back(number(improvement[value]));
  }
  return log;
}

void SearchReport::check(const NodeContext& context) const {
  Rules rules;
  for (const InputNode& node : context.inputs("of")) {
    const std::vector<std::string>& columns = node.progress_columns;  // empty: as of the first replicate
    if (columns.empty() || std::find(columns.begin(), columns.end(), "gap") != columns.end()) continue;
    rules.broken("of", fmt::format("the optimum of '{}' is not known: only searches of objectives tell when "
                                   "they reached it",
                                   node.id));
  }
  rules.check("", [&] { arrange(entries_of(context.inputs("of")), keys()); });
  rules.enforce();
}

SearchRun run_to(const SearchLog& search, double gap) {
  for (std::size_t i = 0; i < search.values.size(); ++i) {
    if (search.values[i] <= gap) return {static_cast<double>(search.improved_at[i]), true};
  }
  return {static_cast<double>(search.evaluations), false};
}

}  // namespace coppice
