#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "engine/data/file_system.h"
#include "engine/graph/artifacts.h"
#include "engine/statistics/profiles.h"
#include "registry/suggest.h"
#include "reports/cell_summary.h"
#include "reports/figure_data.h"
#include "reports/units.h"
#include "reports/vega_lite.h"

namespace coppice {
namespace {

using Type = ColumnInfo::Type;

bool makes(const InputNode& node, const std::string& artifact) {
  return std::find(node.makes.begin(), node.makes.end(), artifact) != node.makes.end();
}

/// A figure as data: a tidy table, and a Vega-Lite specification that draws it.
struct FigureNode : Node {
  References of;
  FigureKind kind = FigureKind::line;
  std::string x, y = "cost";
  std::vector<std::string> by;
  std::optional<std::int64_t> bins;

  std::vector<std::string> makes() const override { return {"figure"}; }
  bool gathers(std::string_view) const override { return true; }
  bool shows_labels() const override { return true; }
  bool random() const override { return false; }
  std::string published_in() const override { return "figures"; }

  void check(const NodeContext& context) const override {
    const std::vector<InputNode>& nodes = context.inputs("of");
    const bool learning = is_learning(nodes);
    if (learning && kind != FigureKind::line) {
      throw std::invalid_argument(
          "only evaluations have histograms, intervals and profiles; evaluate what "
          "was learned");
    }
    if (kind != FigureKind::line && !x.empty()) throw std::invalid_argument("only a line has an x");
    if (!learning) {
      metric();
      if (kind == FigureKind::line && (x.empty() || is_time(x))) {
        throw std::invalid_argument(
            "give x, a column of a sweep; only learning nodes have a course over iterations or time");
      }
    }
    cells(nodes);
  }

  void run(NodeContext& context) const override {
    const std::vector<InputNode>& nodes = context.inputs("of");
    Table table;
    const std::vector<TableCell> arranged = cells(nodes);
    Table keys;
    const bool swept = kind == FigureKind::line && !is_learning(nodes);
    std::vector<std::string> names = by;
    if (swept) names.push_back(x);
    add_key_columns(keys, {names, {}}, arranged);
    if (is_learning(nodes)) {
      learning(nodes, arranged, keys, table);
    } else if (kind == FigureKind::histogram) {
      histogram(nodes, arranged, keys, table);
    } else if (kind == FigureKind::profile) {
      profile(nodes, arranged, keys, table);
    } else {
      summaries(nodes, arranged, keys, table);
    }
    rename_taken_keys(table, names.size());
    write_table(context.folder() / kTableFile, table);
    for (std::string& name : names) name = key_column(table, name);
    const std::string abscissa = swept ? names.back() : x_name(nodes);
    names.resize(by.size());
    write_file(context.folder() / "table.vl.json", vega_lite(table, {kind, abscissa, y, names}));
  }

  static Parameters<FigureNode> parameters() {
    using This = FigureNode;
    return node_parameters<This>()
        .references("of", &This::of, "timing", "Learning nodes, or evaluations.")
        .choice("kind", &This::kind, {"line", "histogram", "interval", "profile"},
                "Mean and band over x, distribution, means with intervals, or share of runs better than a "
                "threshold.")
        .add("x", &This::x, "",
             "Of a line: for evaluations a column of a sweep; for learning nodes a column of their progress, "
             "cpu_s or wall_s (such a figure differs from run to run); empty: iteration.")
        .add("y", &This::y, "",
             "For evaluations a metric as tables have it; for learning nodes a column of their progress.")
        .add("by", &This::by, "", "What tells lines apart: columns of sweeps, problem, policy, node.")
        .automatic("bins", &This::bins, "", "Bins of a histogram; auto: the Freedman-Diaconis rule.",
                   between(1, 10000));
  }

 private:
  static bool is_learning(const std::vector<InputNode>& nodes) {
    const auto learns = [](const InputNode& node) { return coppice::makes(node, "progress"); };
    const auto count = std::count_if(nodes.begin(), nodes.end(), learns);
    for (const InputNode& node : nodes) {
      if (learns(node) || coppice::makes(node, "evaluation")) continue;
      throw std::invalid_argument(
          fmt::format("'{}' (<{}>) neither learns nor evaluates", node.id, node.kind));
    }
    if (count != 0 && count != static_cast<std::ptrdiff_t>(nodes.size())) {
      throw std::invalid_argument("of: learning nodes and evaluations do not go into one figure");
    }
    return count != 0;
  }

  Metric metric() const {
    const std::vector<std::string> names = metric_names();
    const auto found = std::find(names.begin(), names.end(), y);
    if (found == names.end()) {
      throw std::invalid_argument(fmt::format("y: '{}' is no metric; {}", y, suggestion(y, names)));
    }
    return static_cast<Metric>(found - names.begin());
  }

  std::string x_name(const std::vector<InputNode>& nodes) const {
    return is_learning(nodes) && x.empty() ? "iteration" : x;
  }

  std::vector<TableCell> cells(const std::vector<InputNode>& nodes) const {
    std::vector<std::string> names = by;
    if (kind == FigureKind::line && !is_learning(nodes)) names.push_back(x);
    return arrange(entries_of(nodes), {names, {}, "by and x"});
  }

