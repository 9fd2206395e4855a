#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/graph/plan.h"

namespace coppice {

/// Why a node runs, or does not.
enum class Reason {
  definition,
  up_to_date,
  not_selected,
  new_node,
  changed,
  missing_output,
  damaged,
  forced,
  shared
};

/// A line of the key text that differs from the last run's.
struct Change {
  std::string what;  ///< "solver.trees", or the id of an input node
  std::string before;
  std::string now;
};

/// What a run would do with a node.
struct NodeStatus {
  Reason reason = Reason::new_node;
  bool runs = false;            ///< false when its result is there, if only in the store, from another run
  bool placed = false;          ///< its result lies in the run folder
  std::vector<Change> changes;  ///< of `changed`
  std::string shared_with;      ///< of `shared`: the node that makes the same result in this run
  std::optional<double> predicted_s;  ///< from recorded durations; none without evidence
};

/// The reason in words: "changed: solver.trees: 25 -> 50", "up to date", ...
std::string to_text(const NodeStatus& status);

/// A node that the user asked for, by its id or name, and where.
struct SelectedNode {
  std::string id;
  Place place;

  SelectedNode(std::string name, Place where = {}) : id(std::move(name)), place(std::move(where)) {}
  SelectedNode(const char* name) : id(name) {}
};

/// Which nodes the user asked for. Of several configs each has those that it knows.
struct Selection {
  std::vector<SelectedNode> only;   ///< these and what they need; empty: all
  std::vector<SelectedNode> force;  ///< run again, with what depends on them
};

/// Throws ConfigError for every node that none of the configs has, with the nearest, and for those forced
/// that are left out wherever they are.
void check_selection(const std::vector<Plan>& plans, const Selection& selection);

/// Whether the selection leaves any node of this config in.
bool selects_any(const Plan& plan, const Selection& selection);

/// The state of every node of the plan in the output folder `out`. Reads only: dates of files, and the whole
/// of those that a node that runs will read, which therefore are what was stored. Of nodes with one key the
/// first runs.
std::vector<NodeStatus> inspect(const Plan& plan, const Selection& selection,
                                const std::filesystem::path& out);

/// The same for all plans of a run.
std::vector<std::vector<NodeStatus>> inspect(const std::vector<Plan>& plans, const Selection& selection,
                                             const std::filesystem::path& out);

/// Time that the running nodes would take on so many cores; none unless every one has a prediction.
std::optional<double> predicted_total(const std::vector<NodeStatus>& nodes, int threads);

/// One node's key in full, and what changed since the last run.
struct Explanation {
  std::string name;
  std::string key;
  std::string key_text;  ///< lines "name = value"
  NodeStatus status;
};

/// Explains the nodes with this id or name. Throws ConfigError when there is none, with the nearest.
std::vector<Explanation> explain(const Plan& plan, std::string_view id_or_name,
                                 const std::filesystem::path& out);

/// How far one node of a run is.
struct NodeState {
  std::string name;
  std::string id;
  bool done = false;                    ///< its result is there
  std::string message;                  ///< of its failure in the last run that tried it
  std::optional<double> wall_s, cpu_s;  ///< what computing its result took; none until it is there
};

/// A run folder as `runner status` and the page show it, also while the run goes on.
struct RunStatus {
  std::string experiment;
  bool running = false;  ///< a process holds the folder
  std::size_t nodes = 0;
  std::size_t finished = 0;
  std::size_t failed = 0;
  std::vector<std::string> messages;  ///< of failed nodes
  std::vector<NodeState> states;      ///< of all nodes but definitions
};

/// Throws ConfigError when the folder is not one of a run.
RunStatus read_status(const std::filesystem::path& run_folder);

}  // namespace coppice
