#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "engine/graph/node.h"
#include "engine/vocabulary/dataset.h"
#include "engine/vocabulary/policy.h"
#include "engine/vocabulary/problem.h"

namespace coppice {

// How node kinds read each other. All throw ConfigError or std::invalid_argument with what is wrong.

/// The problem of a `problem` node, made from its element.
std::shared_ptr<const Problem> load_problem(const InputNode& node);

/// The policy of a node that makes one (policy, train, select), prepared for the problem. While checking, a
/// learned policy is not there yet: null.
MadePolicy load_policy(const InputNode& node, const Problem& problem);

/// The dataset of a node that makes one.
Dataset load_dataset(const InputNode& node, const Spaces& spaces);

/// What a policy file holds (see docs/policy-files.md).
struct PolicyFile {
  std::string writer;      ///< name and version of the program
  std::string provenance;  ///< key of the node that made it
  Spaces spaces;           ///< empty when the policy was saved without a problem
  Element component;       ///< resolved
  Archive arrays;
};
/// Magic, format version, checksum, then the content; written atomically. Throws std::runtime_error.
void write_policy_file(const std::filesystem::path& file, const PolicyFile& content);
/// Throws ConfigError naming the file and what is wrong: not a policy file, truncated, damaged, newer format.
PolicyFile read_policy_file(const std::filesystem::path& file);
/// The policy of a file, loaded but not prepared.
MadePolicy make_policy(const PolicyFile& file);

}  // namespace coppice
