#include "engine/graph/status.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/cli/command.h"
#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/last_run.h"
#include "engine/cli/layout.h"

namespace coppice::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string state(const RunStatus& run) {
  if (run.running) return "running";
  if (run.failed > 0) return "failed";
  return run.finished == run.nodes ? "done" : "incomplete";
}

Json json(const RunStatus& run) {
  Json object = {{"experiment", run.experiment}, {"state", state(run)},  {"nodes", run.nodes},
                 {"finished", run.finished},     {"failed", run.failed}, {"node_states", Json::array()}};
  for (const NodeState& node : run.states) {
    object["node_states"].push_back(
        {{"name", node.name}, {"id", node.id}, {"done", node.done}, {"message", node.message}});
  }
  return object;
}

struct Status {
  std::string folder = "out";
  bool as_json = false;

  static Arguments<Status> arguments() {
    return Arguments<Status>()
        .positional("DIR", &Status::folder, "Folder of results, or of one experiment in it.",
                    Completes::folder, false)
        .flag("--json", &Status::as_json, "The same as JSON, with the state of every node.");
  }

  int run(const CommandLine& line, Console& console) const {
    std::vector<std::vector<std::string>> rows;
    std::string messages;
    Json all = Json::array();
    for (const std::filesystem::path& run_folder : run_folders(line, folder)) {
      const RunStatus run = read_status(run_folder);
      rows.push_back({run.experiment, state(run), fmt::format("{}/{} nodes", run.finished, run.nodes),
                      run.failed > 0 ? fmt::format("{} failed", run.failed) : ""});
      for (const std::string& message : run.messages) messages += run.experiment + ": " + message + '\n';
      all.push_back(json(run));
    }
    console.out(as_json ? all.dump(2, ' ', false, Json::error_handler_t::replace) + '\n'
                        : aligned(rows) + messages);
    return kDone;
  }
};

const Command<Status> kStatus(
    {.name = "status",
     .group = Group::results,
     .rank = 1,
     .doc = "Shows how far the runs of an output folder are, also while they go on.",
     .examples = {{"runner status", "The experiments in out/."},
                  {"runner status out/quickstart --json", "One of them, as JSON."}}});

}  // namespace
}  // namespace coppice::cli
