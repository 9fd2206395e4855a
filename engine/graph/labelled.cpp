#include "engine/graph/labelled.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/data/hash.h"
#include "engine/graph/key.h"

namespace coppice {
namespace {

using Type = ColumnInfo::Type;

struct Label {
  ColumnInfo column;
  Cell cell;
};

Label label(std::string name, const std::string& value, std::string doc) {
  std::int64_t integer = 0;
  const char* end = value.data() + value.size();
  if (const auto read = std::from_chars(value.data(), end, integer);
      read.ptr == end && read.ec == std::errc() && std::to_string(integer) == value) {
    return {{std::move(name), Type::integer, "", std::move(doc)}, integer};
  }
  double number = 0;
  if (const auto read = std::from_chars(value.data(), end, number);
      read.ptr == end && read.ec == std::errc() && std::isfinite(number)) {
    return {{std::move(name), Type::number, "", std::move(doc)}, number};
  }
  return {{std::move(name), Type::text, "", std::move(doc)}, value};
}

/// The labels without those that repeat: a sweep over the problem says the same as the problem.
std::vector<PointValue> distinct_labels(const PlannedNode& node) {
  std::vector<PointValue> labels;
  for (const PointValue& value : node.labels) {
    if (std::find(labels.begin(), labels.end(), value) == labels.end()) labels.push_back(value);
  }
  return labels;
}

}  // namespace

std::string labels_hash(const PlannedNode& node) {
  if (node.node->labelled_tables().empty()) return {};
  std::string text;
  for (const auto& [name, value] : node.labels) add_line(text, name, value);
  add_line(text, "replicate", node.replicate ? std::to_string(*node.replicate) : "");
  return content_hash(text);
}

Table labelled(const Table& table, const PlannedNode& node) {
  std::vector<Label> labels;
  const std::vector<PointValue> given = distinct_labels(node);
  for (std::size_t i = 0; i < given.size(); ++i) {
    const std::string& name = given[i].first;
    const std::string& value = given[i].second;
    const bool sweep = i < node.point.size();
    const auto same = [&](const PointValue& later) { return later.first == name; };
    const bool taken =
        sweep && (table.has(name) || name == "replicate" ||
                  std::any_of(given.begin() + static_cast<std::ptrdiff_t>(i) + 1, given.end(), same));
    labels.push_back(label(taken ? "sweep_" + name : name, value,
                           sweep ? "Sweep column '" + name + "'." : "Id of the " + name + "."));
  }
  labels.push_back({{"replicate", Type::integer, "", "Number of the independent repetition, from 0."}, {}});
  if (node.replicate) labels.back().cell = std::int64_t{*node.replicate};

  Table result;
  for (const Label& l : labels) result.columns.push_back(l.column);
  result.columns.insert(result.columns.end(), table.columns.begin(), table.columns.end());
  for (const std::vector<Cell>& row : table.rows) {
    std::vector<Cell>& longer = result.rows.emplace_back();
    for (const Label& l : labels) longer.push_back(l.cell);
    longer.insert(longer.end(), row.begin(), row.end());
  }
  return result;
}

Table join_rows(const std::vector<Table>& tables) {
  Table joined;
  for (const Table& table : tables) {
    std::vector<std::size_t> places;
    for (const ColumnInfo& column : table.columns) {
      if (!joined.has(column.name)) {
        joined.columns.push_back(column);
        for (std::vector<Cell>& row : joined.rows) row.emplace_back();
      }
      places.push_back(joined.column(column.name));
      Type& type = joined.columns[places.back()].type;
      const bool both_numbers = type != Type::text && column.type != Type::text;
      if (type != column.type) type = both_numbers ? Type::number : Type::text;
    }
    for (const std::vector<Cell>& row : table.rows) {
      std::vector<Cell>& wide = joined.rows.emplace_back(joined.columns.size());
      for (std::size_t i = 0; i < row.size(); ++i) wide[places[i]] = row[i];
    }
  }
  return joined;
}

}  // namespace coppice
