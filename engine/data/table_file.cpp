#include "engine/data/table_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "engine/data/csv.h"
#include "engine/data/file_system.h"
#include "registry/source.h"
#include "registry/suggest.h"
#include "registry/text.h"

namespace coppice {
namespace {

using Type = ColumnInfo::Type;

constexpr std::array<std::string_view, 4> kTypeNames = {"number", "integer", "boolean", "text"};  // as Type

std::filesystem::path schema_path(std::filesystem::path table) {
  return table.replace_extension(".schema.json");
}

std::optional<std::int64_t> parse_integer(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The cell that a text stands for in a column of this type; nothing when it is not of the type.
std::optional<Cell> parse_cell(std::string_view text, Type type) {
  if (text.empty()) return Cell();
  const auto as_cell = [](auto value) { return value ? std::optional<Cell>(*value) : std::nullopt; };
  switch (type) {
    case Type::number:
      return as_cell(parse_number(text));
    case Type::integer:
      return as_cell(parse_integer(text));
    case Type::boolean:
      if (text == "1" || text == "true") return Cell(std::int64_t{1});
      if (text == "0" || text == "false") return Cell(std::int64_t{0});
      return std::nullopt;
    case Type::text:
      break;
  }
  return Cell(std::string(text));
}

std::string_view expectation(Type type) {
  switch (type) {
    case Type::number:
      return "a finite number";
    case Type::integer:
      return "an integer";
    case Type::boolean:
      return "0 or 1";
    case Type::text:
      break;
  }
  return "a text";
}

/// Each column has the narrowest type that all its cells fit.
std::vector<ColumnInfo> inferred_columns(const std::shared_ptr<const SourceFile>& source) {
  CsvReader reader(source);
  std::vector<ColumnInfo> columns;
  for (const std::string& name : reader.header()) columns.push_back({name, Type::integer, "", ""});
  std::vector<bool> any(columns.size(), false);
  while (reader.next()) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      Type& type = columns[c].type;
      any[c] = any[c] || !reader[c].empty();
      if (type == Type::integer && !parse_cell(reader[c], type)) type = Type::number;
      if (type == Type::number && !parse_cell(reader[c], type)) type = Type::text;
    }
  }
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (!any[c]) columns[c].type = Type::number;
  }
  return columns;
}

Type type_of(const std::string& name) {
  const auto found = std::find(kTypeNames.begin(), kTypeNames.end(), name);
  if (found == kTypeNames.end()) throw std::invalid_argument(fmt::format("there is no type '{}'", name));
  return static_cast<Type>(found - kTypeNames.begin());
}

/// The columns of the header, as the schema file describes them.
std::vector<ColumnInfo> described_columns(const std::filesystem::path& schema, const CsvReader& reader) {
  std::vector<ColumnInfo> known;
  std::vector<std::string> names;
  try {
    const nlohmann::json root = nlohmann::json::parse(read_file(schema));
    for (const nlohmann::json& column : root.at("columns")) {
      known.push_back({column.at("name").get<std::string>(), type_of(column.at("type").get<std::string>()),
                       column.at("unit").get<std::string>(), column.at("doc").get<std::string>()});
      names.push_back(known.back().name);
    }
  } catch (const std::exception& wrong) {
    throw ConfigError(fmt::format("'{}' does not describe a table: {}", schema.string(), wrong.what()));
  }
  std::vector<ColumnInfo> columns;
  for (std::size_t c = 0; c < reader.header().size(); ++c) {
    const std::string& name = reader.header()[c];
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      throw ConfigError({Diagnostic{reader.header_place(c),
                                    fmt::format("the column '{}' is not in '{}'", name, schema.string()),
                                    suggestion(name, names),
                                    {}}});
    }
    columns.push_back(known[static_cast<std::size_t>(found - names.begin())]);
  }
  return columns;
}

}  // namespace

