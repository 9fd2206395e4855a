#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "engine/data/file_system.h"
#include "engine/graph/artifacts.h"
#include "registry/suggest.h"
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
    if (kind != FigureKind::line && !x.empty()) throw std::invalid_argument("only a line has an x");
    if (is_learning(nodes)) {
      check_learning(nodes);
    } else {
      metric();
      if (kind == FigureKind::line && (x.empty() || is_time(x))) {
        throw std::invalid_argument(
            "give x, a column of a sweep; only learning nodes have a course over iterations or time");
      }
    }
    groups(nodes);
  }

  void run(NodeContext& context) const override {
    const std::vector<InputNode>& nodes = context.inputs("of");
    const std::vector<TableCell> arranged = groups(nodes);
    const bool swept = kind == FigureKind::line && !is_learning(nodes);
    std::vector<std::string> names = keys(nodes);
    Table key_table;
    add_key_columns(key_table, {names, {}}, arranged);
    Table table = data({nodes, arranged, key_table});
    rename_taken_keys(table, names.size());
    write_table(context.folder() / kTableFile, table);
    for (std::string& name : names) name = key_column(table, name);
    const std::string abscissa = swept ? names.back() : learning_x();
    names.resize(by.size());
    write_file(context.folder() / "table.vl.json", vega_lite(table, {kind, abscissa, y, names, swept}));
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
        .automatic("bins", &This::bins, "",
                   "Bins of a histogram; auto: the Freedman-Diaconis rule, whole widths for whole numbers.",
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

  /// That the progress of each node has x and y, as far as its columns are known.
  void check_learning(const std::vector<InputNode>& nodes) const {
    if (kind != FigureKind::line) {
      throw std::invalid_argument(
          "only evaluations have histograms, intervals and profiles; evaluate what was learned");
    }
    if (contains(estimate_column_names(), x)) {
      throw std::invalid_argument(fmt::format("x: a figure has a column '{}' of its own", x));
    }
    for (const InputNode& node : nodes) {
      const std::vector<std::string>& known = node.progress_columns;
      if (known.empty()) continue;
      const auto check = [&](const char* parameter, const std::string& column) {
        if (contains(known, column)) return;
        throw std::invalid_argument(fmt::format("{}: the progress of '{}' has no column '{}'; {}", parameter,
                                                node.id, column, suggestion(column, known)));
      };
      if (!is_time(x)) check("x", learning_x());
      check("y", y);
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

  /// What tells rows of the figure's table apart: `by`, and the x of evaluations.
  std::vector<std::string> keys(const std::vector<InputNode>& nodes) const {
    std::vector<std::string> names = by;
    if (kind == FigureKind::line && !is_learning(nodes)) names.push_back(x);
    return names;
  }
  std::vector<TableCell> groups(const std::vector<InputNode>& nodes) const {
    return arrange(entries_of(nodes), {keys(nodes), {}, "by and x"});
  }

  Table data(const FigureInputs& inputs) const {
    if (is_learning(inputs.nodes)) return learning_table(inputs, learning_x(), y);
    switch (kind) {
      case FigureKind::histogram:
        return histogram_table(inputs, metric(), static_cast<std::size_t>(bins.value_or(0)));
      case FigureKind::profile:
        return profile_table(inputs, metric());
      case FigureKind::line:
      case FigureKind::interval:
        break;
    }
    return interval_table(inputs, metric());
  }
};

const Component<Node, FigureNode> kComponent(
    "figure", "Make a figure: tidy data, and a Vega-Lite specification that draws it.",
    "Agarwal et al. 2021 (performance profiles)", 3);

}  // namespace
}  // namespace coppice
