#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/data/table_file.h"
#include "engine/graph/node.h"
#include "engine/vocabulary/approximator.h"
#include "engine/vocabulary/dataset.h"
#include "engine/vocabulary/objective.h"
#include "engine/vocabulary/policy.h"
#include "engine/vocabulary/problem.h"

namespace coppice {

// How node kinds read each other. All throw ConfigError or std::invalid_argument with what is wrong.

// Names of the files that nodes make for others.
inline constexpr std::string_view kPolicyFile = "policy.policy";
inline constexpr std::string_view kDatasetFile = "dataset.csv";
inline constexpr std::string_view kFunctionFile = "function.function";  ///< of a fit
inline constexpr std::string_view kValueFile = "value.function";        ///< of a training
inline constexpr std::string_view kEvaluationFile = "evaluation.csv";
inline constexpr std::string_view kScoresFile = "scores.csv";  ///< of a fit
inline constexpr std::string_view kReturnsFile = "returns.csv";
inline constexpr std::string_view kProgressFile = "progress.csv";
inline constexpr std::string_view kSelectionFile = "selection.csv";
inline constexpr std::string_view kSearchFile = "search.csv";              ///< of a search as a whole
inline constexpr std::string_view kOptimumFile = "optimum.csv";            ///< what it found
inline constexpr std::string_view kImprovementsFile = "improvements.csv";  ///< when it got better
inline constexpr std::string_view kTargetsFile = "targets.csv";            ///< when it was good enough
inline constexpr std::string_view kTableFile = "table.csv";                ///< of nodes that show tables

/// The problem of a `problem` node, made from its element.
std::shared_ptr<const Problem> load_problem(const InputNode& node);

/// The test function's family of an `objective` node, likewise.
Sub<Objective> load_objective(const InputNode& node);

/// The spaces of the problem of a `problem` node.
std::shared_ptr<const Spaces> load_spaces(const InputNode& node);

/// The policy of a node that makes one (policy, train, select), prepared for the problem. While checking, a
/// learned policy is not there yet: null, after a look at what is known of it.
MadePolicy load_policy(const InputNode& node, const Problem& problem);

/// Writes the policy that a node makes for a problem with these spaces.
void write_policy(const MadePolicy& policy, const Spaces& spaces, NodeContext& context);

/// Why two datasets say the same twice, as "come from the same draws (collect 0)"; empty when they do not, as
/// far as is known.
std::string common_origin(const InputNode& a, const InputNode& b);

/// What of a dataset's node is known when planning: throws std::invalid_argument when it is of another
/// problem.
void require_samples_of(const InputNode& node, const Problem& problem);

/// The dataset of a node that makes one.
Dataset load_dataset(const InputNode& node, const Spaces& spaces);

/// The dataset columns that a value function depends on: the state axes, and for the value of actions the
/// action axes after them.
std::vector<std::string> value_columns(const Spaces& spaces, bool of_actions);

/// The value function of a node that makes a function of the state axes, or of state and action axes (fit,
/// train). While checking it is not there yet: null.
MadeFunction load_value_function(const InputNode& node, const Spaces& spaces);

/// Throws std::invalid_argument when states and actions of `given` are not those of `problem`, up to their
/// limits: a policy learned for one variant of a problem can act in another. `what` names the owner of
/// `given`.
void require_same_axes(const Spaces& given, const Spaces& problem, std::string_view what);

/// What a policy file holds (see docs/policy-files.md).
struct PolicyFile {
  std::string writer;      ///< name and version of the program; filled in by writing when empty
  std::string provenance;  ///< key of the node that made it
  Spaces spaces;           ///< empty when the policy was saved without a problem
  Element component;       ///< resolved
  Archive arrays;
};
/// Magic, format version, checksum, then the content; written atomically. Throws std::runtime_error.
void write_policy_file(const std::filesystem::path& file, const PolicyFile& content);
/// Throws ConfigError naming the file and what is wrong: not a policy file, truncated, damaged, newer format.
PolicyFile read_policy_file(const std::filesystem::path& file);
/// The same of a file's bytes.
PolicyFile parse_policy_file(std::string_view bytes, const std::filesystem::path& file);
/// The policy of a file, loaded but not prepared.
MadePolicy make_policy(const PolicyFile& file);

/// What a function file holds.
struct FunctionFile {
  std::string writer;               ///< as in PolicyFile
  std::string provenance;           ///< as in PolicyFile
  std::vector<std::string> inputs;  ///< columns of datasets ("s_position")
  std::string output;               ///< column of datasets, or "value"
  Element component;                ///< resolved
  Archive arrays;
};
/// As write_policy_file, read_policy_file and make_policy.
void write_function_file(const std::filesystem::path& file, const FunctionFile& content);
FunctionFile read_function_file(const std::filesystem::path& file);
/// That of a node that makes a function (fit, train), which has run.
FunctionFile load_function_file(const InputNode& node);
MadeFunction make_function(const FunctionFile& file);

}  // namespace coppice
