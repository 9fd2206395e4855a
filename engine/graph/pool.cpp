#include "engine/graph/pool.h"

#include <algorithm>
#include <ctime>
#include <limits>

namespace coppice {
namespace {

double thread_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

/// A task while it runs: what its work sees as Parallel.
class Pool::Running final : public TaskParallel {
 public:
  Running(Pool& pool, const Task& task)
      : pool_(pool), stop_(task.stop), width_(task.threads == 0 ? pool.budget_ : task.threads) {
    width_ = std::min(width_, pool.budget_);
  }

  void for_each(std::size_t n, const std::function<void(std::size_t)>& work) override;
  std::size_t width() const override { return width_; }
  bool stop_requested() const override {
    return (pool_.stop_ != nullptr && pool_.stop_->load(std::memory_order_relaxed)) ||
           (stop_ != nullptr && stop_->load(std::memory_order_relaxed));
  }
  double cpu_s() const override {
    const std::lock_guard lock(pool_.mutex_);
    return thread_cpu_s() - start_cpu_s_ + helpers_cpu_s;
  }

  std::size_t threads = 1;   // in it now; guarded by the pool's mutex
  double helpers_cpu_s = 0;  // guarded by the pool's mutex

 private:
  Pool& pool_;
  const std::atomic<bool>* stop_;
  std::size_t width_;
  double start_cpu_s_ = thread_cpu_s();
};

/// One call of for_each. Lives on the stack of the thread that called it, its owner.
struct Pool::Loop {
  Running& task;
  const std::function<void(std::size_t)>& work;
  const std::size_t n;
  const std::size_t chunk;
  const Loop* const outer;           // the loop whose item called this one
  std::atomic<std::size_t> next{0};  // indices are given away in ascending order
  std::atomic<std::size_t> failed{std::numeric_limits<std::size_t>::max()};  // lowest index that threw

  // Guarded by the pool's mutex:
  std::exception_ptr error = nullptr;
  std::size_t helpers = 0;
  mutable std::condition_variable owner{};  // wakes it when the last helper left or an inner loop began

  bool exhausted() const { return next.load(std::memory_order_relaxed) >= n; }
  bool is_inside(const Loop& other) const {
    for (const Loop* loop = outer; loop != nullptr; loop = loop->outer) {
      if (loop == &other) return true;
    }
    return false;
  }

