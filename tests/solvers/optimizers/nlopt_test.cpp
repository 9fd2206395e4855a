#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include "tests/support/make.h"
#include "tests/support/search.h"

namespace coppice {
namespace {

SearchTask box(std::size_t n, std::int64_t budget, std::uint64_t seed = 3) {
  SearchTask task;
  for (std::size_t i = 0; i < n; ++i) task.box.push_back({"x" + std::to_string(i), "", -5, 5});
  task.guess.assign(n, 3.5);
  task.budget = budget;
  task.noisy = false;
  task.draws = Draws(seed, "test", 0);
  return task;
}

double bowl(std::span<const double> x) {
  double value = 0;
  for (std::size_t i = 0; i < x.size(); ++i) value -= static_cast<double>(i + 1) * (x[i] - 1) * (x[i] - 1);
  return value;
}
double value_of_bowl(std::span<const double> x, std::uint64_t) {
  return bowl(x);
}

TEST(Nlopt, LocalMethodsFindTheOptimumOfABowlAndSayWhyTheyStop) {
  for (const char* xml : {"<bobyqa/>", "<cobyla/>", "<sbplx/>", "<nelder_mead/>"}) {
    const SearchTask task = box(3, 3000);
    const auto search = make_from_xml<Optimizer>(xml)->start(task);
    const SearchRecord record = run_search(*search, task, 10, value_of_bowl);
    EXPECT_GT(search->best_value(), -1e-8) << xml;
    EXPECT_EQ(search->stop_reason(), "point_tolerance") << xml;
    EXPECT_LT(record.values.size(), 2000u) << xml;
    EXPECT_EQ(record.points[0], task.guess) << xml;
  }
}

TEST(Nlopt, BobyqaNeedsFewEvaluationsOnAQuadratic) {
  const SearchTask task = box(10, 1000);
  const auto search = make_from_xml<Optimizer>("<bobyqa/>")->start(task);
  const SearchRecord record = run_search(*search, task, 1, value_of_bowl);
  const auto good =
      std::find_if(record.values.begin(), record.values.end(), [](double v) { return v > -1e-8; });
  EXPECT_LT(good - record.values.begin(), 120);
}

constexpr const char* kRandom[] = {"<crs2/>", "<isres population='30'/>", "<esch/>"};

TEST(Nlopt, SearchesAtOnceDoNotDisturbEachOther) {
  for (const char* xml : kRandom) {
    const SearchTask task = box(3, 300), other = box(3, 300, 4);
    const auto optimizer = make_from_xml<Optimizer>(xml);
    const SearchRecord alone = run_search(*optimizer->start(task), task, 1, value_of_bowl);
    // Turn by turn in one thread.
    const auto one = optimizer->start(task), two = optimizer->start(other);
    SearchRecord first, second;
    for (bool more = true; more;) {
      more = run_search_step(*one, task, 1, value_of_bowl, first);
      run_search_step(*two, other, 1, value_of_bowl, second);
    }
    EXPECT_EQ(first.points, alone.points) << xml;
    EXPECT_NE(second.points, alone.points) << xml;
    // In several threads.
    std::vector<SearchRecord> records(3);
    std::vector<std::thread> threads;
    for (SearchRecord& record : records) {
      threads.emplace_back([&] { record = run_search(*optimizer->start(task), task, 1, value_of_bowl); });
    }
    for (std::thread& thread : threads) thread.join();
    for (const SearchRecord& record : records) EXPECT_EQ(record.points, alone.points) << xml;
  }
}

TEST(Nlopt, ASearchCanBeAbandonedAtAnyTime) {
  for (const char* xml : {"<bobyqa/>", "<cobyla/>", "<sbplx/>", "<nelder_mead/>", "<crs2/>", "<isres/>",
                          "<esch/>", "<direct_l/>", "<mlsl/>"}) {
    const auto optimizer = make_from_xml<Optimizer>(xml);
    for (const int steps : {0, 1, 17}) {
      const SearchTask task = box(2, 1000000);
      const auto search = optimizer->start(task);
      SearchRecord record;
      for (int i = 0; i < steps; ++i) run_search_step(*search, task, 1, value_of_bowl, record);
      search->ask(1);
    }
  }
}

TEST(Nlopt, LocalMethodsNeedNoBoxGlobalOnesDo) {
  SearchTask task = box(2, 500);
  for (Axis& axis : task.box) axis = {axis.name, "", -std::numeric_limits<double>::infinity(), 2};
  task.guess = {-30, 1};
  const auto search = make_from_xml<Optimizer>("<bobyqa/>")->start(task);
  run_search(*search, task, 1, value_of_bowl);
  EXPECT_GT(search->best_value(), -1e-6);
  EXPECT_THROW(make_from_xml<Optimizer>("<crs2/>")->start(task), std::invalid_argument);
  EXPECT_THROW(make_from_xml<Optimizer>("<bobyqa/>")->start(box(1, 100)), std::invalid_argument);
}

TEST(Nlopt, AStateOfAnotherVersionOfTheLibraryIsRefused) {
  const SearchTask task = box(2, 100);
  const auto optimizer = make_from_xml<Optimizer>("<crs2/>");
  const auto search = optimizer->start(task);
  SearchRecord record;
  run_search_step(*search, task, 1, value_of_bowl, record);
  Archive archive;
  search->save(archive);
  archive.put("method/library", std::string("1.0.0"));
  EXPECT_THROW(optimizer->start(task)->load(archive), std::runtime_error);
}

}  // namespace
}  // namespace coppice
