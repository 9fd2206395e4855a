#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/cli/command.h"
#include "engine/config/experiment.h"
#include "engine/graph/plan.h"

namespace coppice::cli {

/// Configs and overrides, as every command that reads configs takes them.
struct ConfigInputs {
  std::vector<std::string> words;  ///< CONFIG... and name:=value, in any order
  std::optional<std::uint64_t> seed;
};

/// Declares CONFIG... and --seed; T derives from ConfigInputs.
template <class T>
Arguments<T> config_arguments() {
  return Arguments<T>()
      .positional("CONFIG", static_cast<std::vector<std::string> T::*>(&T::words),
                  "Config files, and name:=value for their arguments; a comma list sweeps the argument.",
                  Completes::config)
      .option("--seed", "N", static_cast<std::optional<std::uint64_t> T::*>(&T::seed),
              "Root seed, in place of the configs' own.");
}

/// Expands every config. Throws ConfigError with the mistakes of all; a file that is not there is named with
/// the nearest one that is.
std::vector<ExperimentConfig> expand_all(const CommandLine& line, const ConfigInputs& inputs);

/// The same, planned.
std::vector<Plan> plan_all(const CommandLine& line, const ConfigInputs& inputs);

/// The same, once in a process, for a command that then ends: taking large plans apart would be a tenth of an
/// up-to-date run.
std::vector<Plan>& plan_to_keep(const CommandLine& line, const ConfigInputs& inputs);

/// An existing path near to `path`, each of its parts corrected; empty when there is none.
std::string nearest_path(const std::string& path);

/// Throws ConfigError unless the argument is a file that can be read.
void require_file(const CommandLine& line, const std::string& argument);

}  // namespace coppice::cli
