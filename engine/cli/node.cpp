#include "engine/cli/command.h"
#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/interrupt.h"
#include "engine/cli/selection.h"
#include "engine/graph/run.h"

namespace coppice::cli {
namespace {

struct RunNode {
  std::string run_folder;
  std::string key;
  std::optional<std::uint64_t> jobs;
  std::optional<std::uint64_t> memory_limit;

  static Arguments<RunNode> arguments() {
    return Arguments<RunNode>()
        .positional("RUNDIR", &RunNode::run_folder, "Folder of the experiment's run.", Completes::folder)
        .positional("KEY", &RunNode::key, "Key of the node.", Completes::nothing)
        .option("-j,--jobs", "N", &RunNode::jobs, "Threads; one for each core when not given.")
        .option("--memory-limit", "BYTES", &RunNode::memory_limit, "Memory; unlimited when not given.");
  }

  int run(const CommandLine& line, Console&) const {
    watch_interrupts();
    RunOptions options;
    options.threads = thread_count(line, jobs);
    options.stop = &interrupt_requested();
    options.command = line.arguments();
    run_node(run_folder, key, static_cast<double>(memory_limit.value_or(0)), options);
    return kDone;
  }
};

const Command<RunNode> kNode({.name = "node",
                              .group = Group::project,
                              .doc = "Runs one node of a run folder, unless its result is there.",
                              .hidden = true});

}  // namespace
}  // namespace coppice::cli
