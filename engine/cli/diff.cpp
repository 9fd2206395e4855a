#include <fmt/format.h>

#include <map>

#include "engine/cli/command.h"
#include "engine/cli/console.h"
#include "engine/cli/difference.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/last_run.h"

namespace coppice::cli {
namespace {

namespace fs = std::filesystem;

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
      console.out(difference_text(name, difference, all_files));
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
