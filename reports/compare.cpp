#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "registry/suggest.h"
#include "registry/text.h"
#include "reports/cells.h"
#include "reports/comparison.h"

namespace coppice {
namespace {

/// Two things of one group, as indices of cells.
struct Pair {
  std::size_t first = 0, second = 0;
};

/// What is compared: cells in groups, and the pairs among them.
struct Arrangement {
  std::vector<TableCell> cells;
  std::vector<Pair> pairs;
};

/// Evaluated policies two by two.
struct CompareNode : Node {
  References of;
  std::vector<std::string> by = {"policy"};
  std::vector<std::string> within;
  std::string baseline;
  Metric metric = Metric::cost;
  Direction better = Direction::automatic;

  std::vector<std::string> makes() const override { return {"table", "timing"}; }
  bool gathers(std::string_view) const override { return true; }
  bool shows_labels() const override { return true; }
  bool random() const override { return false; }
  std::string published_in() const override { return "tables"; }

  void check(const NodeContext& context) const override {
    Rules rules;
    refuse_replicates(*this, rules);
    rules.check("metric", [&] { require_metric(context.inputs("of"), metric); });
    rules.check("better", [&] { require_better(metric, better); });
    rules.check("", [&] { arranged(context); });
    rules.enforce();
  }

  void run(NodeContext& context) const override {
    const std::vector<InputNode>& nodes = context.inputs("of");
    const Arrangement what = arranged(context);
    std::vector<Side> sides;
    for (const TableCell& cell : what.cells) sides.push_back(read_side(nodes, cell, metric));
    std::vector<Comparison> comparisons;
    std::vector<double> p_values;
    for (const Pair& pair : what.pairs) {
      comparisons.push_back(compare(sides[pair.first], sides[pair.second], require_better(metric, better)));
      p_values.push_back(comparisons.back().p_value);
    }
    const std::vector<double> adjusted = holm_adjusted(p_values);
    Table table;
    table.columns = columns();
    rename_taken_keys(table, within.size());
    for (std::size_t i = 0; i < comparisons.size(); ++i) {
      std::vector<Cell>& row = table.rows.emplace_back();
      const TableCell& first = what.cells[what.pairs[i].first];
      for (std::size_t k = 0; k < within.size(); ++k) row.emplace_back(first.keys[k]);
      row.emplace_back(name(first));
      row.emplace_back(name(what.cells[what.pairs[i].second]));
      add_values(row, comparisons[i], adjusted[i]);
    }
    write_table(context.folder() / kTableFile, table);
  }

  static Parameters<CompareNode> parameters() {
    using This = CompareNode;
    return node_parameters<This>()
        .references("of", &This::of, "score", "Evaluations to compare; or fits, for their metrics.")
        .add("by", &This::by, "",
             "What tells apart what is compared: columns of sweeps, problem, policy, node (the evaluation's "
             "id).")
        .add("within", &This::within, "", "What must be equal in what is compared, likewise.")
        .add(
            "baseline", &This::baseline, "",
            "Compare everything with this one only (several columns: values separated by ', '); empty: every "
            "pair.")
        .choice("metric", &This::metric, metric_names(), "What is compared.")
        .choice("better", &This::better, direction_names(),
                "Which values are good; auto: high returns, low costs. steps and terminal_rate have none of "
                "their own.");
  }

 private:
  std::string name(const TableCell& cell) const {
    return join({cell.keys.begin() + static_cast<std::ptrdiff_t>(within.size()), cell.keys.end()}, ", ");
  }

  /// The baseline may be written as the config has it: "10 deg" is the angle that tables show in radians.
  bool is_baseline(const TableCell& cell) const {
    if (name(cell) == baseline) return true;
    const std::vector<std::string_view> items = split_list(baseline);
    if (items.size() != by.size()) return false;
    for (std::size_t i = 0; i < items.size(); ++i) {
      const std::size_t key = within.size() + i;
      if (!same_key(items[i], cell.keys[key], cell.unit(key))) return false;
    }
    return true;
  }

