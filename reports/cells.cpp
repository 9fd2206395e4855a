#include "reports/cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "engine/data/csv.h"
#include "registry/suggest.h"
#include "registry/units.h"

namespace coppice {
namespace {

constexpr const char* kRenamed = "sweep_";

std::string value_of(const Entry& entry, std::string_view name) {
  for (const auto& [label, value] : entry.names) {
    if (label == name) return value;
  }
  return {};
}

std::string unit_of(const Entry& entry, const std::string& name) {
  const auto unit = entry.units.find(name);
  return unit == entry.units.end() ? "" : unit->second;
}

void check_keys(const std::vector<Entry>& entries, const TableKeys& keys) {
  std::vector<std::string> known;
  for (const Entry& entry : entries) {
    for (const auto& [name, value] : entry.names) {
      if (std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
    }
  }
  Rules rules;
  std::set<std::string> seen;
  for (const std::string& key : keys.all()) {
    const bool in_rows = std::find(keys.rows.begin(), keys.rows.end(), key) != keys.rows.end();
    rules.check(in_rows ? keys.of_rows : keys.of_columns, [&] {
      if (std::find(known.begin(), known.end(), key) == known.end()) {
        throw std::invalid_argument(fmt::format("{}: nothing here has the column '{}'; {}", keys.parameters,
                                                key, suggestion(key, known)));
      }
      if (!seen.insert(key).second)
        throw std::invalid_argument(fmt::format("{}: '{}' stands twice", keys.parameters, key));
    });
  }
  rules.enforce();
}

/// Averaging over anything but replicates would hide what differs.
void check_replicates(const std::vector<Entry>& entries, const TableKeys& keys, const TableCell& cell) {
  const Entry& first = entries[cell.entries.front()];
  std::set<std::optional<int>> replicates;
  for (const std::size_t i : cell.entries) {
    const Entry& entry = entries[i];
    for (const auto& [name, value] : entry.names) {
      const std::string other = value_of(first, name);
      if (value == other) continue;
      throw std::invalid_argument(
          fmt::format("{} do not tell {}=\"{}\" from {}=\"{}\": add '{}' to one of them", keys.parameters,
                      name, other, name, value, name));
    }
    const bool again = !replicates.insert(entry.replicate).second;
    if (again || entry.replicate.has_value() != first.replicate.has_value()) {
      throw std::invalid_argument(fmt::format("'{}' is here more than once", value_of(entry, "node")));
    }
  }
}

/// Numbers keys by their first appearance.
class Order {
 public:
  std::size_t rank(const std::vector<std::string>& keys) {
    return ranks_.try_emplace(keys, ranks_.size()).first->second;
  }

 private:
  std::map<std::vector<std::string>, std::size_t> ranks_;
};

std::vector<std::string> values_of(const Entry& entry, const std::vector<std::string>& names) {
  std::vector<std::string> values;
  for (const std::string& name : names) values.push_back(value_of(entry, name));
  return values;
}

/// Its value, where a text is a number however it is spelled ("0.50", "1e3"); nothing where it would lose
/// what it says: digits beyond a double's, or zeros in front, as names have them ("007").
std::optional<double> number_of_key(const std::string& text) {
  const std::optional<double> value = parse_number(text);
  if (!value) return std::nullopt;
  const std::size_t first = text.find_first_of("0123456789");
  if (text[first] == '0' && first + 1 < text.size() && std::isdigit(text[first + 1])) return std::nullopt;
  constexpr double kLargestExact = 0x1p53;
  const bool digits_only = text.find_first_not_of("+-0123456789") == std::string::npos;
  if (digits_only && std::fabs(*value) > kLargestExact && cell_text(*value) != text) return std::nullopt;
  return value;
}

/// Text, unless every key is a number, and different texts are different numbers.
ColumnInfo::Type type_of_keys(const std::vector<TableCell>& cells, std::size_t key) {
  bool integers = true;
  std::map<double, std::string> texts;
  for (const TableCell& cell : cells) {
    const std::string& text = cell.keys[key];
    if (text.empty()) continue;
    const std::optional<double> value = number_of_key(text);
    if (!value || texts.try_emplace(*value, text).first->second != text) return ColumnInfo::Type::text;
    integers = integers && cell_text(*value).find_first_not_of("-0123456789") == std::string::npos &&
               std::fabs(*value) < 0x1p63;
  }
  return integers ? ColumnInfo::Type::integer : ColumnInfo::Type::number;
}

Cell key_cell(const std::string& text, ColumnInfo::Type type) {
  if (text.empty()) return {};
  if (type == ColumnInfo::Type::text) return text;
  const double value = *parse_number(text);
  return type == ColumnInfo::Type::integer ? Cell(static_cast<std::int64_t>(value)) : Cell(value);
}

}  // namespace

std::vector<Entry> entries_of(const std::vector<InputNode>& nodes) {
  std::vector<Entry> entries;
  for (const InputNode& node : nodes) {
    std::vector<PointValue> names = node.labels;
    std::map<std::string, std::string> units = node.units;
    names.emplace_back("node", node.id);
    for (std::size_t i = 0; i < node.point.size() && i < names.size(); ++i) {
      const auto taken = [&](const PointValue& later) {
        return later.first == names[i].first && later.second != names[i].second;
      };
      if (std::any_of(names.begin() + static_cast<std::ptrdiff_t>(i) + 1, names.end(), taken)) {
        if (auto unit = units.extract(names[i].first))
          units.emplace(kRenamed + names[i].first, unit.mapped());
        names[i].first = kRenamed + names[i].first;
      }
    }
    entries.push_back({std::move(names), node.replicate, std::move(units)});
  }
  return entries;
}

std::vector<std::string> TableKeys::all() const {
  std::vector<std::string> names = rows;
  names.insert(names.end(), columns.begin(), columns.end());
  return names;
}

std::vector<TableCell> arrange(const std::vector<Entry>& entries, const TableKeys& keys) {
  check_keys(entries, keys);
  Order rows, columns;
  std::map<std::pair<std::size_t, std::size_t>, TableCell> cells;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    std::vector<std::string> row = values_of(entries[i], keys.rows);
    const std::vector<std::string> column = values_of(entries[i], keys.columns);
    TableCell& cell = cells[{rows.rank(row), columns.rank(column)}];
    if (cell.entries.empty()) {
      cell.keys = std::move(row);
      cell.keys.insert(cell.keys.end(), column.begin(), column.end());
      for (const std::string& name : keys.all()) cell.units.push_back(unit_of(entries[i], name));
    }
    cell.entries.push_back(i);
  }
  std::vector<TableCell> sorted;
  for (auto& [place, cell] : cells) {
    check_replicates(entries, keys, cell);
    sorted.push_back(std::move(cell));
  }
  return sorted;
}

void add_key_columns(Table& table, const TableKeys& keys, const std::vector<TableCell>& cells) {
  table.rows.resize(cells.size());
  const std::vector<std::string> names = keys.all();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const ColumnInfo::Type type = type_of_keys(cells, k);
    const bool of_row = k < keys.rows.size();
    const auto with_unit = [k](const TableCell& cell) { return !cell.unit(k).empty(); };
    const auto cell = std::find_if(cells.begin(), cells.end(), with_unit);
    table.columns.push_back({names[k], type, cell == cells.end() ? "" : cell->units[k],
                             of_row ? "Key of the row." : "Key of the column."});
    for (std::size_t i = 0; i < cells.size(); ++i) table.rows[i].push_back(key_cell(cells[i].keys[k], type));
  }
}

