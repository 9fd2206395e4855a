#include "engine/graph/labelled.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "engine/data/hash.h"
#include "engine/graph/key.h"

namespace coppice {
namespace {

struct Label {
  ColumnInfo column;
  Cell cell;
};

Label label(std::string name, const std::string& value, const std::string& unit, std::string doc) {
  std::int64_t integer = 0;
  const char* end = value.data() + value.size();
  if (const auto read = std::from_chars(value.data(), end, integer);
      read.ptr == end && read.ec == std::errc() && std::to_string(integer) == value) {
    return {{std::move(name), ColumnInfo::Type::integer, unit, std::move(doc)}, integer};
  }
  double number = 0;
  if (const auto read = std::from_chars(value.data(), end, number);
      read.ptr == end && read.ec == std::errc() && std::isfinite(number)) {
    return {{std::move(name), ColumnInfo::Type::number, unit, std::move(doc)}, number};
  }
  return {{std::move(name), ColumnInfo::Type::text, "", std::move(doc)}, value};
}

/// The labels without those that repeat: a sweep over the problem says the same as the problem.
std::vector<PointValue> distinct_labels(const NodeLabels& node) {
  std::vector<PointValue> labels;
  for (const PointValue& value : node.columns) {
    if (std::find(labels.begin(), labels.end(), value) == labels.end()) labels.push_back(value);
  }
  return labels;
}

void add_labels(std::string& text, const NodeLabels& labels) {
  for (const auto& [name, value] : labels.columns) add_line(text, name, value);
  for (const auto& [name, unit] : labels.units) add_line(text, name + ".unit", unit);
  add_line(text, "replicate", labels.replicate ? std::to_string(*labels.replicate) : "");
}

/// The names of a node as a table of one row; `table` is what it is put before.
Table label_columns(const Table& table, const NodeLabels& node) {
  std::vector<Label> labels;
  const std::vector<PointValue> given = distinct_labels(node);
  for (std::size_t i = 0; i < given.size(); ++i) {
    const std::string& name = given[i].first;
    const std::string& value = given[i].second;
    const bool sweep = i < node.sweep_columns;
    const auto same = [&](const PointValue& later) { return later.first == name; };
    const bool taken =
        sweep && (table.has(name) || name == "replicate" ||
                  std::any_of(given.begin() + static_cast<std::ptrdiff_t>(i) + 1, given.end(), same));
    const auto unit = sweep ? node.units.find(name) : node.units.end();
    labels.push_back(label(taken ? "sweep_" + name : name, value,
                           unit == node.units.end() ? "" : unit->second,
                           sweep ? "Sweep column '" + name + "'." : "Id of the " + name + "."));
  }
  labels.push_back(
      {{"replicate", ColumnInfo::Type::integer, "", "Number of the independent repetition, from 0."}, {}});
  if (node.replicate) labels.back().cell = std::int64_t{*node.replicate};

  Table result;
  std::vector<Cell>& row = result.rows.emplace_back();
  for (Label& l : labels) {
    result.columns.push_back(std::move(l.column));
    row.push_back(std::move(l.cell));
  }
  return result;
}

/// Row i of the result is row i of `names`, the last one repeated, and then row i of `table`.
Table side_by_side(Table names, const Table& table) {
  Table result{std::move(names.columns), {}};
  result.columns.insert(result.columns.end(), table.columns.begin(), table.columns.end());
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    std::vector<Cell>& longer = result.rows.emplace_back(names.rows[std::min(i, names.rows.size() - 1)]);
    longer.insert(longer.end(), table.rows[i].begin(), table.rows[i].end());
  }
  return result;
}

}  // namespace

NodeLabels labels_of(const PlannedNode& node) {
  return {node.labels, node.point.size(), node.replicate, node.units};
}

std::string labels_hash(const PlannedNode& node) {
  std::string text;
  if (!node.node->labelled_tables().empty()) add_labels(text, labels_of(node));
  for (const NodeLabels& row : node.row_labels) add_labels(text, row);
  return text.empty() ? std::string() : content_hash(text);
}

Table labelled(const Table& table, const PlannedNode& node) {
  return side_by_side(label_columns(table, labels_of(node)), table);
}

Table labelled_rows(const Table& table, const std::vector<NodeLabels>& rows) {
  if (rows.size() != table.rows.size()) throw std::logic_error("a table of inputs has not a row for each");
  std::vector<Table> names(1);  // the first orders the columns: those of sweeps before the others
  for (const NodeLabels& row : rows) names.push_back(label_columns(table, row));
  for (const bool of_sweeps : {true, false}) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::vector<ColumnInfo>& columns = names[i + 1].columns;
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const bool wanted = (c < rows[i].sweep_columns) == of_sweeps;
        if (wanted && !names[0].has(columns[c].name)) names[0].columns.push_back(columns[c]);
      }
    }
  }
  return side_by_side(join_rows(names), table);
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
      ColumnInfo::Type& type = joined.columns[places.back()].type;
      const bool both_numbers = type != ColumnInfo::Type::text && column.type != ColumnInfo::Type::text;
      if (type != column.type) type = both_numbers ? ColumnInfo::Type::number : ColumnInfo::Type::text;
    }
    for (const std::vector<Cell>& row : table.rows) {
      std::vector<Cell>& wide = joined.rows.emplace_back(joined.columns.size());
      for (std::size_t i = 0; i < row.size(); ++i) wide[places[i]] = row[i];
    }
  }
  return joined;
}

}  // namespace coppice
