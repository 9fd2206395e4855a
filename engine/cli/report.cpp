#include "engine/graph/report.h"

#include "engine/cli/command.h"
#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/last_run.h"

namespace coppice::cli {
namespace {

struct MakeReport {
  std::string folder = "out";

  static Arguments<MakeReport> arguments() {
    return Arguments<MakeReport>().positional("DIR", &MakeReport::folder,
                                              "Folder of results, or of one experiment in it.",
                                              Completes::folder, false);
  }

  int run(const CommandLine& line, Console& console) const {
    for (const std::filesystem::path& run_folder : run_folders(line, folder)) {
      write_reports(run_folder);
      console.offer((run_folder / "report.html").string() + '\n');
    }
    return kDone;
  }
};

const Command<MakeReport> kReport(
    {.name = "report",
     .group = Group::results,
     .rank = 2,
     .doc = "Makes the page of experiments, report.html, from what lies in their folders.",
     .details =
         "Every run does this at its end; this command also shows a run that goes on, and shows the "
         "page as a newer program makes it. Nothing is computed. The paths of the pages are written to "
         "stdout.",
     .examples = {{"runner report", "The pages of all experiments in out/."},
                  {"runner report out/quickstart", "The page of one."}}});

}  // namespace
}  // namespace coppice::cli
