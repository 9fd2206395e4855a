// What every optimizer promises, and a short recorded search of each.

#include <gtest/gtest.h>

#include "tests/support/golden.h"
#include "tests/support/search.h"

namespace coppice {
namespace {

class Optimizers : public testing::TestWithParam<std::string> {
 protected:
  const Sub<Optimizer> optimizer_ = make_for_golden<Optimizer>(GetParam());
};

/// A box of 2 to 5 sides of different sizes, a guess or none, a budget.
SearchTask random_task(std::uint64_t number) {
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
double awkward_value(const SearchTask& task, std::span<const double> x, std::uint64_t number,
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

TEST_P(Optimizers, StayInsideTheBoxAndTheBudgetOnRandomProblems) {
  const std::uint64_t problems = optimizer_.resolved.name == "bayesian" ? 10 : 300;
  for (std::uint64_t number = 0; number < problems; ++number) {
    SCOPED_TRACE(number);
    const SearchTask task = random_task(number);
    const std::unique_ptr<Search> search = optimizer_->start(task);
    const SearchRecord record =
        run_search(*search, task, 7, [&](std::span<const double> x, std::uint64_t scenario) {
          return awkward_value(task, x, number, scenario);
        });
    ASSERT_EQ(record.outside, 0u);
    ASSERT_LE(record.values.size(), static_cast<std::size_t>(task.budget));
    ASSERT_FALSE(search->stop_reason().empty());
    ASSERT_TRUE(is_inside(task.box, search->best()));
    ASSERT_EQ(search->measures().size(), optimizer_->measures().size());
  }
}

TEST_P(Optimizers, AskTheSameInPiecesOfAnySizeAndAfterResuming) {
  for (std::uint64_t number = 0; number < 12; ++number) {
    SCOPED_TRACE(number);
    SearchTask task = random_task(number);
    task.budget = std::min<std::int64_t>(task.budget, 80);
    const auto value = [&](std::span<const double> x, std::uint64_t scenario) {
      return awkward_value(task, x, number, scenario);
    };
    const std::unique_ptr<Search> whole = optimizer_->start(task);
    const SearchRecord expected = run_search(*whole, task, 1000000, value);
    SearchRecord pieces;
    std::unique_ptr<Search> search = optimizer_->start(task);
    while (run_search_step(*search, task, 3, value, pieces)) {
      Archive archive;
      search->save(archive);
      Archive read = Archive::from_bytes(archive.bytes());
      search = optimizer_->start(task);
      search->load(read);
    }
    EXPECT_EQ(pieces.points, expected.points);
    EXPECT_EQ(pieces.scenarios, expected.scenarios);
    EXPECT_EQ(search->stop_reason(), whole->stop_reason());
    EXPECT_EQ(search->best(), whole->best());
  }
}

TEST_P(Optimizers, SearchIsTheRecordedOne) {
  NamedValues values;
  for (const bool noisy : {false, true}) {
    SearchTask task;
    for (const char* name : {"a", "b", "c"}) task.box.push_back({name, "", -5, 5});
    task.guess = {3, -2, 1};
    task.budget = 60;
    task.noisy = noisy;
    task.draws = Draws(2017, "golden", 0);
    const std::unique_ptr<Search> search = optimizer_->start(task);
    SearchRecord record;
    const auto value = [&](std::span<const double> x, std::uint64_t scenario) {
      const double noise =
          noisy ? task.draws.fork("noise").scenario(scenario).normal("noise", 0, 0.1 * x[0]) : 0;
      return noise - (x[0] - 1) * (x[0] - 1) - 10 * x[1] * x[1] - (x[2] + 0.5) * (x[2] + 0.5) * x[1] * x[1];
    };
    const char* kind = noisy ? "noisy" : "noise-free";
    for (bool more = true; more;) {
      more = run_search_step(*search, task, 10, value, record);
      if (record.values.size() % 10 != 0) continue;
      const std::vector<double> best = search->best();
      for (std::size_t i = 0; i < best.size(); ++i) {
        values.add(fmt::format("{}, best after {}: {}", kind, record.values.size(), task.box[i].name),
                   best[i]);
      }
      values.add(fmt::format("{}, its value after {}", kind, record.values.size()), search->best_value());
    }
  }
  expect_golden("optimizer", GetParam(), values.table(), versions_of(optimizer_));
}

INSTANTIATE_TEST_SUITE_P(All, Optimizers, testing::ValuesIn(Catalogue::instance().names("optimizer")),
                         component_name);

}  // namespace
}  // namespace coppice
