#include "engine/cli/difference.h"

#include <fmt/format.h>

#include "engine/cli/layout.h"

namespace coppice::cli {
namespace {

std::string text_of(const std::optional<Summary>& summary) {
  if (!summary) return "no such row";
  std::string text = fmt::format("{:.5g}", summary->mean);
  if (summary->ci95) text += fmt::format(" [{:.5g}, {:.5g}]", summary->ci95->low, summary->ci95->high);
  return text;
}

std::string text_of_change(const RowDifference& row) {
  if (!row.first || !row.second) return {};
  std::string text = fmt::format("{:+.5g}", row.second->mean - row.first->mean);
  if (const std::optional<Interval> interval = welch_interval(*row.first, *row.second))
    text += fmt::format(" [{:+.5g}, {:+.5g}]", interval->low, interval->high);
  return text;
}

std::string text_of(const TableDifference& table) {
  std::vector<std::vector<std::string>> rows = {table.keys};
  for (const char* column : {"first", "second", "difference"}) rows[0].emplace_back(column);
  for (const RowDifference& row : table.differing) {
    std::vector<std::string>& cells = rows.emplace_back(row.keys);
    cells.resize(table.keys.size());
    cells.insert(cells.end(), {text_of(row.first), text_of(row.second), text_of_change(row)});
  }
  return fmt::format("{}: {} of {} differ\n", table.file, table.differing.size(),
                     counted(table.rows, "row")) +
         aligned(rows, 2);
}

}  // namespace

std::string difference_text(const std::string& name, const RunDifference& difference, bool all_files) {
  std::string text;
  for (const TableDifference& table : difference.tables) text += text_of(table);
  if (all_files) {
    for (const std::string& file : difference.differing) text += file + " differs\n";
  }
  const std::string files = counted(difference.files, "result file");
  std::string verdict = difference.differing.empty()
                            ? files + ", all equal"
                            : fmt::format("{} of {} differ", difference.differing.size(), files);
  if (difference.other_parameters) verdict += "; parameters differ, see resolved.xml";
  return text + name + ": " + verdict + '\n';
}

}  // namespace coppice::cli