void rename_taken_keys(Table& table, std::size_t keys) {
  const auto values = table.columns.begin() + static_cast<std::ptrdiff_t>(keys);
  for (auto key = table.columns.begin(); key != values; ++key) {
    const auto same = [&](const ColumnInfo& value) { return value.name == key->name; };
    if (std::any_of(values, table.columns.end(), same)) key->name = kRenamed + key->name;
  }
}

std::string key_column(const Table& table, const std::string& key) {
  return table.has(kRenamed + key) ? kRenamed + key : key;
}

void refuse_replicates(const NodeOptions& node, Rules& rules) {
  if (!node.replicates) return;
  rules.broken(
      "replicates",
      "replicates: this node takes all replicates of what it shows and makes one file; leave it out");
}

bool fits_unit(std::string_view text, std::string_view unit) {
  const std::optional<Quantity> given = parse_quantity(text);
  const std::optional<Quantity> key = parse_unit(unit);
  const Dimension plain{};
  return unit.empty() || !given || !key || given->dimension == plain || given->dimension == key->dimension;
}

bool same_key(std::string_view text, std::string_view key, std::string_view unit) {
  if (text == key) return true;
  const std::optional<Quantity> x = parse_quantity(text), y = parse_quantity(key);
  if (!x || !y || x->value != y->value || !fits_unit(text, unit)) return false;
  const Dimension plain{};  // plain numbers are in SI units without saying so
  return x->dimension == y->dimension || x->dimension == plain || y->dimension == plain;
}

}  // namespace coppice
