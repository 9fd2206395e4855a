#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace coppice {

/// One column of a tidy table; `unit` is SI and, when not empty, the name ends in it ("time_s").
struct ColumnInfo {
  enum class Type { number, integer, boolean, text };  ///< booleans are the integers 0 and 1
  std::string name;
  Type type = Type::number;
  std::string unit;
  std::string doc;
};

/// A cell: empty (missing), a number, an integer or a text.
using Cell = std::variant<std::monostate, double, std::int64_t, std::string>;

/// Rows of observations: what a node writes and a report reads.
struct Table {
  std::vector<ColumnInfo> columns;
  std::vector<std::vector<Cell>> rows;
  bool reproducible = true;  ///< false: shows times, which differ from run to run

  std::size_t column(std::string_view name) const;  ///< throws std::out_of_range naming what there is
  bool has(std::string_view name) const;
};

/// A cell as number; NaN when missing or text.
double number(const Cell& cell);
/// A cell as CSV text (unquoted): shortest text that reads back equal; empty when missing, NaN or infinite.
std::string cell_text(const Cell& cell);

/// RFC 4180 quoting, LF, UTF-8, header row; beside it <name>.schema.json (name, type, unit, doc of each
/// column; "reproducible": false where it is not). Throws std::runtime_error with the file and the system's
/// reason when it cannot be written.
void write_table(const std::filesystem::path& file, const Table& table);

/// Reads any CSV (LF or CRLF). Types come from the schema beside it, else from the cells; a boolean is 0
/// or 1. Throws ConfigError with file, line and column for what is not CSV, or not of its column's type; the
/// columns named in `numbers` hold no text.
Table read_table(const std::filesystem::path& file, const std::vector<std::string>& numbers = {});

/// <name>.schema.json beside <name>.csv: {"columns": [{"name", "type", "unit", "doc"}, ...]}.
void write_schema(const std::filesystem::path& table, const std::vector<ColumnInfo>& columns,
                  bool reproducible = true);
/// False when the schema beside a table says that its content differs from run to run.
bool is_reproducible(const std::filesystem::path& table);

}  // namespace coppice
