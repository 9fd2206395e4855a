// The bars of docs/optimizers.md about Bayesian optimization, measured: bayesian_table [seeds] [element]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "engine/vocabulary/objective.h"
#include "engine/vocabulary/optimizer.h"
#include "tests/support/make.h"
#include "tests/support/search.h"

namespace coppice::benchmark {
namespace {

void measure(const std::string& optimizer, const std::string& name, std::uint64_t seeds) {
  const auto function = make_from_xml<Objective>("<" + name + "/>")->draw(Draws(1, "", 0));
  const auto method = make_from_xml<Optimizer>(optimizer);
  std::vector<double> gaps;
  const std::clock_t begin = std::clock();
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    SearchTask task;
    task.box = function->box();
    task.budget = 200;
    task.noisy = false;
    task.draws = Draws(seed, "bayesian", 0);
    const std::unique_ptr<Search> search = method->start(task);
    run_search(*search, task, task.budget, [&](std::span<const double> x, std::uint64_t scenario) {
      return function->evaluate(x, task.draws.scenario(scenario));
    });
    gaps.push_back(*function->optimum() - *function->true_value(search->best()));
  }
  std::sort(gaps.begin(), gaps.end());
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  fmt::print("{:10} {:9.1e} {:9.1e} {:9.1e} {:6.2f}\n", name, gaps[seeds / 2], gaps[seeds * 3 / 4],
             gaps.back(), seconds / static_cast<double>(seeds));
  std::fflush(stdout);
}

}  // namespace
}  // namespace coppice::benchmark

int main(int argc, char** argv) {
  const std::uint64_t seeds = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 21;
  fmt::print(
      "# gap to the optimum after 10 + 190 evaluations, {} seeds: median, upper quartile, worst; CPU s a "
      "run\n",
      seeds);
  for (const char* name : {"branin", "hartmann3", "hartmann6"}) {
    coppice::benchmark::measure(argc > 2 ? argv[2] : "<bayesian/>", name, std::max<std::uint64_t>(seeds, 1));
  }
}
