#include <fmt/format.h>

#include <map>
#include <set>

#include "engine/cli/command.h"
#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/last_run.h"
#include "engine/cli/layout.h"
#include "engine/graph/compare.h"

namespace coppice::cli {
namespace {

namespace fs = std::filesystem;

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

struct Diff {
  std::string first, second;
  bool all_files = false;

  static Arguments<Diff> arguments() {
    return Arguments<Diff>()
        .positional("DIR", &Diff::first, "Folder of results, or of one experiment in it.", Completes::folder)
        .positional("OTHER", &Diff::second, "The one that it is compared with.", Completes::folder)
        .flag("--files", &Diff::all_files, "Also name every result file that differs.");
  }

  int run(const CommandLine& line, Console& console) const {
    std::map<std::string, fs::path> before = by_name(line, first), now = by_name(line, second);
    if (before.size() == 1 && now.size() == 1 && before.begin()->first != now.begin()->first)
      now = {{before.begin()->first, now.begin()->second}};  // one experiment under two names
    bool equal = true;
    for (const auto& [name, folder] : before) {
      const auto other = now.find(name);
      if (other == now.end()) {
        console.out(fmt::format("{}: only in {}\n", name, first));
        equal = false;
        continue;
      }
      const RunDifference difference = compare_runs(folder, other->second);
      equal = equal && difference.differing.empty();
      console.out(text_of(name, difference));
    }
    for (const auto& [name, folder] : now) {
      if (before.contains(name)) continue;
      console.out(fmt::format("{}: only in {}\n", name, second));
      equal = false;
    }
    return equal ? kDone : kFailed;
  }

 private:
  static std::map<std::string, fs::path> by_name(const CommandLine& line, const std::string& folder) {
    std::map<std::string, fs::path> folders;
    for (const fs::path& run_folder : run_folders(line, folder))
      folders[fs::weakly_canonical(run_folder).filename().string()] = run_folder;
    return folders;
  }

  std::string text_of(const std::string& name, const RunDifference& difference) const {
    std::string text;
    for (const TableDifference& table : difference.tables) text += cli::text_of(table);
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
};

const Command<Diff> kDiff(
    {.name = "diff",
     .group = Group::results,
     .rank = 3,
     .doc = "Compares the results of two runs: which rows of tables differ, and by how much.",
     .details =
         "The exit status is 0 when all result files are equal, and 1 when some differ. Times are not "
         "compared. Means stand with their 95 % intervals; the interval of a difference is Welch's, as of "
         "independent runs. Runs with the same seed share random numbers, and differ by less than it says.",
     .examples = {{"runner diff out out", "A run is equal to itself."},
                  {"runner diff out/quickstart out/quickstart --files", "The same for one experiment."}}});

}  // namespace
}  // namespace coppice::cli
