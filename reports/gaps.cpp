#include <limits>
#include <vector>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/statistics/estimates.h"
#include "reports/cells.h"
#include "reports/searches.h"

namespace coppice {
namespace {

/// How near to the optimum the points lie that searches return, whatever they tried.
struct GapsNode : SearchReport {
  void run(NodeContext& context) const override {
    const std::vector<InputNode>& nodes = context.inputs("of");
    const std::vector<TableCell> cells = arrange(entries_of(nodes), keys());
    Table table;
    add_key_columns(table, keys(), cells);
    using Type = ColumnInfo::Type;
    const std::vector<ColumnInfo> columns = {
        {"n_replicates", Type::integer, "", "Searches."},
        {"evaluations", Type::number, "", "Mean number of evaluations that they made."},
        {"median", Type::number, "",
         "Median of what the returned points miss the optimum by, without noise."},
        {"median_high95", Type::number, "",
         "One-sided 95 % upper bound of the median (order statistic, from 5 searches on); empty: none."},
        {"mean", Type::number, "", "Mean of the gaps."},
        {"worst", Type::number, "", "Largest gap."},
        {"best", Type::number, "", "Least gap."}};
    table.columns.insert(table.columns.end(), columns.begin(), columns.end());
    rename_taken_keys(table, rows.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      std::vector<double> gaps, evaluations;
      for (const std::size_t entry : cells[i].entries) {
        const SearchLog search = read_search(nodes[entry]);
        gaps.push_back(search.gap.value_or(std::numeric_limits<double>::quiet_NaN()));
        evaluations.push_back(static_cast<double>(search.evaluations));
      }
      const Estimate estimated = estimate(gaps, Better::lower);
      const std::optional<double> bound = median_upper_bound(gaps);
      std::vector<Cell>& row = table.rows[i];
      row.emplace_back(static_cast<std::int64_t>(gaps.size()));
      row.emplace_back(mean(evaluations));
      row.emplace_back(estimated.median);
      row.push_back(bound ? Cell(*bound) : Cell());
      row.emplace_back(estimated.mean);
      row.emplace_back(estimated.worst);
      row.emplace_back(estimated.best);
    }
    write_table(context.folder() / kTableFile, table);
  }

  static Parameters<GapsNode> parameters() { return search_report_parameters<GapsNode>(); }
};

const Component<Node, GapsNode> kGapsNode(
    "gaps", "How near searches came to the optimum: median with bound, mean, worst and best.",
    "no publication");

}  // namespace
}  // namespace coppice