std::size_t Table::column(std::string_view name) const {
  std::vector<std::string> names;
  for (const ColumnInfo& info : columns) {
    if (info.name == name) return names.size();
    names.push_back(info.name);
  }
  throw std::out_of_range(fmt::format("there is no column '{}'; there are {}", name, join(names)));
}

bool Table::has(std::string_view name) const {
  return std::any_of(columns.begin(), columns.end(),
                     [name](const ColumnInfo& info) { return info.name == name; });
}

double number(const Cell& cell) {
  if (const auto* value = std::get_if<double>(&cell)) return *value;
  if (const auto* value = std::get_if<std::int64_t>(&cell)) return static_cast<double>(*value);
  return std::numeric_limits<double>::quiet_NaN();
}

std::string cell_text(const Cell& cell) {
  std::string text;
  if (const auto* value = std::get_if<double>(&cell)) append_csv(text, *value);
  if (const auto* value = std::get_if<std::int64_t>(&cell)) text = std::to_string(*value);
  if (const auto* value = std::get_if<std::string>(&cell)) text = *value;
  return text;
}

bool is_reproducible(const std::filesystem::path& table) {
  const std::filesystem::path schema = schema_path(table);
  std::error_code code;
  if (!std::filesystem::exists(schema, code)) return true;
  const nlohmann::json root = nlohmann::json::parse(read_file(schema), nullptr, false);
  return !root.is_object() || root.value("reproducible", nlohmann::json(true)) != false;
}

void write_schema(const std::filesystem::path& table, const std::vector<ColumnInfo>& columns,
                  bool reproducible) {
  nlohmann::ordered_json root;
  if (!reproducible) root["reproducible"] = false;
  root["columns"] = nlohmann::ordered_json::array();
  for (const ColumnInfo& column : columns) {
    root["columns"].push_back({{"name", column.name},
                               {"type", kTypeNames[static_cast<std::size_t>(column.type)]},
                               {"unit", column.unit},
                               {"doc", column.doc}});
  }
  write_file(schema_path(table), root.dump(2) + "\n");
}

void write_table(const std::filesystem::path& file, const Table& table) {
  std::string bytes;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (c > 0) bytes += ',';
    append_csv(bytes, table.columns[c].name);
  }
  bytes += '\n';
  for (const std::vector<Cell>& row : table.rows) {
    if (row.size() != table.columns.size())
      throw std::logic_error("a row has not as many cells as there are columns");
    const std::size_t begin = bytes.size();
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (c > 0) bytes += ',';
      append_csv(bytes, cell_text(row[c]));
    }
    if (bytes.size() == begin) bytes += "\"\"";  // a blank line would be no row
    bytes += '\n';
  }
  write_file(file, bytes);
  write_schema(file, table.columns, table.reproducible);
}

Table read_table(const std::filesystem::path& file, const std::vector<std::string>& numbers) {
  const std::shared_ptr<const SourceFile> source = read_source(file.string(), kLargestTable);
  CsvReader reader(source);
  const std::filesystem::path schema = schema_path(file);
  Table table;
  table.reproducible = is_reproducible(file);
  table.columns =
      std::filesystem::exists(schema) ? described_columns(schema, reader) : inferred_columns(source);
  for (ColumnInfo& column : table.columns) {
    const bool wanted = std::find(numbers.begin(), numbers.end(), column.name) != numbers.end();
    if (wanted && column.type == Type::text) column.type = Type::number;
  }
  Diagnostics errors;
  while (reader.next() && errors.size() < kMaxCsvErrors) {
    std::vector<Cell>& row = table.rows.emplace_back(table.columns.size());
    for (std::size_t c = 0; c < row.size(); ++c) {
      const ColumnInfo& column = table.columns[c];
      if (std::optional<Cell> cell = parse_cell(reader[c], column.type)) {
        row[c] = std::move(*cell);
      } else {
        errors.error(reader.place(c),
                     fmt::format("'{}': '{}' is not {}", column.name, reader[c], expectation(column.type)));
      }
    }
  }
  errors.throw_if_any();
  return table;
}

}  // namespace coppice
