#include "reports/table_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "registry/text.h"
#include "reports/html.h"

namespace coppice {
namespace {

using html::element;
using html::text_element;

bool is_number(const ColumnInfo& column) {
  return column.type == ColumnInfo::Type::number || column.type == ColumnInfo::Type::integer;
}

/// The value of the first of these columns that the table has; "" when it is missing.
std::string shown(const Table& table, const std::vector<Cell>& row,
                  std::initializer_list<std::string_view> columns) {
  for (const std::string_view column : columns) {
    if (table.has(column)) return short_number(row[table.column(column)]);
  }
  return {};
}

std::vector<std::size_t> columns_of(const Table& table, const std::vector<std::string>& keys) {
  std::vector<std::size_t> columns;
  for (const std::string& key : keys) {
    const std::string column = key_column(table, key);
    if (table.has(column)) columns.push_back(table.column(column));
  }
  return columns;
}

std::string header_row(const std::vector<std::string>& cells) {
  std::string row;
  for (const std::string& cell : cells) row += cell;
  return element("thead", element("tr", row));
}

std::string as_it_is(const Table& table, const TableKeys& keys) {
  const std::vector<std::size_t> key_columns = columns_of(table, keys.all());
  std::vector<std::string> head;
  for (const ColumnInfo& column : table.columns) {
    head.push_back(text_element("th", column.name, {{"scope", "col"}, {"title", column.doc}}));
  }
  std::string body;
  for (const std::vector<Cell>& row : table.rows) {
    std::string cells;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const bool is_key = std::find(key_columns.begin(), key_columns.end(), c) != key_columns.end();
      cells += is_key ? text_element("th", cell_text(row[c]), {{"scope", "row"}})
                      : text_element("td", short_number(row[c]),
                                     {{"class", is_number(table.columns[c]) ? "number" : ""}});
    }
    body += element("tr", cells);
  }
  return element("table", header_row(head) + element("tbody", body));
}

/// Mean and interval, and below in small what else is known.
std::string summary(const Table& table, const std::vector<Cell>& row) {
  std::string out = text_element("strong", shown(table, row, {"mean", "mean_s"}));
  const std::string low = shown(table, row, {"ci95_low", "ci95_low_s"});
  const std::string high = shown(table, row, {"ci95_high", "ci95_high_s"});
  if (!low.empty()) out += text_element("span", fmt::format(" [{}, {}]", low, high), {{"class", "interval"}});
  std::vector<std::string> more;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) more.push_back(fmt::format("{} {}", name, value));
  };
  add("n =", shown(table, row, {"n_replicates", "n"}));
  add("published", shown(table, row, {"published"}));
  add("reference", shown(table, row, {"reference"}));
  return out + text_element("small", join(more, " · "));
}

/// Names in the order of their first appearance.
std::size_t index_of(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  names.push_back(name);
  return names.size() - 1;
}

std::string spread_out(const Table& table, const std::vector<std::size_t>& row_keys,
                       const std::vector<std::size_t>& column_keys) {
  const auto texts = [](const std::vector<Cell>& row, const std::vector<std::size_t>& columns) {
    std::vector<std::string> values;
    for (const std::size_t c : columns) values.push_back(cell_text(row[c]));
    return values;
  };
  std::vector<std::string> lines, columns;
  std::vector<std::vector<std::string>> line_keys;
  std::map<std::pair<std::size_t, std::size_t>, std::string> cells;
  for (const std::vector<Cell>& row : table.rows) {
    const std::size_t line = index_of(lines, join(texts(row, row_keys), "\n"));
    if (line == line_keys.size()) line_keys.push_back(texts(row, row_keys));
    cells[{line, index_of(columns, join(texts(row, column_keys), ", "))}] = summary(table, row);
  }
  std::vector<std::string> head;
  for (const std::size_t c : row_keys)
    head.push_back(text_element("th", table.columns[c].name, {{"scope", "col"}}));
  std::vector<std::string> names;
  for (const std::size_t c : column_keys) names.push_back(table.columns[c].name);
  const std::string what = join(names);
  for (const std::string& column : columns) {
    head.push_back(element("th", text_element("small", what) + html::escaped(column), {{"scope", "col"}}));
  }
  std::string body;
  for (std::size_t line = 0; line < line_keys.size(); ++line) {
    std::string row;
    for (const std::string& key : line_keys[line]) row += text_element("th", key, {{"scope", "row"}});
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const auto found = cells.find({line, c});
      row += element("td", found == cells.end() ? "" : found->second, {{"class", "number"}});
    }
    body += element("tr", row);
  }
  return element("table", header_row(head) + element("tbody", body));
}

}  // namespace

std::string short_number(const Cell& cell) {
  const double* value = std::get_if<double>(&cell);
  if (value == nullptr) return cell_text(cell);
  return std::isfinite(*value) ? fmt::format("{:.5g}", *value) : std::string();
}

std::string table_view(const Table& table, const TableKeys& keys) {
  const bool summarized = table.has("mean") || table.has("mean_s");
  const std::vector<std::size_t> columns = columns_of(table, keys.columns);
  if (columns.empty() || !summarized) return as_it_is(table, keys);
  return spread_out(table, columns_of(table, keys.rows), columns);
}

}  // namespace coppice
