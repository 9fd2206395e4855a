#include "reports/figure_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "engine/graph/artifacts.h"
#include "registry/suggest.h"

namespace coppice {
namespace {

std::size_t column_of(const Table& table, const InputNode& node, const std::string& name) {
  if (table.has(name)) return table.column(name);
  std::vector<std::string> known;
  for (const ColumnInfo& column : table.columns) known.push_back(column.name);
  throw std::invalid_argument(
      fmt::format("the progress of '{}' has no column '{}'; {}", node.id, name, suggestion(name, known)));
}

/// Points in the order of x.
Curve ordered(const Curve& points, const InputNode& node, const std::string& x) {
  std::vector<std::pair<double, double>> pairs;
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    if (std::isfinite(points.x[i]) && std::isfinite(points.y[i]))
      pairs.emplace_back(points.x[i], points.y[i]);
  }
  std::sort(pairs.begin(), pairs.end());
  Curve curve;
  for (const auto& [at, value] : pairs) {
    if (!curve.x.empty() && at == curve.x.back()) {
      throw std::invalid_argument(
          fmt::format("the dataset '{}' has two rows with {} = {}: no line", node.id, x, at));
    }
    curve.x.push_back(at);
    curve.y.push_back(value);
  }
  return curve;
}

/// The last y so far; NaN before the curve begins.
double value_at(const Curve& curve, double x) {
  const auto after = std::upper_bound(curve.x.begin(), curve.x.end(), x);
  if (after == curve.x.begin()) return NAN;
  return curve.y[static_cast<std::size_t>(after - curve.x.begin()) - 1];
}

}  // namespace

bool is_time(const std::string& x) {
  return x == "cpu_s" || x == "wall_s";
}

Curve read_points(const InputNode& node, const std::string& x, const std::string& y) {
  const Table table = read_table(node.folder / kDatasetFile, {x, y});
  const std::size_t x_column = table.column(x), y_column = table.column(y);
  Curve points;
  for (const std::vector<Cell>& row : table.rows) {
    points.x.push_back(number(row[x_column]));
    points.y.push_back(number(row[y_column]));
  }
  return points;
}

Curve read_curve(const InputNode& node, const std::string& x, const std::string& y) {
  if (std::find(node.makes.begin(), node.makes.end(), "dataset") != node.makes.end()) {
    return ordered(read_points(node, x, y), node, x);
  }
  const Table progress = read_table(node.folder / kProgressFile);
  const std::size_t x_column = column_of(progress, node, is_time(x) ? "iteration" : x);
  const std::size_t y_column = column_of(progress, node, y);
  double scale = 1;
  if (is_time(x) && !progress.rows.empty()) {
    const Table timing = read_table(node.folder / "timing.csv");
    scale = number(timing.rows.at(0)[timing.column(x)]) / number(progress.rows.back()[x_column]);
  }
  Curve curve;
  for (const std::vector<Cell>& row : progress.rows) {
    const double at = number(row[x_column]) * scale, value = number(row[y_column]);
    if (!std::isfinite(at) || !std::isfinite(value)) continue;
    if (!curve.x.empty() && at <= curve.x.back()) {
      throw std::invalid_argument(fmt::format("'{}' does not grow with the progress of '{}'", x, node.id));
    }
    curve.x.push_back(at);
    curve.y.push_back(value);
  }
  return curve;
}

std::vector<CurvePoint> mean_curve(const std::vector<Curve>& curves, std::size_t points) {
  std::set<double> grid;
  double begin = -INFINITY, end = -INFINITY;
  for (const Curve& curve : curves) {
    if (curve.x.empty()) continue;
    begin = std::max(begin, curve.x.front());
    end = std::max(end, curve.x.back());
    if (points == 0) grid.insert(curve.x.begin(), curve.x.end());
  }
  for (std::size_t i = 0; i < points && std::isfinite(end); ++i) {
    grid.insert(i + 1 == points ? end
                                : begin + (end - begin) * static_cast<double>(i) /
                                              static_cast<double>(std::max<std::size_t>(points - 1, 1)));
  }
  std::vector<CurvePoint> result;
  for (const double x : grid) {
    std::vector<double> values;
    for (const Curve& curve : curves) {
      if (const double value = value_at(curve, x); !std::isnan(value)) values.push_back(value);
    }
    result.push_back({x, estimate(values, Better::lower)});
  }
  return result;
}

std::vector<double> bin_ends(const std::vector<double>& values, std::size_t bins) {
  double low = quantile(values, 0), high = quantile(values, 1);
  if (bins == 0) {
    const double width =
        2 * (quantile(values, 0.75) - quantile(values, 0.25)) / std::cbrt(static_cast<double>(values.size()));
    const double wanted = width > 0 ? std::ceil((high - low) / width) : 10;
    bins = static_cast<std::size_t>(std::clamp(wanted, 1.0, 100.0));
    if (std::all_of(values.begin(), values.end(), [](double value) { return value == std::trunc(value); })) {
      const double whole = std::max(1.0, std::round((high - low + 1) / static_cast<double>(bins)));
      bins = static_cast<std::size_t>(std::ceil((high - low + 1) / whole));
      low -= 0.5;
      high = low + whole * static_cast<double>(bins);
    }
  }
  std::vector<double> ends;
  const double span = high > low ? high - low : 1, start = high > low ? low : low - 0.5;
  for (std::size_t i = 0; i <= bins; ++i) {
    ends.push_back(start + span * static_cast<double>(i) / static_cast<double>(bins));
  }
  return ends;
}

}  // namespace coppice
