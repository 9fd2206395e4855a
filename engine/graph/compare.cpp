#include "engine/graph/compare.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "engine/data/file_system.h"
#include "engine/data/table_file.h"
#include "registry/source.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

using Row = std::vector<std::string>;
using Rows = std::map<Row, std::pair<Row, Summary>>;  ///< by keys: all cells, and what they say

/// A figure of times, which differ from run to run: its table says so.
bool is_figure_of_times(const fs::path& file) {
  const std::string name = file.filename().string();
  for (const std::string_view kind : {".csv", ".vl.json"}) {
    if (!name.ends_with(kind)) continue;
    return !is_reproducible(file.parent_path() / (name.substr(0, name.size() - kind.size()) + ".csv"));
  }
  return false;
}

std::set<std::string> result_files(const fs::path& folder) {
  std::set<std::string> files;
  for (const char* top : {"nodes", "tables", "figures"}) {
    std::error_code code;  // a run need not have them
    for (fs::recursive_directory_iterator i(folder / top, code), end; i != end; i.increment(code)) {
      const bool times = top == std::string_view("figures")
                             ? is_figure_of_times(i->path())
                             : i->path().filename().string().starts_with("timing.");
      if (i->is_regular_file() && !times) files.insert(i->path().lexically_relative(folder).string());
    }
  }
  return files;
}

bool same_bytes(const fs::path& a, const fs::path& b) {
  FileStamp first, second;
  if (!stamp_file(a.string(), first) || !stamp_file(b.string(), second)) return false;
  std::error_code code;
  return first.size == second.size && (fs::equivalent(a, b, code) || read_file(a) == read_file(b));
}

/// The config without what gives a run its name only.
std::string parameters_of(const fs::path& run_folder) {
  Element root = parse_xml(read_source((run_folder / "resolved.xml").string()));
  root.set("name", "");
  return to_xml(root);
}

/// Keys stand before the numbers of replicates.
std::size_t key_columns(const Table& table) {
  return table.has("n_replicates") ? table.column("n_replicates") : 0;
}

Summary summary_of(const Table& table, const std::vector<Cell>& row) {
  const auto value = [&](const char* name) {
    return table.has(name) ? number(row[table.column(name)]) : NAN;
  };
  Summary summary{value(table.has("mean") ? "mean" : "difference"), std::nullopt, 0};
  const double low = value("ci95_low"), high = value("ci95_high");
  if (!std::isnan(low) && !std::isnan(high)) summary.ci95 = Interval{low, high};
  const double replicates = value("n_replicates");
  const double units = replicates > 1 ? replicates : value("episodes");
  if (!std::isnan(units)) summary.units = static_cast<std::int64_t>(units);
  return summary;
}

Rows rows_of(const Table& table) {
  Rows rows;
  for (const std::vector<Cell>& row : table.rows) {
    Row cells;
    for (const Cell& cell : row) cells.push_back(cell_text(cell));
    const Row keys(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(key_columns(table)));
    rows[keys] = {cells, summary_of(table, row)};
  }
  return rows;
}

TableDifference compare_tables(const std::string& file, const fs::path& first, const fs::path& second) {
  const Table a = read_table(first / file), b = read_table(second / file);
  TableDifference difference{file, {}, 0, {}};
  for (std::size_t c = 0; c < key_columns(a); ++c) difference.keys.push_back(a.columns[c].name);
  const Rows before = rows_of(a);
  Rows now = rows_of(b);
  difference.rows = before.size();
  for (const auto& [keys, row] : before) {
    const auto other = now.find(keys);
    if (other == now.end()) {
      difference.differing.push_back({keys, row.second, std::nullopt});
      continue;
    }
    if (other->second.first != row.first)
      difference.differing.push_back({keys, row.second, other->second.second});
    now.erase(other);
  }
  difference.rows += now.size();
  for (const auto& [keys, row] : now) difference.differing.push_back({keys, std::nullopt, row.second});
  return difference;
}

}  // namespace

RunDifference compare_runs(const fs::path& first, const fs::path& second) {
  RunDifference difference;
  difference.other_parameters = !same_bytes(first / "resolved.xml", second / "resolved.xml") &&
                                parameters_of(first) != parameters_of(second);
  const std::set<std::string> before = result_files(first), now = result_files(second);
  std::set<std::string> all = before;
  all.insert(now.begin(), now.end());
  difference.files = all.size();
  for (const std::string& file : all) {
    const bool in_both = before.contains(file) && now.contains(file);
    if (in_both && same_bytes(first / file, second / file)) continue;
    difference.differing.push_back(file);
    if (in_both && file.starts_with("tables/") && file.ends_with(".csv"))
      difference.tables.push_back(compare_tables(file, first, second));
  }
  return difference;
}

}  // namespace coppice
