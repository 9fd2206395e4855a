#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/statistics/estimates.h"
#include "reports/cells.h"

namespace coppice {
namespace {

enum class Time { cpu, wall, episode, action };
constexpr std::array<const char*, 4> kTimeColumns = {"cpu_s", "wall_s", "episode_s", "action_s"};
enum class Per { node, episodes, steps, iterations, samples };
constexpr std::array<const char*, 5> kCounters = {"", "episodes", "steps", "iterations", "samples"};

/// What nodes cost in time (as thesis Figs. 2.8 and 2.9 show evaluation and learning). Times are no results:
/// they stand beside them, and only here become figures, whose bytes differ from run to run.
struct TimingsNode : Node {
  References of;
  std::vector<std::string> rows, columns;
  Time time = Time::cpu;
  Per per = Per::node;

  std::vector<std::string> makes() const override { return {"timings"}; }
  bool gathers(std::string_view) const override { return true; }
  bool shows_labels() const override { return true; }
  bool random() const override { return false; }
  std::string published_in() const override { return "figures"; }

  void check(const NodeContext& context) const override {
    Rules rules;
    refuse_replicates(*this, rules);
    rules.check("", [&] { arrange(entries_of(context.inputs("of")), {rows, columns}); });
    rules.enforce();
  }

  void run(NodeContext& context) const override {
    const std::vector<InputNode>& nodes = context.inputs("of");
    const TableKeys keys{rows, columns};
    const std::vector<TableCell> cells = arrange(entries_of(nodes), keys);
    using Type = ColumnInfo::Type;
    Table table;
    table.reproducible = false;
    add_key_columns(table, keys, cells);
    table.columns.push_back({"n", Type::integer, "", "Nodes measured."});
    table.columns.push_back({"mean_s", Type::number, "s", fmt::format("Mean {}.", doc_of_value())});
    table.columns.push_back({"ci95_low_s", Type::number, "s", "Lower end of the 95 % interval of the mean."});
    table.columns.push_back({"ci95_high_s", Type::number, "s", "Upper end of that interval."});
    table.columns.push_back({"median_s", Type::number, "s", "Median."});
    table.columns.push_back({"max_s", Type::number, "s", "Longest."});
    rename_taken_keys(table, rows.size() + columns.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      std::vector<double> values;
      for (const std::size_t entry : cells[i].entries) {
        const double value = measured(nodes[entry]);
        if (!std::isnan(value)) values.push_back(value);
      }
      add_values(table.rows[i], values);
    }
    write_table(context.folder() / kTableFile, table);
  }

  static Parameters<TimingsNode> parameters() {
    using This = TimingsNode;
    return node_parameters<This>()
        .references("of", &This::of, "timing", "Nodes whose times are shown.")
        .add("rows", &This::rows, "",
             "What tells the rows apart: columns of sweeps, problem, policy, node (the node's id).")
        .add("columns", &This::columns, "", "What tells the columns apart, likewise.")
        .choice("time", &This::time, {"cpu", "wall", "episode", "action"},
                "CPU or wall time of the node, or CPU time of one episode or one action of an evaluation.")
        .choice("per", &This::per, {"node", "episodes", "steps", "iterations", "samples"},
                "What the time is divided by.");
  }

 private:
  std::string doc_of_value() const {
    const std::string column = kTimeColumns.at(static_cast<std::size_t>(time));
    return per == Per::node ? column : column + " divided by " + kCounters.at(static_cast<std::size_t>(per));
  }

  /// NaN when the node did not measure it.
  double measured(const InputNode& node) const {
    const Table timing = read_table(node.folder / "timing.csv");
    const auto value = [&](const char* column) {
      return timing.has(column) ? number(timing.rows.at(0)[timing.column(column)]) : kUnknown;
    };
    const double seconds = value(kTimeColumns.at(static_cast<std::size_t>(time)));
    return per == Per::node ? seconds : seconds / value(kCounters.at(static_cast<std::size_t>(per)));
  }

  static void add_values(std::vector<Cell>& row, const std::vector<double>& values) {
    const Estimate summary = estimate(values, Better::lower);
    row.emplace_back(static_cast<std::int64_t>(values.size()));
    row.emplace_back(summary.mean);
    row.emplace_back(summary.ci95 ? summary.ci95->low : kUnknown);
    row.emplace_back(summary.ci95 ? summary.ci95->high : kUnknown);
    row.emplace_back(summary.median);
    row.emplace_back(summary.worst);
  }
};

const Component<Node, TimingsNode> kTimingsNode("timings", "Show what nodes cost in time.", "no publication",
                                                2);

}  // namespace
}  // namespace coppice
