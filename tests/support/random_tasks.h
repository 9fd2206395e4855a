#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "engine/vocabulary/elementary.h"
#include "engine/vocabulary/optimizer.h"
#include "tests/support/search.h"

namespace coppice {

/// A box of 2 to 5 sides of different sizes, a guess or none, a budget.
inline SearchTask random_task(std::uint64_t number) {
  const Draws draws = Draws(2017, "optimizers", 0).scenario(number);
  SearchTask task;
  const std::uint64_t n = 2 + draws.below("n", 4);
  for (std::uint32_t i = 0; i < n; ++i) {
    const double low = draws.normal("low", 0, 10, i);
    const double width = elementary::exp(draws.uniform("width", -6, 6, i));
    task.box.push_back({"x" + std::to_string(i), "", low, low + width});
    if (number % 2 == 0) task.guess.push_back(draws.uniform("guess", low, low + width, i));
  }
  task.budget = 30 + static_cast<std::int64_t>(draws.below("budget", 100));
  task.noisy = number % 3 == 0;
  task.draws = draws.fork("search");
  return task;
}

/// The optimum may lie outside; some values are NaN or infinite.
inline double awkward_value(const SearchTask& task, std::span<const double> x, std::uint64_t number,
                            std::uint64_t scenario) {
  const Draws draws = Draws(7, "values", number).scenario(scenario);
  double value = task.noisy ? draws.normal("noise", 0, 0.1) : 0;
  for (std::uint32_t i = 0; i < x.size(); ++i) {
    const Axis& axis = task.box[i];
    const double z =
        (x[i] - axis.low) / (axis.high - axis.low) - draws.scenario(0).uniform("optimum", -0.3, 1.3, i);
    value -= z * z;
  }
  if (number % 5 == 1 && value < -1) return std::numeric_limits<double>::quiet_NaN();
  if (number % 5 == 2 && value < -1) return -std::numeric_limits<double>::infinity();
  if (number % 50 == 3 && value > -0.01) return std::numeric_limits<double>::infinity();
  return value;
}

/// Searches the box of a task to the end, asking for 7 at a time; what every optimizer promises on every
/// task.
inline void expect_sound_search(const Optimizer& optimizer, const SearchTask& task, std::uint64_t number) {
  const std::unique_ptr<Search> search = optimizer.start(task);
  const SearchRecord record =
      run_search(*search, task, 7, [&](std::span<const double> x, std::uint64_t scenario) {
        return awkward_value(task, x, number, scenario);
      });
  EXPECT_EQ(record.outside, 0u);
  EXPECT_GT(record.values.size(), 0u);
  EXPECT_LE(record.values.size(), static_cast<std::size_t>(task.budget));
  EXPECT_FALSE(search->stop_reason().empty());
  EXPECT_TRUE(is_inside(task.box, search->best()));
  EXPECT_EQ(search->measures().size(), optimizer.measures().size());
}

}  // namespace coppice
