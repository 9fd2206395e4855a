#include "engine/graph/pool.h"

#include <gtest/gtest.h>

#include <chrono>
#include <numeric>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>

namespace coppice {
namespace {

using namespace std::chrono_literals;

/// Runs one task in the pool and waits for it.
void run_one(Pool& pool, std::function<void(TaskParallel&)> work, std::size_t threads = 0) {
  pool.submit({.threads = threads, .work = std::move(work)});
  pool.wait();
}

/// How many threads are inside it, and the most there ever were.
class Occupancy {
 public:
  class Visit {
   public:
    explicit Visit(Occupancy& place) : place_(place) {
      const int now = ++place_.now_;
      int most = place_.most_;
      while (now > most && !place_.most_.compare_exchange_weak(most, now)) {
      }
    }
    ~Visit() { --place_.now_; }
    Visit(const Visit&) = delete;
    Visit& operator=(const Visit&) = delete;

   private:
    Occupancy& place_;
  };
  int most() const { return most_; }

 private:
  std::atomic<int> now_{0};
  std::atomic<int> most_{0};
};

/// Waits until the condition holds; false after ten seconds.
template <class Condition>
bool eventually(Condition condition) {
  for (int i = 0; i < 10'000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return false;
}

TEST(Pool, RunsEveryIndexOnce) {
  for (const std::size_t threads : {1, 2, 5}) {
    Pool pool(threads);
    for (const std::size_t n : {0, 1, 2, 7, 64, 1000}) {
      std::vector<std::atomic<int>> calls(n);
      run_one(pool, [&](Parallel& parallel) { parallel.for_each(n, [&](std::size_t i) { ++calls[i]; }); });
      for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(calls[i], 1) << threads << " threads, index " << i;
    }
  }
}

TEST(Pool, UsesAllCoresWhenNoneAreNamed) {
  EXPECT_EQ(Pool(0).threads(), std::max(1u, std::thread::hardware_concurrency()));
}

TEST(Pool, StartsTasksByOrderThenBySubmission) {
  Pool pool(1);
  std::atomic<bool> go{false};
  std::string started;
  pool.submit({.order = -1, .work = [&](Parallel&) { go.wait(false); }});
  for (const auto& [name, order] :
       std::vector<std::pair<char, double>>{{'c', 2}, {'a', 1}, {'d', 2}, {'b', 1}})
    pool.submit({.order = order, .work = [&started, letter = name](Parallel&) { started += letter; }});
  go = true;
  go.notify_all();
  pool.wait();
  EXPECT_EQ(started, "abcd");
}

TEST(Pool, TasksSubmitTasks) {
  Pool pool(2);
  std::atomic<int> leaves{0};
  std::function<void(int)> grow = [&](int depth) {
    pool.submit({.work = [&grow, &leaves, depth](Parallel&) {
      if (depth == 0) ++leaves;
      for (int i = 0; depth > 0 && i < 2; ++i) grow(depth - 1);
    }});
  };
  grow(10);
  pool.wait();
  EXPECT_EQ(leaves, 1024);
}

TEST(Pool, SharesALoopWithIdleThreads) {
  Pool pool(3);
  std::atomic<int> inside{0};
  bool met = false;
  run_one(pool, [&](Parallel& parallel) {
    parallel.for_each(3, [&](std::size_t i) {
      ++inside;
      const bool all = eventually([&] { return inside == 3; });
      if (i == 0) met = all;
    });
  });
  EXPECT_TRUE(met) << "three items never ran at once";
}

TEST(Pool, NeverExceedsTheBudget) {
  constexpr int kThreads = 3;
  Pool pool(kThreads);
  Occupancy computing;
  for (int task = 0; task < 8; ++task) {
    pool.submit({.work = [&](Parallel& parallel) {
      parallel.for_each(6, [&](std::size_t) {
        parallel.for_each(5, [&](std::size_t) {
          const Occupancy::Visit visit(computing);
          std::this_thread::sleep_for(200us);
        });
      });
    }});
  }
  pool.wait();
  EXPECT_LE(computing.most(), kThreads);
}

TEST(Pool, KeepsTheLimitOfATask) {
  Pool pool(4);
  Occupancy computing;
  run_one(
      pool,
      [&](Parallel& parallel) {
        EXPECT_EQ(parallel.width(), 2u);
        parallel.for_each(40, [&](std::size_t) {
          parallel.for_each(3, [&](std::size_t) {
            const Occupancy::Visit visit(computing);
            std::this_thread::sleep_for(100us);
          });
        });
      },
      2);
  EXPECT_LE(computing.most(), 2);
}

TEST(Pool, WidthIsNeverMoreThanTheBudget) {
  Pool pool(2);
  std::size_t limited = 0, free = 0;
  run_one(
      pool, [&](Parallel& parallel) { limited = parallel.width(); }, 100);
  run_one(pool, [&](Parallel& parallel) { free = parallel.width(); });
  EXPECT_EQ(limited, 2u);
  EXPECT_EQ(free, 2u);
}

TEST(Pool, ATaskOfSeveralCoresHasThemToItself) {
  Pool pool(3);
  std::atomic<bool> alone{false}, trespassed{false};
  std::atomic<int> done{0};
  const auto small = [&](Parallel& parallel) {
    parallel.for_each(20, [&](std::size_t) {
      if (alone) trespassed = true;
      std::this_thread::sleep_for(100us);
    });
    ++done;
  };
  for (int i = 0; i < 3; ++i) pool.submit({.order = 0, .work = small});
  pool.submit({.order = 1, .cores = 7, .work = [&](Parallel&) {  // of which it gets three
                 alone = true;
                 std::this_thread::sleep_for(10ms);
                 alone = false;
                 ++done;
               }});
  for (int i = 0; i < 3; ++i) pool.submit({.order = 2, .work = small});
  pool.wait();
  EXPECT_EQ(done, 7);
  EXPECT_FALSE(trespassed);
}

TEST(Pool, AnIdleThreadPrefersATaskToALoop) {
  Pool pool(2);
  std::atomic<int> helped{0};
  std::atomic<bool> other{false};
  bool seen = false;
  run_one(pool, [&](Parallel& parallel) {
    const std::thread::id owner = std::this_thread::get_id();
    parallel.for_each(100'000, [&](std::size_t) {
      if (other) return;
      if (std::this_thread::get_id() != owner) {
        ++helped;
        std::this_thread::sleep_for(100us);  // all of them would take ten seconds
        return;
      }
      ASSERT_TRUE(eventually([&] { return helped > 0; }));
      pool.submit({.work = [&](Parallel&) { other = true; }});
      seen = eventually([&] { return other.load(); });
    });
  });
  EXPECT_TRUE(seen) << "the helper did not leave the loop";
}

TEST(Pool, NestedLoopsOfAnyDepthEnd) {
  for (const std::size_t threads : {1, 2, 4}) {
    Pool pool(threads);
    std::atomic<int> leaves{0};
    std::function<void(Parallel&, int)> grow = [&](Parallel& parallel, int depth) {
      if (depth == 0) {
        ++leaves;
      } else {
        parallel.for_each(3, [&](std::size_t) { grow(parallel, depth - 1); });
      }
    };
    for (int task = 0; task < 3; ++task)
      pool.submit({.work = [&](Parallel& parallel) { grow(parallel, 7); }});
    pool.wait();
    EXPECT_EQ(leaves, 3 * 2187) << threads << " threads";
  }
}

TEST(Pool, AWaitingThreadHelpsInsideWhatItWaitsFor) {
  Pool pool(2);
  std::atomic<int> inside{0};
  bool met = false;
  run_one(pool, [&](Parallel& parallel) {
    // One thread ends its item at once; the loop inside the other item then has both.
    std::atomic<bool> first_done{false};
    parallel.for_each(2, [&](std::size_t outer) {
      if (outer == 0) {
        first_done = true;
        return;
      }
      eventually([&] { return first_done.load(); });
      parallel.for_each(2, [&](std::size_t i) {
        ++inside;
        const bool both = eventually([&] { return inside == 2; });
        if (i == 0) met = both;
      });
    });
  });
  EXPECT_TRUE(met);
}

TEST(Pool, RethrowsTheExceptionOfTheLowestIndex) {
  for (const std::size_t threads : {1, 2, 4}) {
    Pool pool(threads);
    for (int repetition = 0; repetition < 50; ++repetition) {
      std::string caught;
      std::atomic<int> inside{0};
      bool all_out = false;
      run_one(pool, [&](Parallel& parallel) {
        try {
          parallel.for_each(100, [&](std::size_t i) {
            ++inside;
            if (i == 17) std::this_thread::sleep_for(50us);  // later than its successors
            --inside;
            if (i >= 17) throw std::runtime_error("item " + std::to_string(i));
          });
        } catch (const std::runtime_error& error) {
          caught = error.what();
          all_out = inside == 0;
        }
      });
      EXPECT_EQ(caught, "item 17");
      EXPECT_TRUE(all_out) << "rethrown while items still ran";
    }
  }
}

TEST(Pool, AnExceptionPassesThroughNestedLoops) {
  Pool pool(2);
  pool.submit({.work = [](Parallel& parallel) {
    parallel.for_each(4, [&](std::size_t outer) {
      parallel.for_each(4, [&](std::size_t inner) {
        if (outer * 4 + inner >= 6) throw std::invalid_argument(std::to_string(outer * 4 + inner));
      });
    });
  }});
  try {
    pool.wait();
    FAIL() << "nothing was thrown";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "6");
  }
  std::atomic<bool> usable{false};
  run_one(pool, [&](Parallel&) { usable = true; });
  EXPECT_TRUE(usable);
}

TEST(Pool, ManySmallTasksAndLoopsEnd) {
  Pool pool(4);
  std::atomic<std::size_t> sum{0};
  for (std::size_t task = 0; task < 5000; ++task) {
    pool.submit({.order = static_cast<double>(task % 7), .work = [&, task](Parallel& parallel) {
                   parallel.for_each(task % 5, [&](std::size_t i) { sum += i + 1; });
                 }});
  }
  pool.wait();
  EXPECT_EQ(sum, 1000u * (0 + 1 + 3 + 6 + 10));
}

TEST(Pool, StopsAllOrOne) {
  std::atomic<bool> all{false}, one{false};
  Pool pool(2, &all);
  std::atomic<int> ended{0};
  const auto endless = [&](Parallel& parallel) {
    eventually([&] { return parallel.stop_requested(); });
    ended += parallel.stop_requested() ? 1 : 100;
  };
  pool.submit({.stop = &one, .work = endless});
  pool.submit({.work = endless});
  one = true;
  EXPECT_TRUE(eventually([&] { return ended == 1; }));
  std::this_thread::sleep_for(5ms);
  EXPECT_EQ(ended, 1) << "the flag of one task stopped another";
  all = true;
  pool.wait();
  EXPECT_EQ(ended, 2);
}

TEST(Pool, DropsWhatHasNotStarted) {
  std::atomic<int> ran{0};
  Pool pool(1);
  std::atomic<bool> started{false}, go{false};
  pool.submit({.work = [&](Parallel&) {
    started = true;
    go.wait(false);
    ++ran;
  }});
  ASSERT_TRUE(eventually([&] { return started.load(); }));
  for (int i = 0; i < 10; ++i) pool.submit({.work = [&](Parallel&) { ++ran; }});
  EXPECT_EQ(pool.drop_queued(), 10u);
  go = true;
  go.notify_all();
  pool.wait();
  EXPECT_EQ(ran, 1);
}

TEST(Pool, CountsTheCpuTimeOfAllThreadsOfATask) {
  Pool pool(2);
  double own = 0, shared = 0;
  const auto burn = [](double seconds) {
    const std::clock_t end = std::clock() + static_cast<std::clock_t>(seconds * CLOCKS_PER_SEC);
    while (std::clock() < end) {
    }
  };
  run_one(pool, [&](TaskParallel& parallel) {
    burn(0.02);
    own = parallel.cpu_s();
    // The process's clock runs twice as fast while both threads burn.
    parallel.for_each(2, [&](std::size_t) { burn(0.08); });
    shared = parallel.cpu_s();
  });
  EXPECT_GE(own, 0.01);
  EXPECT_LE(own, 0.04);
  EXPECT_GE(shared, own + 0.06);
  EXPECT_LE(shared, own + 0.2);
}

}  // namespace
}  // namespace coppice