  Arrangement arranged(const NodeContext& context) const {
    Arrangement what;
    what.cells = arrange(entries_of(context.inputs("of")), {within, by, "by and within", "within", "by"});
    std::vector<std::string> names;
    const auto group = [&](std::size_t i) {
      const std::vector<std::string>& keys = what.cells[i].keys;
      return std::vector<std::string>(keys.begin(),
                                      keys.begin() + static_cast<std::ptrdiff_t>(within.size()));
    };
    for (std::size_t i = 0; i < what.cells.size(); ++i) {
      names.push_back(name(what.cells[i]));
      for (std::size_t j = i + 1; j < what.cells.size(); ++j) {
        if (group(i) != group(j)) continue;
        if (baseline.empty() || is_baseline(what.cells[j])) {
          what.pairs.push_back({i, j});
        } else if (is_baseline(what.cells[i])) {
          what.pairs.push_back({j, i});
        }
      }
    }
    const auto is_it = [&](const TableCell& cell) { return is_baseline(cell); };
    if (!baseline.empty() && std::none_of(what.cells.begin(), what.cells.end(), is_it)) {
      throw std::invalid_argument(
          fmt::format("baseline: nothing here is called '{}'; {}", baseline, suggestion(baseline, names)));
    }
    if (what.pairs.empty()) {
      throw std::invalid_argument("there is nothing to compare: by and within leave one thing in each group");
    }
    return what;
  }

  std::vector<ColumnInfo> columns() const {
    using Type = ColumnInfo::Type;
    std::vector<ColumnInfo> all;
    for (const std::string& key : within) all.push_back({key, Type::text, "", "Equal in both."});
    const std::string what = metric_doc(metric);
    const std::vector<ColumnInfo> values = {
        {"first", Type::text, "", "One of them."},
        {"second", Type::text, "", "The other one."},
        {"n_replicates", Type::integer, "", "Training runs, of the one that has fewer."},
        {"episodes", Type::integer, "", "Episodes of each evaluation, of the one that has fewer."},
        {"mean_first", Type::number, "", fmt::format("Mean {} of the first.", what)},
        {"mean_second", Type::number, "", "That of the second."},
        {"difference", Type::number, "", "mean_first minus mean_second."},
        {"ci95_low", Type::number, "", "Lower end of the 95 % interval of the difference."},
        {"ci95_high", Type::number, "", "Upper end of that interval."},
        {"p_value", Type::number, "", "Two-sided p-value of no difference."},
        {"p_holm", Type::number, "", "The same after Holm's correction for all rows of this table."},
        {"improvement", Type::number, "",
         "Probability that a training run (without: an episode) of the first is better than one of the "
         "second."},
        {"improvement_ci95_low", Type::number, "", "Lower end of its 95 % interval."},
        {"improvement_ci95_high", Type::number, "", "Upper end of that interval."},
        {"method", Type::text, "",
         "paired runs: replicate by replicate; paired episodes: scenario by scenario; Welch: independent "
         "samples; Newcombe: independent shares."},
        {"caution", Type::text, "", "Why the interval may cover less than 95 %; else empty."}};
    all.insert(all.end(), values.begin(), values.end());
    return all;
  }

  static void add_values(std::vector<Cell>& row, const Comparison& c, double adjusted) {
    const auto add_interval = [&](const std::optional<Interval>& interval) {
      row.push_back(interval ? Cell(interval->low) : Cell());
      row.push_back(interval ? Cell(interval->high) : Cell());
    };
    row.emplace_back(static_cast<std::int64_t>(c.replicates));
    row.emplace_back(c.episodes);
    row.emplace_back(c.mean_first);
    row.emplace_back(c.mean_second);
    row.emplace_back(c.difference);
    add_interval(c.ci95);
    row.emplace_back(c.p_value);
    row.emplace_back(adjusted);
    row.emplace_back(c.improvement.probability);
    add_interval(c.improvement.ci95);
    row.emplace_back(c.method);
    row.push_back(c.caution.empty() ? Cell() : Cell(c.caution));
  }
};

const Component<Node, CompareNode> kCompareNode(
    "compare",
    "Compare evaluated policies two by two: difference with interval, p-value, who is likely better.",
    "Welch 1947; Newcombe 1998 (shares); Holm 1979; Agarwal et al. 2021 (probability of improvement)", 4);

}  // namespace
}  // namespace coppice