  /// The loop whose item this thread runs.
  static thread_local const Loop* current;
};

thread_local const Pool::Loop* Pool::Loop::current = nullptr;

void Pool::Running::for_each(std::size_t n, const std::function<void(std::size_t)>& work) {
  if (n < 2 || width_ < 2) {
    for (std::size_t i = 0; i < n; ++i) work(i);
    return;
  }
  // Chunks that are small against the whole even out items of different length; 256 hide the counter's cost.
  const std::size_t chunk = std::clamp<std::size_t>(n / (32 * width_), 1, 256);
  Loop loop{*this, work, n, chunk, Loop::current};
  pool_.share(loop);
  if (loop.error) std::rethrow_exception(loop.error);
}

/// Runs a loop on the calling thread and on idle ones.
void Pool::share(Loop& loop) {
  {
    const std::lock_guard lock(mutex_);
    loops_.push_back(&loop);
    for (std::size_t i = 0; i < std::min(loop.n - 1, idle_); ++i) work_.notify_one();
    for (const Loop* outer = loop.outer; outer != nullptr; outer = outer->outer) outer->owner.notify_one();
  }
  run_items(loop, false);
  Lock lock(mutex_);
  std::erase(loops_, &loop);
  // Helpers may still be busy with items that have loops inside: help these, and only these, since they are
  // part of what this thread waits for. So a wait never lasts longer than it must, and as every wait is for
  // loops further inside, there is no circle.
  while (loop.helpers > 0) {
    if (Loop* inner = find_inner_loop(loop)) {
      ++inner->helpers;
      lock.unlock();
      run_items(*inner, false);
      lock.lock();
      if (--inner->helpers == 0) inner->owner.notify_one();
    } else {
      loop.owner.wait(lock);
    }
  }
}

/// Takes chunks of indices until none are left, or, for a helper, until a task waits for a thread.
void Pool::run_items(Loop& loop, bool helper) {
  const Loop* const before = std::exchange(Loop::current, &loop);
  while (!helper || !tasks_wait_.load(std::memory_order_relaxed)) {
    const std::size_t first = loop.next.fetch_add(loop.chunk, std::memory_order_relaxed);
    const std::size_t end = std::min(loop.n, first + loop.chunk);
    // Every index below a failed one has been given away already: what lies above cannot be the lowest.
    for (std::size_t i = first; i < end && i < loop.failed.load(std::memory_order_relaxed); ++i) {
      try {
        loop.work(i);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (i < loop.failed) {
          loop.failed = i;
          loop.error = std::current_exception();
        }
      }
    }
    if (end >= loop.n) break;
  }
  Loop::current = before;
}

Pool::Loop* Pool::find_inner_loop(const Loop& outer) const {
  for (Loop* loop : loops_) {
    if (!loop->exhausted() && loop->is_inside(outer)) return loop;
  }
  return nullptr;
}

Pool::Loop* Pool::find_loop() const {
  for (Loop* loop : loops_) {
    if (!loop->exhausted() && loop->task.threads < loop->task.width()) return loop;
  }
  return nullptr;
}

void Pool::help(Loop& loop, Lock& lock) {
  ++occupied_;
  ++loop.helpers;
  ++loop.task.threads;
  lock.unlock();
  const double before = thread_cpu_s();
  run_items(loop, true);
  const double used = thread_cpu_s() - before;
  lock.lock();
  loop.task.helpers_cpu_s += used;
  --loop.task.threads;
  --occupied_;
  if (--loop.helpers == 0) loop.owner.notify_one();
}

bool Pool::can_start() const {
  return !queue_.empty() && occupied_ + queue_.begin()->second.cores <= budget_;
}

void Pool::start_next(Lock& lock) {
  const Task task = std::move(queue_.extract(queue_.begin()).mapped());
  tasks_wait_ = !queue_.empty();
  ++running_;
  occupied_ += task.cores;
  // Threads that made room for this task may have more to do.
  if (task.cores > 1) work_.notify_all();
  lock.unlock();
  std::exception_ptr error;
  try {
    Running running(*this, task);
    task.work(running);
  } catch (...) {
    error = std::current_exception();
  }
  lock.lock();
  if (error && !error_) error_ = error;
  occupied_ -= task.cores;
  --running_;
  if (task.cores > 1) work_.notify_all();
  if (queue_.empty() && running_ == 0) all_done_.notify_all();
}

void Pool::serve() {
  Lock lock(mutex_);
  while (!closing_) {
    if (can_start()) {
      start_next(lock);
      continue;
    }
    // While a task waits for several cores, nobody helps: it would never get them.
    Loop* const loop = queue_.empty() && occupied_ < budget_ ? find_loop() : nullptr;
    if (loop != nullptr) {
      help(*loop, lock);
    } else {
      ++idle_;
      work_.wait(lock);
      --idle_;
    }
  }
}

Pool::Pool(std::size_t threads, const std::atomic<bool>* stop)
    : budget_(threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency())), stop_(stop) {
  for (std::size_t i = 0; i < budget_; ++i) workers_.emplace_back([this] { serve(); });
}

Pool::~Pool() {
  drop_queued();
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    work_.notify_all();
  }
  for (std::thread& worker : workers_) worker.join();
}

void Pool::submit(Task task) {
  task.cores = std::clamp<std::size_t>(task.cores, 1, budget_);
  const std::lock_guard lock(mutex_);
  const std::pair key(task.order, submitted_++);
  queue_.emplace(key, std::move(task));
  tasks_wait_ = true;
  work_.notify_one();
}

std::size_t Pool::drop_queued() {
  const std::lock_guard lock(mutex_);
  const std::size_t count = queue_.size();
  queue_.clear();
  tasks_wait_ = false;
  if (running_ == 0) all_done_.notify_all();
  work_.notify_all();
  return count;
}

void Pool::wait() {
  Lock lock(mutex_);
  all_done_.wait(lock, [this] { return queue_.empty() && running_ == 0; });
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

}  // namespace coppice
