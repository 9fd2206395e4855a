#pragma once

#include <memory>
#include <string>

#include "engine/cli/command.h"
#include "engine/graph/artifacts.h"

namespace coppice::cli {

/// A policy file, and the problem it is to be used on.
struct PolicyInputs {
  std::string file;
  std::string problem;
  std::string config;
};

/// Declares FILE, --problem and --config; T derives from PolicyInputs.
template <class T>
Arguments<T> policy_arguments() {
  return Arguments<T>()
      .positional("FILE", static_cast<std::string T::*>(&T::file), "A policy file (*.policy).",
                  Completes::file)
      .option("--problem", "PROBLEM", static_cast<std::string T::*>(&T::problem),
              "A problem's name, or its element as in a config ('<double_integrator cost=\"...\"/>'); with "
              "--config, "
              "the id of a problem node.",
              Completes::problem)
      .option("--config", "CONFIG", static_cast<std::string T::*>(&T::config),
              "Config that --problem is looked up in.", Completes::config);
}

/// A policy that can act.
struct ReadyPolicy {
  PolicyFile file;
  MadePolicy policy;
  Spaces spaces;
  std::shared_ptr<const Problem> problem;  ///< null when none was given
  std::string problem_name;
};

/// Reads the file, makes the policy and prepares it for the problem given, or for the spaces in the file.
/// Throws ConfigError for what does not fit.
ReadyPolicy ready_policy(const CommandLine& line, const PolicyInputs& inputs);

}  // namespace coppice::cli
