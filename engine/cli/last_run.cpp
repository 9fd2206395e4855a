#include "engine/cli/last_run.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/cli/inputs.h"
#include "engine/cli/parse.h"
#include "engine/data/file_system.h"

namespace coppice::cli {
namespace {

namespace fs = std::filesystem;

bool is_run_folder(const fs::path& folder) {
  return fs::is_regular_file(folder / "resolved.xml");
}

/// The words after `runner` of the command that ran last in the folder; empty when it is not recorded.
std::vector<std::string> recorded_command(const fs::path& run_folder) {
  try {
    return nlohmann::json::parse(read_file(run_folder / "provenance.json"))
        .at("command")
        .get<std::vector<std::string>>();
  } catch (const nlohmann::json::exception&) {  // damaged, or without it
    return {};
  } catch (const std::runtime_error&) {  // not there
    return {};
  }
}

/// The configs, overrides and seed of a recorded `run`.
ConfigInputs recorded_inputs(const Request& request) {
  ConfigInputs inputs;
  for (std::size_t i = 0; i < request.given.size(); ++i) {
    const std::string& name = request.command->arguments[i].name;
    const std::vector<std::string>& given = request.given[i];
    if (name == "CONFIG") inputs.words = given;
    if (name == "--seed" && !given.empty()) detail::read_text(given.front(), inputs.seed);
  }
  return inputs;
}

}  // namespace

std::vector<fs::path> run_folders(const CommandLine& line, const std::string& folder) {
  if (is_run_folder(folder)) return {folder};
  std::vector<fs::path> found;
  if (fs::is_directory(folder)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (is_run_folder(entry.path())) found.push_back(entry.path());
    }
  }
  std::sort(found.begin(), found.end());
  if (found.empty()) {
    throw line.error(folder, "'" + folder + "' holds no results of a run",
                     "runner CONFIG... --out DIR makes them");
  }
  return found;
}

std::vector<Plan> plans_of_last_runs(const CommandLine& line, const std::string& out) {
  std::vector<Plan> plans;
  std::vector<std::vector<std::string>> seen;
  for (const fs::path& run_folder : run_folders(line, out)) {
    std::vector<std::string> command = recorded_command(run_folder);
    if (command.empty() || std::find(seen.begin(), seen.end(), command) != seen.end()) continue;
    const CommandLine recorded(command);
    seen.push_back(std::move(command));
    for (Plan& plan : plan_all(recorded, recorded_inputs(parse(recorded)))) plans.push_back(std::move(plan));
  }
  if (seen.empty()) {
    throw line.error(out, "no provenance.json in '" + out + "' says which configs were run",
                     "name them after the node");
  }
  return plans;
}

}  // namespace coppice::cli
