#include "reports/known_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "registry/error.h"
#include "registry/suggest.h"
#include "registry/text.h"
#include "registry/units.h"

namespace coppice {

namespace {

/// The name that a key has in the file, whose own columns are value, source and note.
std::string column_of(const std::string& key) {
  return key == "value" || key == "source" || key == "note" ? "sweep_" + key : key;
}

}  // namespace

KnownValues::KnownValues(const std::string& file, const TableKeys& keys, const std::vector<TableCell>& cells)
    : table_(read_table(file, {"value"})) {
  std::vector<std::string> names;
  for (const std::string& key : keys.all()) names.push_back(column_of(key));
  std::vector<std::string> valid = names;
  valid.insert(valid.end(), {"value", "source", "note"});
  for (const ColumnInfo& column : table_.columns) {
    if (std::find(valid.begin(), valid.end(), column.name) != valid.end()) continue;
    throw ConfigError(fmt::format("{}: '{}' is no key of the table; {}", file, column.name,
                                  suggestion(column.name, valid)));
  }
  for (const std::string& key : keys.all()) {
    const bool taken = key != column_of(key) && key != "value";
    if (!taken || !table_.has(key) || table_.has(column_of(key))) continue;
    throw ConfigError(fmt::format("{}: '{}' is a remark here; the key '{}' is called '{}' in this file", file,
                                  key, key, column_of(key)));
  }
  if (!table_.has("value")) throw ConfigError(fmt::format("{}: there is no column 'value'", file));
  for (const std::string& name : names) {
    columns_.push_back(table_.has(name) ? std::optional(table_.column(name)) : std::nullopt);
  }
  const bool keyed = std::any_of(columns_.begin(), columns_.end(), [](const auto& key) { return bool(key); });
  if (!keyed && table_.rows.size() > 1) {
    throw ConfigError(fmt::format("{}: its {} rows have no key, so each would be about every cell; add {}",
                                  file, table_.rows.size(),
                                  names.empty() ? "keys to the table and columns for them to the file"
                                                : "a column " + join(names, " or ")));
  }
  if (table_.rows.empty()) throw ConfigError(fmt::format("{}: there are no rows in it", file));
  check_units(file, keys, cells);
  bool any = false;
  for (const TableCell& cell : cells) {
    int found = 0;
    for (std::size_t row = 0; row < table_.rows.size(); ++row) found += matches(row, cell) ? 1 : 0;
    any = any || found > 0;
    if (found > 1) throw ConfigError(fmt::format("{}: two values for {}", file, join(cell.keys)));
  }
  if (!any) throw ConfigError(fmt::format("{}: none of its rows is about any cell of the table", file));
}

void KnownValues::check_units(const std::string& file, const TableKeys& keys,
                              const std::vector<TableCell>& cells) const {
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    if (!columns_[k]) continue;
    for (const TableCell& cell : cells) {
      for (const std::vector<Cell>& row : table_.rows) {
        const std::string text = cell_text(row[*columns_[k]]);
        if (fits_unit(text, cell.unit(k))) continue;
        throw ConfigError(fmt::format("{}: '{}' is {}, and the key '{}' is {}", file, text,
                                      dimension_text(parse_quantity(text)->dimension), keys.all()[k],
                                      dimension_text(parse_unit(cell.unit(k))->dimension)));
      }
    }
  }
}

bool KnownValues::matches(std::size_t row, const TableCell& cell) const {
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    if (columns_[k] && !same_key(cell_text(table_.rows[row][*columns_[k]]), cell.keys[k], cell.unit(k)))
      return false;
  }
  return true;
}

double KnownValues::find(const TableCell& cell) const {
  for (std::size_t row = 0; row < table_.rows.size(); ++row) {
    if (matches(row, cell)) return number(table_.rows[row][table_.column("value")]);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace coppice
