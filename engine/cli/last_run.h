#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/cli/command_line.h"
#include "engine/graph/plan.h"

namespace coppice::cli {

/// The run folders in a folder of results, or the folder itself when it is one. Throws ConfigError when there
/// are none.
std::vector<std::filesystem::path> run_folders(const CommandLine& line, const std::string& folder);

/// The experiments of an output folder, with the configs as they are now and the overrides of the last run.
/// Throws ConfigError when there are none.
std::vector<Plan> plans_of_last_runs(const CommandLine& line, const std::string& out);

}  // namespace coppice::cli
