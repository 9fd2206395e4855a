#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "reports/cells.h"
#include "reports/searches.h"

namespace coppice {
namespace {

/// How long searches take to come near the optimum, and how many do; a row for each target.
struct RuntimesNode : SearchReport {
  std::vector<double> targets = {1e1, 1e-1, 1e-3, 1e-5, 1e-8};

  void run(NodeContext& context) const override {
    const std::vector<InputNode>& nodes = context.inputs("of");
    const std::vector<TableCell> cells = arrange(entries_of(nodes), keys());
    Table named;
    add_key_columns(named, keys(), cells);
    Table table;
    table.columns = named.columns;
    add_value_columns(table);
    rename_taken_keys(table, rows.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      std::vector<SearchLog> searches;
      for (const std::size_t entry : cells[i].entries) searches.push_back(read_search(nodes[entry]));
      for (const double target : targets) {
        std::vector<Cell>& row = table.rows.emplace_back(named.rows[i]);
        add_values(row, searches, target);
      }
    }
    write_table(context.folder() / kTableFile, table);
  }

  static Parameters<RuntimesNode> parameters() {
    return search_report_parameters<RuntimesNode>().add("targets", &RuntimesNode::targets, "",
                                                        "Gaps to the optimum, a row for each.", at_least(0));
  }

 private:
  static void add_value_columns(Table& table) {
    using Type = ColumnInfo::Type;
    const std::vector<ColumnInfo> columns = {
        {"target", Type::number, "", "Gap to the optimum that a point tried must not exceed."},
        {"n_replicates", Type::integer, "", "Searches."},
        {"successes", Type::integer, "", "Those that reached the target."},
        {"success_rate", Type::number, "", "Their share."},
        {"success_ci95_low", Type::number, "", "Lower end of its 95 % interval (Wilson)."},
        {"success_ci95_high", Type::number, "", "Upper end of that interval."},
        {"ert", Type::number, "",
         "Expected running time: evaluations of all searches by successes; empty: none reached it."},
        {"ert_ci95_low", Type::number, "",
         "Lower end of its 95 % interval (bootstrap over searches, from 10 on)."},
        {"ert_ci95_high", Type::number, "", "Upper end of that interval; empty: no upper limit is known."},
        {"median", Type::number, "",
         "Median of the evaluations to the target, failures counted as infinite; empty: most failed."},
        {"median_high95", Type::number, "",
         "One-sided 95 % upper bound of the median (order statistic, from 5 searches on); empty: none."}};
    table.columns.insert(table.columns.end(), columns.begin(), columns.end());
  }

  static void add_values(std::vector<Cell>& row, const std::vector<SearchLog>& searches, double target) {
    std::vector<SearchRun> runs;
    std::vector<double> times;
    double successes = 0;
    for (const SearchLog& search : searches) {
      const SearchRun run = run_to(search, target);
      runs.push_back(run);
      times.push_back(run.reached ? run.evaluations : std::numeric_limits<double>::infinity());
      successes += run.reached ? 1 : 0;
    }
    const auto n = static_cast<double>(runs.size());
    const Interval share = share_interval(successes / n, n);
    // Resamples that are the same for all rows: what differs is not their luck.
    const auto interval = running_time_interval(runs, Draws(0, "runtimes", 0));
    const auto finite = [](double value) { return std::isfinite(value) ? Cell(value) : Cell(); };
    row.emplace_back(target);
    row.emplace_back(static_cast<std::int64_t>(runs.size()));
    row.emplace_back(static_cast<std::int64_t>(successes));
    row.emplace_back(successes / n);
    row.emplace_back(share.low);
    row.emplace_back(share.high);
    row.push_back(finite(expected_running_time(runs)));
    row.push_back(interval ? finite(interval->low) : Cell());
    row.push_back(interval ? finite(interval->high) : Cell());
    row.push_back(finite(median_time(times)));
    row.push_back(finite(median_upper_bound(times).value_or(std::numeric_limits<double>::infinity())));
  }

  /// Infinite where half of them are, or more.
  static double median_time(std::vector<double> times) {
    std::sort(times.begin(), times.end());
    return (times[(times.size() - 1) / 2] + times[times.size() / 2]) / 2;
  }
};

const Component<Node, RuntimesNode> kRuntimesNode(
    "runtimes", "Expected running times and success rates of searches, for several targets.",
    "Hansen et al., INRIA RR-6828 (2009) (expected running time); Wilson 1927 (success rate)");

}  // namespace
}  // namespace coppice
