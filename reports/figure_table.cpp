#include "reports/figure_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/statistics/profiles.h"
#include "reports/cell_summary.h"
#include "reports/figure_data.h"
#include "reports/units.h"

namespace coppice {
namespace {

constexpr const char* kDrawn = "drawn";

void add_interval_columns(Table& table) {
  table.columns.push_back({"ci95_low", ColumnInfo::Type::number, "", "Lower end of its 95 % interval."});
  table.columns.push_back({"ci95_high", ColumnInfo::Type::number, "", "Upper end of that interval."});
}

void add_estimate_columns(Table& table, const std::string& what) {
  table.columns.push_back(
      {"n", ColumnInfo::Type::integer, "", "Training runs, or other independent repetitions."});
  table.columns.push_back({"mean", ColumnInfo::Type::number, "", fmt::format("Mean {}.", what)});
  add_interval_columns(table);
}

void add_estimate(std::vector<Cell>& row, const Estimate& estimate) {
  row.emplace_back(static_cast<std::int64_t>(estimate.units));
  row.emplace_back(estimate.mean);
  row.push_back(estimate.ci95 ? Cell(estimate.ci95->low) : Cell());
  row.push_back(estimate.ci95 ? Cell(estimate.ci95->high) : Cell());
}

/// A new row with the keys of a group.
std::vector<Cell>& add_row(Table& table, const FigureInputs& inputs, std::size_t group) {
  return table.rows.emplace_back(inputs.keys.rows[group]);
}

/// The rows of datasets, one by one.
void add_observations(Table& table, const FigureInputs& inputs, std::size_t group, const std::string& x,
                      const std::string& y) {
  for (const std::size_t entry : inputs.groups[group].entries) {
    const Curve points = read_points(inputs.nodes[entry], x, y);
    for (std::size_t k = 0; k < points.x.size(); ++k) {
      std::vector<Cell>& row = add_row(table, inputs, group);
      row.insert(row.end(), {points.x[k], std::int64_t{1}, points.y[k], Cell(), Cell(), Cell("point")});
    }
  }
}

/// The means of training runs, or the values of episodes, group by group.
std::vector<std::vector<double>> values_of(const FigureInputs& inputs, Metric metric) {
  std::vector<std::vector<double>> groups;
  for (const TableCell& group : inputs.groups) {
    const Units units = units_of(inputs.nodes, group, metric);
    std::vector<double>& values = groups.emplace_back();
    if (!units.are_runs) values = observe_episodes(inputs.nodes[group.entries.front()], metric);
    if (!values.empty()) continue;
    for (const Run& run : units.runs) values.push_back(run.mean);
  }
  return groups;
}

std::vector<double> joined(const std::vector<std::vector<double>>& groups) {
  std::vector<double> all;
  for (const std::vector<double>& values : groups) all.insert(all.end(), values.begin(), values.end());
  return all;
}

}  // namespace

const std::vector<std::string>& estimate_column_names() {
  static const std::vector<std::string> kNames = [] {
    Table table;
    add_estimate_columns(table, "");
    std::vector<std::string> names;
    for (const ColumnInfo& column : table.columns) names.push_back(column.name);
    return names;
  }();
  return kNames;
}

Table curve_table(const FigureInputs& inputs, const std::string& x, const std::string& y) {
  constexpr std::size_t kTimes = 200;
  Table table;
  table.columns = inputs.keys.columns;
  table.reproducible = !is_time(x);
  table.columns.push_back({x, ColumnInfo::Type::number, is_time(x) ? "s" : "",
                           is_time(x) ? "Time of learning; differs from run to run." : "Progress."});
  add_estimate_columns(table, y);
  const bool has_points = inputs.lines < inputs.nodes.size();
  if (has_points) table.columns.push_back({kDrawn, ColumnInfo::Type::text, "", "As what: line or point."});
  for (std::size_t i = 0; i < inputs.groups.size(); ++i) {
    if (inputs.groups[i].entries.front() >= inputs.lines) {
      add_observations(table, inputs, i, x, y);
      continue;
    }
    std::vector<Curve> curves;
    for (const std::size_t entry : inputs.groups[i].entries) {
      curves.push_back(read_curve(inputs.nodes[entry], x, y));
    }
    for (const CurvePoint& point : mean_curve(curves, is_time(x) ? kTimes : 0)) {
      std::vector<Cell>& row = add_row(table, inputs, i);
      row.emplace_back(point.x);
      add_estimate(row, point.estimate);
      if (has_points) row.emplace_back("line");
    }
  }
  return table;
}

Table interval_table(const FigureInputs& inputs, Metric metric) {
  Table table = inputs.keys;
  add_estimate_columns(table, metric_doc(metric));
  for (std::size_t i = 0; i < inputs.groups.size(); ++i) {
    add_estimate(table.rows[i], summarize(inputs.nodes, inputs.groups[i], metric).estimate);
  }
  return table;
}

Table histogram_table(const FigureInputs& inputs, Metric metric, std::size_t bins) {
  Table table;
  table.columns = inputs.keys.columns;
  table.columns.push_back({"bin_low", ColumnInfo::Type::number, "", "Where the bin begins."});
  table.columns.push_back(
      {"bin_high", ColumnInfo::Type::number, "", "Where it ends; the last bin holds its end."});
  table.columns.push_back({"count", ColumnInfo::Type::integer, "", "Training runs in it, or episodes."});
  const std::vector<std::vector<double>> groups = values_of(inputs, metric);
  const std::vector<double> ends = bin_ends(joined(groups), bins);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    std::vector<std::int64_t> counts(ends.size() - 1);
    for (const double value : groups[i]) {
      const auto after = std::upper_bound(ends.begin() + 1, ends.end() - 1, value);
      ++counts[static_cast<std::size_t>(after - ends.begin()) - 1];
    }
    for (std::size_t b = 0; b < counts.size(); ++b) {
      std::vector<Cell>& row = add_row(table, inputs, i);
      row.insert(row.end(), {ends[b], ends[b + 1], counts[b]});
    }
  }
  return table;
}

Table profile_table(const FigureInputs& inputs, Metric metric, Better better) {
  constexpr std::size_t kThresholds = 100;
  Table table;
  table.columns = inputs.keys.columns;
  table.columns.push_back(
      {"threshold", ColumnInfo::Type::number, "", fmt::format("Of {}.", metric_doc(metric))});
  table.columns.push_back(
      {"share", ColumnInfo::Type::number, "", "Share of training runs, or episodes, better than it."});
  add_interval_columns(table);
  const std::vector<std::vector<double>> groups = values_of(inputs, metric);
  const std::vector<double> thresholds = bin_ends(joined(groups), kThresholds);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (const ProfilePoint& point : performance_profile(groups[i], thresholds, better)) {
      std::vector<Cell>& row = add_row(table, inputs, i);
      row.insert(row.end(), {point.threshold, point.share, point.ci95.low, point.ci95.high});
    }
  }
  return table;
}

}  // namespace coppice
