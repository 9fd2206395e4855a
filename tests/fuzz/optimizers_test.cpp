// What every optimizer promises, on 10^4 random problems of each.

#include <gtest/gtest.h>

#include "tests/support/golden.h"
#include "tests/support/random_tasks.h"

namespace coppice {
namespace {

class OptimizersOnRandomProblems : public testing::TestWithParam<std::string> {};

// Boxes of all sizes, guesses or none, noise or none, values that are NaN or infinite; budgets of 30 to 59.
// Bayesian optimization, which fits a process after each evaluation, gets 100 problems.
TEST_P(OptimizersOnRandomProblems, StayInsideTheBoxAndTheBudgetAndSayWhyTheyStop) {
  const Sub<Optimizer> optimizer = make_for_golden<Optimizer>(GetParam());
  const std::uint64_t problems = optimizer.resolved.name == "bayesian" ? 100 : 10000;
  for (std::uint64_t number = 0; number < problems; ++number) {
    SCOPED_TRACE(number);
    SearchTask task = random_task(number);
    task.budget = 30 + task.budget % 30;
    expect_sound_search(*optimizer, task, number);
    if (HasFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(All, OptimizersOnRandomProblems,
                         testing::ValuesIn(Catalogue::instance().names("optimizer")), component_name);

}  // namespace
}  // namespace coppice
