// What every optimizer promises, and a short recorded search of each.

#include <gtest/gtest.h>

#include "tests/support/golden.h"
#include "tests/support/random_tasks.h"
#include "tests/support/search.h"

namespace coppice {
namespace {

class Optimizers : public testing::TestWithParam<std::string> {
 protected:
  const Sub<Optimizer> optimizer_ = make_for_golden<Optimizer>(GetParam());
};

TEST_P(Optimizers, StayInsideTheBoxAndTheBudgetOnRandomProblems) {
  const std::uint64_t problems = optimizer_.resolved.name == "bayesian" ? 10 : 300;
  for (std::uint64_t number = 0; number < problems; ++number) {
    SCOPED_TRACE(number);
    const SearchTask task = random_task(number);
    expect_sound_search(*optimizer_, task, number);
    if (HasFailure()) return;
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

// A run that is stopped while candidates are evaluated loses their values, and evaluates them again.
TEST_P(Optimizers, AskAgainForWhatWasAskedWhenSavedBeforeItIsTold) {
  for (std::uint64_t number = 0; number < 6; ++number) {
    SCOPED_TRACE(number);
    SearchTask task = random_task(number);
    task.budget = std::min<std::int64_t>(task.budget, 80);
    const auto value = [&](std::span<const double> x, std::uint64_t scenario) {
      return awkward_value(task, x, number, scenario);
    };
    const std::unique_ptr<Search> whole = optimizer_->start(task);
    const SearchRecord expected = run_search(*whole, task, 4, value);
    std::unique_ptr<Search> search = optimizer_->start(task);
    SearchRecord record;
    for (bool more = true; more;) {
      const Candidates lost = search->ask(3);
      Archive archive;
      search->save(archive);
      Archive read = Archive::from_bytes(archive.bytes());
      search = optimizer_->start(task);
      search->load(read);
      const std::size_t before = record.points.size();
      more = run_search_step(*search, task, 3, value, record);
      ASSERT_EQ(record.points.size() - before, lost.points.rows());
      std::vector<double> x(task.box.size());
      for (std::size_t i = 0; i < lost.points.rows(); ++i) {
        lost.points.row(i, x);
        EXPECT_EQ(record.points[before + i], x);
        EXPECT_EQ(record.scenarios[before + i], lost.scenarios[i]);
      }
    }
    EXPECT_EQ(record.points, expected.points);
    EXPECT_EQ(record.scenarios, expected.scenarios);
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
