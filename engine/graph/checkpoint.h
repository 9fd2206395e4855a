#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "engine/vocabulary/archive.h"

namespace coppice {

/// What a node has used so far, over all attempts that its checkpoints join.
struct WorkDone {
  double wall_s = 0;
  double cpu_s = 0;
  std::map<std::string, std::int64_t> counts;  ///< "steps", "evaluations", ...
  std::map<std::string, double> measures;      ///< CPU time of one: "episode", "action"
};

/// A node's half-done work, as it lies in the store until the node is done.
struct Checkpoint {
  WorkDone work;
  Archive state;  ///< of the node
};

/// What a checkpoint's file holds.
std::string checkpoint_bytes(const Checkpoint& checkpoint);

/// None when there is none, or a damaged one: the work then begins anew.
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& file);

}  // namespace coppice
