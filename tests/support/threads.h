#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "engine/vocabulary/parallel.h"

namespace coppice {

/// As many threads as asked for, whatever the machine has; takes work in no particular order.
class Threads : public Parallel {
 public:
  explicit Threads(std::size_t width) : width_(width) {}

  void for_each(std::size_t n, const std::function<void(std::size_t)>& work) override {
    std::atomic<std::size_t> next{0};
    std::mutex guard;
    std::size_t failed = n;
    std::exception_ptr error;
    const auto loop = [&] {
      for (std::size_t i = next++; i < n; i = next++) {
        try {
          work(n - 1 - i);  // backwards: an order that nobody expects
        } catch (...) {
          const std::lock_guard<std::mutex> lock(guard);
          if (n - 1 - i < failed) {
            failed = n - 1 - i;
            error = std::current_exception();
          }
        }
      }
    };
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < width_; ++t) threads.emplace_back(loop);
    for (std::thread& thread : threads) thread.join();
    if (error) std::rethrow_exception(error);
  }
  std::size_t width() const override { return width_; }

 private:
  std::size_t width_;
};

}  // namespace coppice
