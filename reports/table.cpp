#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/statistics/profiles.h"
#include "reports/cell_summary.h"
#include "reports/known_values.h"

namespace coppice {
namespace {

/// A summary of evaluations, a row for each combination of keys.
struct TableNode : Node {
  using Node::check;

  References of;
  std::vector<std::string> rows, columns;
  Metric metric = Metric::cost;
  Direction better = Direction::automatic;
  IntervalMethod interval = IntervalMethod::t;
  FilePath published, reference_file;
  std::optional<double> reference;

  std::vector<std::string> makes() const override { return {"table", "timing"}; }
  bool gathers(std::string_view) const override { return true; }
  bool shows_labels() const override { return true; }
  bool random() const override { return false; }
  std::string published_in() const override { return "tables"; }

  void check() const {
    if (reference && !reference_file.path.empty()) {
      throw std::invalid_argument("give either reference, a number, or reference_file");
    }
  }
  void check(const NodeContext& context) const override {
    Rules rules;
    refuse_replicates(*this, rules);
    const std::vector<InputNode>& nodes = context.inputs("of");
    rules.check("metric", [&] { require_metric(nodes, metric); });
    if (reference || !reference_file.path.empty())
      rules.check("better", [&] { require_better(metric, better); });
    const TableKeys keys{rows, columns};
    std::vector<TableCell> cells;
    rules.check("", [&] { cells = arrange(entries_of(nodes), keys); });
    if (!cells.empty()) {
      rules.check("published", [&] { known_values(published, keys, cells); });
      rules.check("reference_file", [&] { known_values(reference_file, keys, cells); });
    }
    rules.enforce();
  }

  void run(NodeContext& context) const override {
    const TableKeys keys{rows, columns};
    const std::vector<TableCell> cells = arrange(entries_of(context.inputs("of")), keys);
    const KnownValues published_values = known_values(published, keys, cells);
    const KnownValues references = known_values(reference_file, keys, cells);
    Table table;
    add_key_columns(table, keys, cells);
    add_value_columns(table);
    rename_taken_keys(table, rows.size() + columns.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const TableCell& cell = cells[i];
      const double target = reference ? *reference : references.find(cell);
      add_values(table.rows[i],
                 summarize(context.inputs("of"), cell, metric, coppice::better(metric, better), interval),
                 published_values.find(cell), target);
    }
    write_table(context.folder() / kTableFile, table);
  }

  static Parameters<TableNode> parameters() {
    using This = TableNode;
    return node_parameters<This>()
        .references("of", &This::of, "score", "Evaluations to summarize; or fits, for their metrics.")
        .add("rows", &This::rows, "",
             "What tells the rows apart: columns of sweeps, problem, policy, node (the evaluation's id).")
        .add("columns", &This::columns, "", "What tells the columns apart, likewise.")
        .choice("metric", &This::metric, metric_names(),
                "What is shown; rmse, r2 and leaves are of fits, on their test set where they have one.")
        .choice("better", &This::better, direction_names(),
                "Which values are good; auto: high returns, low costs. steps and terminal_rate have none of "
                "their own: without it worst and best stay empty, and there is no reference.")
        .choice(
            "interval", &This::interval, {"t", "bootstrap"},
            "Interval of the mean: Student's, wider where values are skewed; or the studentized bootstrap "
            "over training runs and the episodes in them (over episodes of a policy that was not learned), "
            "from 10 on.")
        .add("published", &This::published, "",
             "CSV file of published values: column value, and keys of the table.")
        .automatic("reference", &This::reference, "", "Best value known, for every cell; auto: none.")
        .add("reference_file", &This::reference_file, "",
             "CSV file of the best values known, like that of published.");
  }

 private:
  static KnownValues known_values(const FilePath& file, const TableKeys& keys,
                                  const std::vector<TableCell>& cells) {
    return file.path.empty() ? KnownValues() : KnownValues(file.path, keys, cells);
  }

  void add_value_columns(Table& table) const {
    using Type = ColumnInfo::Type;
    const std::string what = metric_doc(metric);
    const std::vector<ColumnInfo> columns_of_values = {
        {"n_replicates", Type::integer, "", "Training runs, or other independent repetitions."},
        {"episodes", Type::integer, "", "Episodes of each evaluation; samples a fit is scored on."},
        {"mean", Type::number, "", fmt::format("Mean {}: over the replicates of their means.", what)},
        {"ci95_low", Type::number, "",
         "Lower end of the 95 % interval of the mean: over training runs; over episodes "
         "of a policy that was not learned."},
        {"ci95_high", Type::number, "", "Upper end of that interval."},
        {"iqm", Type::number, "", "Interquartile mean of the replicates."},
        {"worst", Type::number, "", "Worst replicate; empty unless it is known which values are good."},
        {"best", Type::number, "", "Best replicate, likewise."},
        {"published", Type::number, "", "Published value."},
        {"reference", Type::number, "", "Best value known, or near the optimum."},
        {"optimality_gap", Type::number, "",
         "Mean over replicates of what they miss the reference by; those that reach it count 0."},
        {"iqm_ci95_low", Type::number, "",
         "Lower end of the 95 % interval of iqm over replicates, from 5 on (that of a trimmed mean)."},
        {"iqm_ci95_high", Type::number, "", "Upper end of that interval."},
        {"caution", Type::text, "", "Why the interval of the mean may cover less than 95 %; else empty."},
        {"median", Type::number, "", "Median of the replicates."}};
    table.columns.insert(table.columns.end(), columns_of_values.begin(), columns_of_values.end());
  }

  void add_values(std::vector<Cell>& row, const CellSummary& summary, double known, double target) const {
    const Estimate& estimate = summary.estimate;
    row.emplace_back(static_cast<std::int64_t>(summary.replicates.size()));
    row.emplace_back(summary.episodes);
    row.emplace_back(estimate.mean);
    add_interval(row, estimate.ci95);
    row.emplace_back(estimate.iqm);
    row.emplace_back(estimate.worst);
    row.emplace_back(estimate.best);
    row.emplace_back(known);
    row.emplace_back(target);
    row.emplace_back(std::isnan(target)
                         ? target
                         : optimality_gap(summary.replicates, target, require_better(metric, better)));
    add_interval(row, summary.iqm_ci95);
    row.push_back(summary.caution.empty() ? Cell() : Cell(summary.caution));
    row.emplace_back(estimate.median);
  }
  static void add_interval(std::vector<Cell>& row, const std::optional<Interval>& interval) {
    row.emplace_back(interval ? interval->low : kUnknown);
    row.emplace_back(interval ? interval->high : kUnknown);
  }
};

const Component<Node, TableNode> kTableNode(
    "table", "Summarize evaluations: mean, interval, interquartile mean, worst and best of replicates.",
    "Agarwal et al. 2021 (interquartile mean, optimality gap)", 7);

}  // namespace
}  // namespace coppice
