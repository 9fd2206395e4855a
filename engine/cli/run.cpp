#include "engine/graph/run.h"

#include <fmt/format.h>

#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/inputs.h"
#include "engine/cli/interrupt.h"
#include "engine/cli/layout.h"
#include "engine/cli/progress.h"
#include "engine/cli/selection.h"
#include "engine/graph/artifacts.h"
#include "engine/graph/report.h"
#include "engine/graph/run_folder.h"

namespace coppice::cli {
namespace {

namespace fs = std::filesystem;

/// The tables and figures that the nodes of a plan show, and the page with all of them, as far as they are
/// there.
std::string published_files(const Plan& plan, const fs::path& out) {
  std::string text;
  for (const PlannedNode& node : plan.nodes) {
    if (node.definition || node.node->published_in().empty()) continue;
    const fs::path file = out / plan.experiment.name / place_of_file(node, kTableFile);
    if (fs::exists(file)) text += file.string() + '\n';
  }
  const fs::path page = out / plan.experiment.name / "report.html";
  if (fs::exists(page)) text += page.string() + '\n';
  return text;
}

std::string summary(const Console& console, const RunOutcome& outcome) {
  const RunTotals& totals = outcome.totals;
  if (totals.to_run == 0) return "everything is up to date: " + counted(totals.up_to_date, "node") + '\n';
  std::string text = outcome.interrupted              ? console.styled(Console::Style::yellow, "interrupted")
                     : outcome.exit_status() == kDone ? console.styled(Console::Style::green, "done")
                                                      : console.styled(Console::Style::red, "failed");
  text += fmt::format(": {} run, {} up to date", counted(totals.finished, "node"), totals.up_to_date);
  if (totals.failed > 0) text += fmt::format(", {} failed", totals.failed);
  if (totals.skipped > 0) text += fmt::format(", {} skipped because an input failed", totals.skipped);
  text += ", in " + duration_text(totals.elapsed_s) + '\n';
  if (outcome.interrupted) text += "the same command goes on from here\n";
  return text;
}

struct Run : ConfigInputs, SelectionInputs {
  std::optional<std::uint64_t> jobs;
  bool keep_going = false;
  bool fail_fast = false;
  std::string on = "local";
  std::string progress = "auto";

  static Arguments<Run> arguments() {
    return add_selection(config_arguments<Run>())
        .option("-j,--jobs", "N", &Run::jobs,
                "Cores to use, for nodes and for the threads inside them together; all when not given.")
        .flag("--keep-going", &Run::keep_going,
              "After a failure, finish everything that does not depend on it. This is the default.")
        .flag("--fail-fast", &Run::fail_fast, "Stop at the first failure.")
        .choice("--on", &Run::on, {"local"}, "Where nodes run.")
        .choice("--progress", &Run::progress, {"auto", "plain", "json", "none"},
                "How the run is shown on stderr; auto: a status area on a terminal, else a line per node.");
  }

  int run(const CommandLine& line, Console& console) const {
    if (keep_going && fail_fast)
      throw line.error("--fail-fast", "'--keep-going' and '--fail-fast' exclude each other");
    watch_interrupts();
    std::vector<Plan>& plans = plan_to_keep(line, *this);
    const Selection selected = selection(line);
    check_selection(plans, selected);
    const bool talks = progress == "auto" || progress == "plain";
    std::erase_if(plans, [&](const Plan& plan) {
      const bool none = !selects_any(plan, selected);
      if (none && talks) console.say(plan.experiment.name + ": none of its nodes is selected\n");
      return none;
    });
    const std::unique_ptr<RunListener> listener = make_progress(progress, console, interrupt_requested());
    RunOptions options;
    options.out = out;
    options.threads = thread_count(line, jobs);
    options.selection = selected;
    options.fail_fast = fail_fast;
    options.stop = &interrupt_requested();
    options.listener = listener.get();
    options.command = line.arguments();
    options.page = write_reports;
    const RunOutcome outcome = coppice::run(plans, options);
    for (const std::string& trouble : outcome.troubles)
      console.say(console.styled(Console::Style::red, "error") + ": " + trouble + "\n");
    if (talks) console.say(summary(console, outcome));
    for (const Plan& plan : plans) console.offer(published_files(plan, out));
    return outcome.exit_status();
  }
};

const Command<Run> kRun(
    {.name = "run",
     .group = Group::experiments,
     .rank = 1,
     .doc = "Plans and executes experiments; what is up to date is not run again.",
     .details =
         "The same command resumes a run that was interrupted or killed. The first Ctrl-C lets running nodes "
         "save their state and ends; the second ends at once. Either way nothing that was finished is lost. "
         "The paths of the tables, of the figures' data and of the report are written to stdout, one per "
         "line.",
     .examples = {{"runner configs/quickstart.xml", "Runs one experiment; results go to out/quickstart."},
                  {"runner run configs/quickstart.xml --out results -j 1 --progress plain",
                   "On one core, into another folder, with one line per finished node."},
                  {"runner configs/quickstart.xml replicates:=2 --seed 7",
                   "Sets an argument of the config, and the root seed."}}});

}  // namespace
}  // namespace coppice::cli
