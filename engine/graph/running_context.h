#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <string>

#include "engine/graph/checkpoint.h"
#include "engine/graph/planned_context.h"
#include "engine/graph/pool.h"
#include "engine/graph/store.h"

namespace coppice {

/// What a node sees while it runs.
class RunningContext : public PlannedContext {
 public:
  /// `folder` is where it writes, `store` where its checkpoints lie.
  RunningContext(const Plan& plan, std::size_t node, const std::filesystem::path& run_folder,
                 std::filesystem::path folder, Store& store, TaskParallel& parallel);

  const std::filesystem::path& folder() const override { return folder_; }
  Parallel& parallel() override { return parallel_; }
  void count(std::string_view what, std::int64_t amount) override;
  void measure(std::string_view what, double value) override;
  void progress(std::int64_t done, std::int64_t total) override;
  std::optional<Archive> checkpoint() override;
  void save_checkpoint(const Archive& archive) override;

  /// Time and counts so far, with those of the attempts before a checkpoint.
  WorkDone work() const;
  std::int64_t done() const { return done_; }
  std::int64_t total() const { return total_; }
  /// Writes timing.csv into the folder, and what its columns are: wall_s, cpu_s, the counts, each of them per
  /// second, what was measured.
  void write_timing() const;

 private:
  std::filesystem::path folder_;
  Store& store_;
  std::string key_;
  TaskParallel& parallel_;
  std::chrono::steady_clock::time_point start_;
  WorkDone before_;
  mutable std::mutex mutex_;  ///< of the two maps: inner threads count
  std::map<std::string, std::int64_t, std::less<>> counts_;
  std::map<std::string, double, std::less<>> measures_;
  std::atomic<std::int64_t> done_{0};
  std::atomic<std::int64_t> total_{0};
};

}  // namespace coppice
