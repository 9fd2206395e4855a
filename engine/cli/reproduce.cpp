#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "engine/cli/console.h"
#include "engine/cli/difference.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/inputs.h"
#include "engine/cli/interrupt.h"
#include "engine/cli/last_run.h"
#include "engine/cli/layout.h"
#include "engine/cli/progress.h"
#include "engine/cli/selection.h"
#include "engine/data/file_system.h"
#include "engine/graph/provenance.h"
#include "engine/graph/report.h"
#include "engine/graph/run.h"

namespace coppice::cli {
namespace {

namespace fs = std::filesystem;
/// Program, machine and input files of a recorded run, by name; empty where nothing is recorded.
std::map<std::string, std::string> circumstances(const fs::path& run_folder) {
  std::map<std::string, std::string> found;
  try {
    const nlohmann::json record = nlohmann::json::parse(read_file(run_folder / "provenance.json"));
    for (const auto& [name, value] : record.at("environment").items()) found[name] = value.get<std::string>();
    for (const nlohmann::json& input : record.at("inputs"))
      found["input " + input.at("path").get<std::string>()] = input.at("hash").get<std::string>();
  } catch (const std::exception&) {  // damaged, or not there
    return {};
  }
  return found;
}

/// What was not the same when the experiment ran again. The configs it was expanded from play no part.
std::string changed_circumstances(const fs::path& first, const fs::path& second) {
  const std::map<std::string, std::string> before = circumstances(first), now = circumstances(second);
  if (before.empty()) return "no provenance.json says how it was run\n";
  std::string text;
  for (const auto& [name, value] : now) {
    const auto old = before.find(name);
    if (old != before.end() && old->second != value)
      text += fmt::format("{}: {} -> {}\n", name, old->second, value);
  }
  return text;
}

struct Reproduce {
  std::string folder;
  std::string out = "reproduced";
  std::optional<std::uint64_t> jobs;
  std::string progress = "auto";

  static Arguments<Reproduce> arguments() {
    return Arguments<Reproduce>()
        .positional("DIR", &Reproduce::folder, "Folder of results, or of one experiment in it.",
                    Completes::folder)
        .option("--out", "DIR", &Reproduce::out, "Folder of the new results.", Completes::folder)
        .option("-j,--jobs", "N", &Reproduce::jobs, "Cores to use; all when not given.")
        .choice("--progress", &Reproduce::progress, {"auto", "plain", "json", "none"},
                "How the run is shown on stderr.");
  }

  int run(const CommandLine& line, Console& console) const {
    const std::vector<fs::path> recorded = run_folders(line, folder);
    ConfigInputs inputs;
    for (const fs::path& run_folder : recorded) {
      if (fs::weakly_canonical(run_folder.parent_path() / ".") == fs::weakly_canonical(fs::path(out) / "."))
        throw line.error(out, "'" + out + "' holds the results that are to be reproduced",
                         "--out takes another folder");
      inputs.words.push_back((run_folder / "resolved.xml").string());
    }
    watch_interrupts();
    const std::vector<Plan> plans = plan_all(line, inputs);
    const RunOutcome outcome = again(plans, line, console);
    if (outcome.interrupted) return kInterrupted;
    bool equal = outcome.failures.empty();
    for (std::size_t i = 0; i < plans.size(); ++i) {
      const std::string& name = plans[i].experiment.name;
      const RunDifference difference = compare_runs(recorded[i], fs::path(out) / name);
      equal = equal && difference.differing.empty();
      console.out(changed_circumstances(recorded[i], fs::path(out) / name) +
                  difference_text(name, difference, false));
    }
    return equal ? kDone : kFailed;
  }

 private:
  RunOutcome again(const std::vector<Plan>& plans, const CommandLine& line, Console& console) const {
    const std::unique_ptr<RunListener> listener = make_progress(progress, console, interrupt_requested());
    RunOptions options;
    options.out = out;
    options.threads = thread_count(line, jobs);
    options.stop = &interrupt_requested();
    options.listener = listener.get();
    options.command = line.arguments();
    options.page = write_reports;
    return coppice::run(plans, options);
  }
};

const Command<Reproduce> kReproduce(
    {.name = "reproduce",
     .group = Group::results,
     .rank = 4,
     .doc = "Runs recorded experiments again, from their resolved.xml, and says what differs.",
     .details =
         "What the configs have become since plays no part; policies and data that an experiment reads from "
         "files must still be there. Shown are the versions, the machine and the input files that differ, "
         "and "
         "then what 'runner diff' shows. The exit status is 0 when all result files are equal, and 1 when "
         "some "
         "differ or a node failed.",
     .examples = {{"runner reproduce out/quickstart", "Runs it again, into reproduced/quickstart."}}});

}  // namespace
}  // namespace coppice::cli
