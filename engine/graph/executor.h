#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/graph/compute.h"
#include "engine/graph/events.h"
#include "engine/graph/index.h"
#include "engine/graph/jobs.h"
#include "engine/graph/pool.h"
#include "engine/graph/run.h"
#include "engine/graph/run_folder.h"

namespace coppice {

/// One experiment of a run, with its folder.
struct Workspace {
  Workspace(const Plan& its_plan, const std::filesystem::path& out)
      : plan(its_plan), folder(out / its_plan.experiment.name) {}

  const Plan& plan;
  RunFolder folder;
  std::vector<NodeStatus> statuses;
  std::unique_ptr<Journal> journal;  ///< null for an experiment with nothing to do
  std::string started;
  bool failed = false;

  /// Nodes whose results are there, or come with those of others.
  std::size_t up_to_date() const;
};

/// Runs the jobs of several experiments on one core budget, each when what it reads is done.
class Executor {
 public:
  Executor(std::vector<std::unique_ptr<Workspace>>& workspaces, Store& store, Index& index,
           const RunOptions& options);

  /// Returns when every job is done, failed, skipped or interrupted.
  void run();

  const std::vector<std::string>& failures() const { return failures_; }
  const std::vector<std::string>& troubles() const { return troubles_; }
  bool interrupted() const { return interrupted_; }
  RunTotals totals() const;

 private:
  struct Active {
    std::size_t job = 0;
    const RunningContext* context = nullptr;
    std::chrono::steady_clock::time_point start;
  };
  using Lock = std::unique_lock<std::mutex>;

  const PlannedNode& node_of(const Job& job) const;
  Limits limits_of(const Job& job) const;
  Workspace& workspace_of(const NodePlace& place) const { return *workspaces_[place.plan]; }
  void submit(std::size_t job);
  void execute(std::size_t job, TaskParallel& parallel);
  ResultRecord compute(Job& job, TaskParallel& parallel, Active& active);
  void start(std::size_t job, Active& active);
  void settle_done(std::size_t job, const ResultRecord& record);
  void settle_failed(std::size_t job, const std::string& message);
  void settle_interrupted(std::size_t job);
  void skip_dependants(const Job& job);
  void tell(const Job& job, const char* what, const std::string& message, const ResultRecord* record);
  NodeReport report(const Job& job) const;
  std::vector<NodeReport> active_reports() const;
  std::optional<double> remaining_s() const;
  void predict();

  std::vector<std::unique_ptr<Workspace>>& workspaces_;
  Store& store_;
  Index& index_;
  const RunOptions& options_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::size_t limited_ = 0;  ///< jobs that need a process of their own
  std::atomic<bool> stop_{false};

  mutable std::mutex mutex_;  ///< of everything below
  std::condition_variable settled_;
  std::vector<Job> jobs_;
  std::vector<Active*> active_;
  RunTotals totals_;
  Durations durations_;
  double next_prediction_s_ = 0;
  std::vector<std::string> failures_, troubles_;
  bool interrupted_ = false;
  Pool pool_;  ///< last: its tasks use what is above
};

}  // namespace coppice