  static void add_estimate_columns(Table& table, const std::string& what) {
    table.columns.push_back({"n", Type::integer, "", "Training runs, or other independent repetitions."});
    table.columns.push_back({"mean", Type::number, "", fmt::format("Mean {}.", what)});
    table.columns.push_back({"ci95_low", Type::number, "", "Lower end of its 95 % interval."});
    table.columns.push_back({"ci95_high", Type::number, "", "Upper end of that interval."});
  }

  static void add_estimate(std::vector<Cell>& row, const Estimate& estimate) {
    row.emplace_back(static_cast<std::int64_t>(estimate.units));
    row.emplace_back(estimate.mean);
    row.push_back(estimate.ci95 ? Cell(estimate.ci95->low) : Cell());
    row.push_back(estimate.ci95 ? Cell(estimate.ci95->high) : Cell());
  }

  void learning(const std::vector<InputNode>& nodes, const std::vector<TableCell>& arranged,
                const Table& keys, Table& table) const {
    constexpr std::size_t kTimes = 200;
    const std::string abscissa = x_name(nodes);
    table.columns = keys.columns;
    table.columns.push_back({abscissa, Type::number, is_time(abscissa) ? "s" : "",
                             is_time(abscissa) ? "Time of learning; differs from run to run." : "Progress."});
    add_estimate_columns(table, y);
    for (std::size_t i = 0; i < arranged.size(); ++i) {
      std::vector<Curve> curves;
      for (const std::size_t entry : arranged[i].entries)
        curves.push_back(read_curve(nodes[entry], abscissa, y));
      for (const CurvePoint& point : mean_curve(curves, is_time(abscissa) ? kTimes : 0)) {
        table.rows.push_back(keys.rows[i]);
        table.rows.back().emplace_back(point.x);
        add_estimate(table.rows.back(), point.estimate);
      }
    }
  }

  void summaries(const std::vector<InputNode>& nodes, const std::vector<TableCell>& arranged,
                 const Table& keys, Table& table) const {
    table = keys;
    add_estimate_columns(table, metric_doc(metric()));
    for (std::size_t i = 0; i < arranged.size(); ++i) {
      add_estimate(table.rows[i], summarize(nodes, arranged[i], metric()).estimate);
    }
  }

  /// The means of training runs, or the values of episodes.
  std::vector<double> values(const std::vector<InputNode>& nodes, const TableCell& cell) const {
    const Units units = units_of(nodes, cell, metric());
    std::vector<double> values;
    if (!units.are_runs) values = observe_episodes(nodes[cell.entries.front()], metric());
    if (!values.empty()) return values;
    for (const Run& run : units.runs) values.push_back(run.mean);
    return values;
  }

  void histogram(const std::vector<InputNode>& nodes, const std::vector<TableCell>& arranged,
                 const Table& keys, Table& table) const {
    table.columns = keys.columns;
    table.columns.push_back({"bin_low", Type::number, "", "Where the bin begins."});
    table.columns.push_back({"bin_high", Type::number, "", "Where it ends; the last bin holds its end."});
    table.columns.push_back({"count", Type::integer, "", "Training runs in it, or episodes."});
    std::vector<std::vector<double>> groups;
    std::vector<double> all;
    for (const TableCell& cell : arranged) {
      groups.push_back(values(nodes, cell));
      all.insert(all.end(), groups.back().begin(), groups.back().end());
    }
    const std::vector<double> ends = bin_ends(all, static_cast<std::size_t>(bins.value_or(0)));
    for (std::size_t i = 0; i < groups.size(); ++i) {
      std::vector<std::int64_t> counts(ends.size() - 1);
      for (const double value : groups[i]) {
        const auto after = std::upper_bound(ends.begin() + 1, ends.end() - 1, value);
        ++counts[static_cast<std::size_t>(after - ends.begin()) - 1];
      }
      for (std::size_t b = 0; b < counts.size(); ++b) {
        table.rows.push_back(keys.rows[i]);
        table.rows.back().insert(table.rows.back().end(), {ends[b], ends[b + 1], counts[b]});
      }
    }
  }

  void profile(const std::vector<InputNode>& nodes, const std::vector<TableCell>& arranged, const Table& keys,
               Table& table) const {
    constexpr std::size_t kThresholds = 100;
    table.columns = keys.columns;
    table.columns.push_back({"threshold", Type::number, "", fmt::format("Of {}.", metric_doc(metric()))});
    table.columns.push_back(
        {"share", Type::number, "", "Share of training runs, or episodes, better than it."});
    table.columns.push_back({"ci95_low", Type::number, "", "Lower end of its 95 % interval."});
    table.columns.push_back({"ci95_high", Type::number, "", "Upper end of that interval."});
    std::vector<std::vector<double>> groups;
    std::vector<double> all;
    for (const TableCell& cell : arranged) {
      groups.push_back(values(nodes, cell));
      all.insert(all.end(), groups.back().begin(), groups.back().end());
    }
    const std::vector<double> thresholds = bin_ends(all, kThresholds);
    for (std::size_t i = 0; i < groups.size(); ++i) {
      for (const ProfilePoint& point : performance_profile(groups[i], thresholds, better(metric()))) {
        table.rows.push_back(keys.rows[i]);
        table.rows.back().insert(table.rows.back().end(),
                                 {point.threshold, point.share, point.ci95.low, point.ci95.high});
      }
    }
  }
};

const Component<Node, FigureNode> kComponent(
    "figure", "Make a figure: tidy data, and a Vega-Lite specification that draws it.",
    "Agarwal et al. 2021 (performance profiles)", 2);

}  // namespace
}  // namespace coppice
