#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/graph/plan.h"
#include "engine/graph/status.h"

namespace coppice {

/// Numbers of the whole run, over all its experiments. Definitions do not count.
struct RunTotals {
  std::size_t to_run = 0;
  std::size_t up_to_date = 0;
  std::size_t running = 0;
  std::size_t finished = 0;
  std::size_t failed = 0;
  std::size_t skipped = 0;  ///< not run because an input failed
  double elapsed_s = 0;
  std::optional<double> remaining_s;  ///< from recorded durations; none without evidence
};

/// What a listener hears about one node.
struct NodeReport {
  const PlannedNode* node = nullptr;
  std::string experiment;
  std::int64_t done = 0;  ///< units of work, as the node counts them
  std::int64_t total = 0;
  double wall_s = 0;
  double cpu_s = 0;
  std::string message;  ///< of a failure
};

/// Hears how a run goes. Calls come one at a time, from any thread.
class RunListener {
 public:
  virtual ~RunListener() = default;
  virtual void begin(const RunTotals&) {}
  virtual void started(const NodeReport&, const RunTotals&) {}
  virtual void finished(const NodeReport&, const RunTotals&) {}
  virtual void failed(const NodeReport&, const RunTotals&) {}
  virtual void skipped(const NodeReport&, const RunTotals&) {}
  virtual void interrupted(const NodeReport&, const RunTotals&) {}
  /// About ten times a second, with the nodes that run.
  virtual void tick(const std::vector<NodeReport>&, const RunTotals&) {}
  virtual void end(const RunTotals&) {}
};

struct RunOptions {
  std::filesystem::path out = "out";
  int threads = 0;  ///< cores for nodes and the threads inside them; 0: all
  Selection selection;
  bool fail_fast = false;  ///< stop at the first failure; else finish what does not depend on it
  const std::atomic<bool>* stop = nullptr;  ///< set by Ctrl-C: running nodes save a checkpoint and end
  RunListener* listener = nullptr;
  std::filesystem::path runner;      ///< program for nodes with limits; empty: this one
  std::vector<std::string> command;  ///< recorded in provenance.json
  /// Writes the page of a run folder, report.html; called at the end of a run that changed something in it.
  std::function<void(const std::filesystem::path& run_folder)> page;
};

struct RunOutcome {
  RunTotals totals;
  std::vector<std::string> failures;  ///< "node scores variant=HA r003: ..."
  std::vector<std::string> troubles;  ///< with what is about no node: tables of all replicates, the page, ...
  bool interrupted = false;
  /// 0 all done, 1 a node failed, 3 interrupted.
  int exit_status() const { return interrupted ? 3 : failures.empty() && troubles.empty() ? 0 : 1; }
};

/// Runs what is not up to date in `options.out`, one folder for each experiment. The same call resumes.
/// Throws ConfigError when nothing can be run: an output folder that cannot be written, or one that another
/// run uses.
RunOutcome run(const std::vector<Plan>& plans, const RunOptions& options);

/// Runs the node with this key of a run folder, from its resolved.xml, unless its result is there: what the
/// hidden command `runner node RUNDIR KEY` does. With a limit of its memory in byte, unless that is 0. Prints
/// nothing; a failure is thrown.
void run_node(const std::filesystem::path& run_folder, const std::string& key, double memory_limit,
              const RunOptions& options);

}  // namespace coppice
