#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "engine/vocabulary/parallel.h"

namespace coppice {

/// What a running task sees of the pool.
class TaskParallel : public Parallel {
 public:
  /// CPU time that the task has used so far, in all threads, s. To be asked by the task's own thread, not
  /// from inside for_each.
  virtual double cpu_s() const = 0;
};

/// One piece of work for a Pool.
struct Task {
  double order = 0;         ///< smaller ones start first, equal ones as they were submitted
  std::size_t threads = 0;  ///< of the pool, at most so many at once, its own included; 0: any number
  std::size_t cores = 1;    ///< that its own thread occupies (more than one: it waits for another process)
  const std::atomic<bool>* stop = nullptr;  ///< asks this task alone to end; must outlive it
  std::function<void(TaskParallel&)> work;
};

/// The one core budget of a run: so many threads, shared by tasks and by the parallel loops inside them.
/// An idle thread starts the next task, else helps in the loops of running tasks. Never do more threads than
/// the budget compute; nothing is polled.
class Pool {
 public:
  /// `threads`: the budget, 0: one for each core of the machine. `stop` asks every task to end; it must
  /// outlive the pool.
  explicit Pool(std::size_t threads, const std::atomic<bool>* stop = nullptr);
  /// Drops the tasks that have not started and waits for the others.
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  /// May be called from any thread, also from inside a task.
  void submit(Task task);
  /// Drops the tasks that have not started; how many these were.
  std::size_t drop_queued();
  /// Waits until every submitted task is done. An exception that left a task is rethrown, the earliest.
  void wait();
  std::size_t threads() const { return budget_; }

 private:
  struct Loop;
  class Running;
  using Lock = std::unique_lock<std::mutex>;

  void serve();
  bool can_start() const;
  void start_next(Lock& lock);
  Loop* find_loop() const;
  Loop* find_inner_loop(const Loop& outer) const;
  void help(Loop& loop, Lock& lock);
  void run_items(Loop& loop, bool helper);
  void share(Loop& loop);

  const std::size_t budget_;
  const std::atomic<bool>* const stop_;
  std::mutex mutex_;  // guards everything below
  std::condition_variable work_;
  std::condition_variable all_done_;
  std::map<std::pair<double, std::uint64_t>, Task> queue_;  // by order, then by submission
  std::uint64_t submitted_ = 0;
  std::size_t occupied_ = 0;  // cores
  std::size_t idle_ = 0;      // threads waiting for work
  std::size_t running_ = 0;   // tasks
  std::vector<Loop*> loops_;  // that still have indices to give away
  std::exception_ptr error_;
  bool closing_ = false;
  std::atomic<bool> tasks_wait_{false};  // helpers leave their loop for a task
  std::vector<std::thread> workers_;
};

}  // namespace coppice
