#include "engine/graph/nodes/dataset_columns.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/data/csv.h"
#include "engine/graph/artifacts.h"
#include "registry/suggest.h"

namespace coppice {
namespace {

/// Appends the values of the named columns, row after row.
void read_values(const std::filesystem::path& file, const std::vector<std::string>& names,
                 std::vector<double>& values) {
  CsvReader reader(read_source(file.string()));
  std::vector<std::size_t> fields;
  for (const std::string& name : names) {
    const std::optional<std::size_t> field = reader.column(name);
    if (!field) {
      throw ConfigError({Diagnostic{reader.header_place(0),
                                    fmt::format("there is no column '{}'", name),
                                    suggestion(name, reader.header()),
                                    {}}});
    }
    fields.push_back(*field);
  }
  while (reader.next()) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const std::optional<double> value = parse_number(reader[fields[i]]);
      if (!value) {
        throw ConfigError({Diagnostic{reader.place(fields[i]),
                                      fmt::format("'{}' is no number, which is needed in every row of '{}'",
                                                  reader[fields[i]], names[i]),
                                      {},
                                      {}}});
      }
      values.push_back(*value);
    }
  }
}

}  // namespace

Matrix read_columns(const std::vector<InputNode>& datasets, const std::vector<std::string>& names) {
  std::vector<double> values;
  for (const InputNode& dataset : datasets) read_values(dataset.folder / kDatasetFile, names, values);
  const std::size_t rows = values.size() / names.size();
  if (rows == 0) throw ConfigError(fmt::format("'{}' has no rows", datasets.front().id));
  Matrix table(rows, names.size());
  for (std::size_t i = 0; i < rows; ++i) {
    table.set_row(i, std::span<const double>(values).subspan(i * names.size(), names.size()));
  }
  return table;
}

void check_columns(const std::vector<InputNode>& datasets, const std::string& parameter,
                   const std::vector<std::string>& names, Rules& rules) {
  for (const InputNode& data : datasets) {
    const std::vector<std::string>& known = data.columns;
    for (const std::string& column : names) {
      if (known.empty() || std::find(known.begin(), known.end(), column) != known.end()) continue;
      rules.broken(parameter,
                   fmt::format("{}: the dataset '{}' has no column '{}'", parameter, data.id, column),
                   suggestion(column, known));
    }
  }
}

}  // namespace coppice
