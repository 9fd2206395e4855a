#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/cli/command.h"
#include "engine/graph/status.h"

namespace coppice::cli {

/// Where results are, and which nodes are asked for: what run, plan and why agree on.
struct SelectionInputs {
  std::string out = "out";
  std::vector<std::string> only;
  std::vector<std::string> force;

  Selection selection(const CommandLine& line) const;
};

/// Declares --out, --only and --force; T derives from SelectionInputs.
template <class T>
Arguments<T> add_selection(Arguments<T> arguments) {
  return arguments
      .option("--out", "DIR", static_cast<std::string T::*>(&T::out), "Folder of the results.",
              Completes::folder)
      .option("--only", "ID", static_cast<std::vector<std::string> T::*>(&T::only),
              "Only the nodes with this id and what they need; may be repeated.", Completes::node)
      .option("--force", "ID", static_cast<std::vector<std::string> T::*>(&T::force),
              "Run these nodes again, and what depends on them; may be repeated.", Completes::node);
}

/// The value of -j; 0 when not given, which means all cores.
int thread_count(const CommandLine& line, const std::optional<std::uint64_t>& jobs);

}  // namespace coppice::cli
