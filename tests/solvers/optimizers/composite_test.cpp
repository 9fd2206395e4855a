#include <gtest/gtest.h>

#include <map>
#include <set>

#include "solvers/optimizers/paired_choice.h"
#include "tests/support/make.h"
#include "tests/support/search.h"

namespace coppice {
namespace {

SearchTask cube(std::int64_t budget, bool noisy) {
  SearchTask task;
  task.box = {{"a", "", -5, 5}, {"b", "", -5, 5}, {"c", "", -5, 5}};
  task.guess = {3, -3, 2};
  task.budget = budget;
  task.noisy = noisy;
  task.draws = Draws(3, "test", 0);
  return task;
}

double sphere(std::span<const double> x) {
  double value = 0;
  for (const double coordinate : x) value -= coordinate * coordinate;
  return value;
}

// bobyqa and cobyla stop long before their parts are spent.
constexpr const char* kEarly =
    "<composite><optimizers><bobyqa/><simulated_annealing/><cobyla/></optimizers></composite>";

TEST(Composite, SpendsItsBudgetInFullWhateverItsMembersLeave) {
  for (const char* xml :
       {kEarly, "<composite><optimizers><bobyqa/></optimizers></composite>",
        "<composite><optimizers><random_search/><composite><optimizers><cross_entropy/><sbplx/></optimizers>"
        "</composite></optimizers></composite>"}) {
    const auto optimizer = make_from_xml<Optimizer>(xml);
    for (const bool noisy : {false, true}) {
      for (const std::int64_t budget : {100, 101, 997, 3000}) {
        const SearchTask task = cube(budget, noisy);
        const auto search = optimizer->start(task);
        const SearchRecord record =
            run_search(*search, task, 50, [](std::span<const double> x, std::uint64_t) { return sphere(x); });
        EXPECT_EQ(static_cast<std::int64_t>(record.values.size()), budget) << xml << noisy;
        EXPECT_EQ(search->stop_reason(), "budget");
        if (!noisy) {
          EXPECT_EQ(search->best_value(), *std::max_element(record.values.begin(), record.values.end()));
        }
      }
    }
  }
}

TEST(Composite, DividesItsBudgetOnce) {
  const auto optimizer = make_from_xml<Optimizer>(
      "<composite><optimizers><random_search/><simulated_annealing/><random_search/></optimizers></"
      "composite>");
  const SearchTask task = cube(302, false);
  const auto search = optimizer->start(task);
  std::map<double, int> evaluations;
  SearchRecord record;
  do ++evaluations[search->measures()[0]];
  while (run_search_step(
      *search, task, 1, [](auto x, auto) { return sphere(x); }, record));
  EXPECT_EQ(evaluations[1], 100);
  EXPECT_EQ(evaluations[2], 101);
  EXPECT_EQ(evaluations[3], 101);
}

TEST(Composite, ChoosesByPairedEvaluationsOnScenariosThatNoMemberMet) {
  const auto optimizer = make_from_xml<Optimizer>(kEarly);
  const SearchTask task = cube(1000, true);
  const auto search = optimizer->start(task);
  SearchRecord record;
  const auto value = [](std::span<const double> x, std::uint64_t scenario) {
    return sphere(x) + 100 * Draws(1, "noise", 0).scenario(scenario).normal("noise", 0, 1);
  };
  std::size_t members = 0;
  do {
    if (search->measures()[0] > 0) members = record.values.size();
  } while (run_search_step(*search, task, 1, value, record));
  ++members;  // the last step of a member
  const std::size_t final = record.values.size() - members;
  EXPECT_GE(final, 90u);
  EXPECT_LE(final, 101u);
  std::set<std::uint64_t> met(record.scenarios.begin(),
                              record.scenarios.begin() + static_cast<std::ptrdiff_t>(members));
  std::map<std::uint64_t, std::set<std::vector<double>>> compared;
  for (std::size_t i = members; i < record.values.size(); ++i) {
    EXPECT_FALSE(met.contains(record.scenarios[i]));
    compared[record.scenarios[i]].insert(record.points[i]);
  }
  EXPECT_GE(compared.begin()->second.size(), 3u);
  EXPECT_GT(sphere(search->best()), -0.1);
}

TEST(PairedChoice, SpendsAllAndIsNotMisledByWhatAllShare) {
  Matrix points(5, 1);
  for (std::size_t i = 0; i < 5; ++i) points(i, 0) = static_cast<double>(i);
  for (const std::int64_t budget : {1, 4, 5, 23, 60}) {
    PairedChoice choice(points, budget, 7);
    std::int64_t spent = 0;
    for (;;) {
      const Candidates round = choice.next_round();
      if (round.points.rows() == 0) break;
      std::vector<double> values;
      for (std::size_t i = 0; i < round.points.rows(); ++i) {
        EXPECT_GE(round.scenarios[i], 7u);
        const double x = round.points(i, 0);
        values.push_back(-(x - 3) * (x - 3) + 1000 * static_cast<double>(round.scenarios[i] % 5));
      }
      spent += static_cast<std::int64_t>(values.size());
      choice.learn(values);
    }
    EXPECT_EQ(spent, budget);
    if (budget >= 5) {
      EXPECT_EQ(choice.best(), 3u);
    }
  }
}

}  // namespace
}  // namespace coppice
