#pragma once

#include <cstddef>
#include <functional>

namespace coppice {

/// Runs indexed work on as many threads as the run's core budget has free. Results must depend on the index
/// only.
class Parallel {
 public:
  virtual ~Parallel() = default;
  /// Calls work(i) for every i in [0, n), in any order, perhaps at once; returns when all are done. The first
  /// exception (lowest index among those thrown) is rethrown. May be called from inside work.
  virtual void for_each(std::size_t n, const std::function<void(std::size_t)>& work) = 0;
  /// At most how many calls run at once.
  virtual std::size_t width() const = 0;
  /// True when the run should end soon (Ctrl-C, time limit); long work checks it between units and returns
  /// early.
  virtual bool stop_requested() const { return false; }
};

/// Everything on the calling thread.
class Serial : public Parallel {
 public:
  void for_each(std::size_t n, const std::function<void(std::size_t)>& work) override {
    for (std::size_t i = 0; i < n; ++i) work(i);
  }
  std::size_t width() const override { return 1; }
};

}  // namespace coppice
