#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "engine/data/file_system.h"
#include "engine/graph/artifacts.h"
#include "registry/suggest.h"
#include "reports/cells.h"
#include "reports/figure_data.h"
#include "reports/figure_table.h"
#include "reports/vega_lite.h"

namespace coppice {
namespace {

bool makes(const InputNode& node, const std::string& artifact) {
  return std::find(node.makes.begin(), node.makes.end(), artifact) != node.makes.end();
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// A figure as data: a tidy table, and a Vega-Lite specification that draws it.
struct FigureNode : Node {
  /// What a figure is drawn of.
  enum class Source { learning, datasets, metrics };

  References of, observations;
  FigureKind kind = FigureKind::line;
  std::string x, y = "cost";
  std::vector<std::string> by;
  std::optional<std::int64_t> bins;
  Direction better = Direction::automatic;

  std::vector<std::string> makes() const override { return {"figure"}; }
  bool gathers(std::string_view) const override { return true; }
  bool shows_labels() const override { return true; }
  bool random() const override { return false; }
  std::string published_in() const override { return "figures"; }

  void check(const NodeContext& context) const override {
    const std::vector<InputNode>& nodes = context.inputs("of");
    Rules rules;
    refuse_replicates(*this, rules);
    check_kind(rules);
    std::optional<Source> source;
    rules.check("of", [&] { source = source_of(nodes); });
    if (source) check_source(*source, context, rules);
    if (source && !(*source == Source::metrics && lacks_x()))
      rules.check("by", [&] {
        arrange(entries_of(drawn(context)), {by, x_keys(nodes), "by and x", "by", "x"});
      });
    rules.enforce();
  }

  void run(NodeContext& context) const override {
    const std::vector<InputNode> nodes = drawn(context);
    const std::vector<TableCell> arranged = groups(nodes);
    const bool swept = kind == FigureKind::line && source_of(nodes) == Source::metrics;
    std::vector<std::string> names = keys(nodes);
    Table key_table;
    add_key_columns(key_table, {names, {}}, arranged);
    Table table = data({nodes, arranged, key_table, context.inputs("of").size()});
    rename_taken_keys(table, names.size());
    write_table(context.folder() / kTableFile, table);
    for (std::string& name : names) name = key_column(table, name);
    const std::string abscissa = swept ? names.back() : learning_x();
    names.resize(by.size());
    write_file(context.folder() / "table.vl.json",
               vega_lite(table, {kind, abscissa, y, names, swept, !observations.empty()}));
  }

  static Parameters<FigureNode> parameters() {
    using This = FigureNode;
    return node_parameters<This>()
        .references("of", &This::of, "timing",
                    "Learning nodes, datasets, or evaluations or fits for their metrics.")
        .references("observations", &This::observations, "dataset",
                    "Datasets whose rows are drawn as points beside lines of datasets.", false)
        .choice("kind", &This::kind, {"line", "histogram", "interval", "profile"},
                "Mean and band over x, distribution, means with intervals, or share of runs better than a "
                "threshold.")
        .add("x", &This::x, "",
             "Of a line: for metrics a column of a sweep; of datasets a column; for learning nodes a column "
             "of "
             "their progress, "
             "cpu_s or wall_s (such a figure differs from run to run); empty: iteration.")
        .add("y", &This::y, "",
             "A metric as tables have it; for learning nodes a column of their progress, for datasets a "
             "column.")
        .add("by", &This::by, "", "What tells lines apart: columns of sweeps, problem, policy, node.")
        .automatic("bins", &This::bins, "",
                   "Bins of a histogram; auto: the Freedman-Diaconis rule, whole widths for whole numbers.",
                   between(1, 10000))
        .choice("better", &This::better, direction_names(),
                "Of a profile: which values are good; auto: high returns, low costs. steps and terminal_rate "
                "have none of their own.");
  }

 private:
  static Source source_of(const InputNode& node) {
    if (coppice::makes(node, "progress")) return Source::learning;
    if (coppice::makes(node, "dataset")) return Source::datasets;
    if (coppice::makes(node, "score")) return Source::metrics;
    throw std::invalid_argument(
        fmt::format("'{}' (<{}>) neither learns nor evaluates, and is no dataset", node.id, node.kind));
  }
  static Source source_of(const std::vector<InputNode>& nodes) {
    const Source source = source_of(nodes.front());
    for (const InputNode& node : nodes) {
      if (source_of(node) == source) continue;
      throw std::invalid_argument(
          "of: learning nodes, datasets and what has metrics do not go into one figure");
    }
    return source;
  }

  /// Of metrics.
  bool lacks_x() const { return kind == FigureKind::line && (x.empty() || is_time(x)); }

  /// That nothing is given which this kind of figure would not heed.
  void check_kind(Rules& rules) const {
    if (kind != FigureKind::histogram && bins) rules.broken("bins", "only a histogram has bins");
    if (kind != FigureKind::profile && better != Direction::automatic) {
      rules.broken("better", "better: only of a profile does it matter which values are good");
    }
  }

  void check_source(Source source, const NodeContext& context, Rules& rules) const {
    const std::vector<InputNode>& nodes = context.inputs("of");
    if (source != Source::datasets && !observations.empty())
      rules.broken("observations", "observations lie beside lines of datasets only");
    if (source == Source::learning) return check_learning(nodes, rules);
    if (source == Source::datasets) {
      check_datasets(rules);
      check_dataset_columns(nodes, rules);
      return check_dataset_columns(context.inputs("observations"), rules);
    }
    if (kind != FigureKind::line && !x.empty()) rules.broken("x", "only a line has an x");
    std::optional<Metric> shown;
    rules.check("y", [&] { shown = metric(); });
    if (shown) rules.check("y", [&] { require_metric(nodes, *shown); });
    if (shown && kind == FigureKind::profile) rules.check("better", [&] { require_better(*shown, better); });
    if (kind == FigureKind::profile || kind == FigureKind::histogram) check_episodes(nodes, rules);
    if (lacks_x()) {
      rules.broken("x",
                   "give x, a column of a sweep; only learning nodes have a course over iterations or time");
    }
  }

  std::vector<InputNode> drawn(const NodeContext& context) const {
    std::vector<InputNode> nodes = context.inputs("of");
    if (observations.empty()) return nodes;
    const std::vector<InputNode>& more = context.inputs("observations");
    nodes.insert(nodes.end(), more.begin(), more.end());
    return nodes;
  }

  /// That the progress of each node has x and y, as far as its columns are known.
  void check_learning(const std::vector<InputNode>& nodes, Rules& rules) const {
    if (kind != FigureKind::line) {
      rules.broken("kind", "only metrics have histograms, intervals and profiles; evaluate what was learned");
      return;
    }
    const bool taken = contains(estimate_column_names(), x);
    if (taken) rules.broken("x", fmt::format("x: a figure has a column '{}' of its own", x));
    for (const InputNode& node : nodes) {
      const std::vector<std::string>& known = node.progress_columns;
      if (known.empty()) continue;
      const auto check = [&](const char* parameter, const std::string& column) {
        if (contains(known, column)) return;
        rules.broken(parameter,
                     fmt::format("{}: the progress of '{}' has no column '{}'", parameter, node.id, column),
                     suggestion(column, known));
      };
      if (!is_time(x) && !taken) check("x", learning_x());
      check("y", y);
    }
  }

  /// That episodes were kept where these are the units.
  static void check_episodes(const std::vector<InputNode>& nodes, Rules& rules) {
    for (const InputNode& node : nodes) {
      if (node.replicate || !node.training.empty() || node.element->get("returns") != "false") continue;
      rules.broken("of", fmt::format("'{}' does not keep the episodes that this figure counts "
                                     "(returns=\"false\")",
                                     node.id));
    }
  }

  void check_datasets(Rules& rules) const {
    if (kind != FigureKind::line) rules.broken("kind", "of datasets there are lines only");
    if (x.empty() || x == y) rules.broken("x", "give x and y, two columns of the datasets");
    if (is_time(x) || contains(estimate_column_names(), x))
      rules.broken("x", fmt::format("x: a figure has a column '{}' of its own", x));
  }
  /// As far as their columns are known.
  void check_dataset_columns(const std::vector<InputNode>& nodes, Rules& rules) const {
    const auto check = [&](const InputNode& node, const char* parameter, const std::string& column) {
      if (column.empty() || node.columns.empty() || contains(node.columns, column)) return;
      rules.broken(parameter, fmt::format("the dataset '{}' has no column '{}'", node.id, column),
                   suggestion(column, node.columns));
    };
    for (const InputNode& node : nodes) {
      check(node, "x", x);
      check(node, "y", y);
    }
  }

  std::string learning_x() const { return x.empty() ? "iteration" : x; }

  Metric metric() const {
    const std::vector<std::string> names = metric_names();
    const auto found = std::find(names.begin(), names.end(), y);
    if (found == names.end()) {
      throw std::invalid_argument(fmt::format("y: '{}' is no metric; {}", y, suggestion(y, names)));
    }
    return static_cast<Metric>(found - names.begin());
  }

  /// What tells rows of the figure's table apart: `by`, and the x of metrics.
  std::vector<std::string> keys(const std::vector<InputNode>& nodes) const {
    std::vector<std::string> names = by;
    const std::vector<std::string> of_x = x_keys(nodes);
    names.insert(names.end(), of_x.begin(), of_x.end());
    return names;
  }
  std::vector<std::string> x_keys(const std::vector<InputNode>& nodes) const {
    if (kind == FigureKind::line && source_of(nodes) == Source::metrics) return {x};
    return {};
  }
  std::vector<TableCell> groups(const std::vector<InputNode>& nodes) const {
    return arrange(entries_of(nodes), {keys(nodes), {}, "by and x", "by", "by"});
  }

  Table data(const FigureInputs& inputs) const {
    if (source_of(inputs.nodes) != Source::metrics) return curve_table(inputs, learning_x(), y);
    switch (kind) {
      case FigureKind::histogram:
        return histogram_table(inputs, metric(), static_cast<std::size_t>(bins.value_or(0)));
      case FigureKind::profile:
        return profile_table(inputs, metric(), require_better(metric(), better));
      case FigureKind::line:
      case FigureKind::interval:
        break;
    }
    return interval_table(inputs, metric());
  }
};

const Component<Node, FigureNode> kFigureNode(
    "figure", "Make a figure: tidy data, and a Vega-Lite specification that draws it.",
    "Agarwal et al. 2021 (performance profiles)", 5);

}  // namespace
}  // namespace coppice
