// How near optimizers come to the optimum of a sphere with 1000 n evaluations: median over seeds and its
// one-sided 95 % bound, beside what is asked of them. Begins uniformly in [-4, 4]^n, optimum uniform in [-2,
// 2]^n, box [-5, 5]^n.
//   build/optimizer_bars [seeds, default 51] [<element/> ...]
// Exit status 1 when a bar is missed. With elements, those instead, without bars.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "tests/support/make.h"
#include "tests/support/search.h"

namespace coppice {
namespace {

struct Outcome {
  double error = 0;  ///< of the returned point
  double spent = 0;  ///< part of the budget
};

Outcome search_sphere(const Optimizer& optimizer, std::size_t n, std::uint64_t seed, bool noisy) {
  const Draws draws(seed, "optimizer_bars", 0);
  SearchTask task;
  std::vector<double> optimum;
  for (std::uint32_t i = 0; i < n; ++i) {
    task.box.push_back({fmt::format("x{}", i), "", -5, 5});
    task.guess.push_back(draws.uniform("guess", -4, 4, i));
    optimum.push_back(draws.uniform("optimum", -2, 2, i));
  }
  task.budget = static_cast<std::int64_t>(1000 * n);
  task.noisy = noisy;
  task.draws = draws.fork("search");
  const auto error = [&](std::span<const double> x) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += (x[i] - optimum[i]) * (x[i] - optimum[i]);
    return sum;
  };
  std::uint64_t evaluations = 0;  // noise of its own for each: nothing in common
  const std::unique_ptr<Search> search = optimizer.start(task);
  const SearchRecord record =
      run_search(*search, task, task.budget, [&](std::span<const double> x, std::uint64_t) {
        return -error(x) + (noisy ? draws.fork("noise").scenario(evaluations++).normal("noise", 0, 1) : 0);
      });
  return {error(search->best()),
          static_cast<double>(record.values.size()) / static_cast<double>(task.budget)};
}

/// The order statistic that is no less than the median with 95 % confidence: P(Bin(m, 1/2) <= k) >= 0.95.
std::size_t upper_rank(std::size_t m) {
  double probability = std::pow(0.5, static_cast<double>(m)), sum = probability;
  std::size_t k = 0;
  while (sum < 0.95 && k + 1 < m) {
    probability *= static_cast<double>(m - k) / static_cast<double>(k + 1);
    sum += probability;
    ++k;
  }
  return k;
}

bool report(const std::string& xml, std::size_t n, std::size_t seeds, bool noisy, double bar) {
  const Sub<Optimizer> optimizer = make_from_xml<Optimizer>(xml);
  std::vector<double> errors;
  double least = 1, most = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Outcome outcome = search_sphere(*optimizer, n, seed, noisy);
    errors.push_back(outcome.error);
    least = std::min(least, outcome.spent);
    most = std::max(most, outcome.spent);
  }
  std::sort(errors.begin(), errors.end());
  const double bound = errors[std::min(seeds - 1, upper_rank(seeds))];
  const bool holds = bound <= bar;
  fmt::print("{:<22} {:<6} {:>3} {:>10.2e} {:>10.2e} {:>8} {:>7.3f} to {:.3f}  {}\n", optimizer.resolved.name,
             noisy ? "noisy" : "", n, errors[seeds / 2], bound, bar < 1e300 ? fmt::format("{:.0e}", bar) : "",
             least, most, bar < 1e300 ? (holds ? "holds" : "MISSED") : "");
  return holds;
}

int run(int argc, char** argv) {
  const std::size_t seeds = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 51;
  if (seeds < 5) {
    fmt::print(stderr, "usage: optimizer_bars [seeds, 5 at least] [<element/> ...]\n");
    return 2;
  }
  constexpr std::size_t kSizes[] = {5, 10, 20};
  constexpr double kCrossEntropy[] = {5e-6, 5e-4, 0.03}, kAnnealing[] = {0.003, 0.011, 0.03}, kNone = 1e301;
  fmt::print("{:<22} {:<6} {:>3} {:>10} {:>10} {:>8} {}\n", "optimizer", "", "n", "median", "95 %", "bar",
             "  spent");
  bool holds = true;
  for (int i = 2; i < argc; ++i) {
    for (const std::size_t n : kSizes) {
      for (const bool noisy : {false, true}) report(argv[i], n, seeds, noisy, kNone);
    }
  }
  if (argc > 2) return 0;
  for (std::size_t i = 0; i < 3; ++i) {
    holds = report("<cross_entropy/>", kSizes[i], seeds, false, kCrossEntropy[i]) && holds;
    holds = report("<simulated_annealing/>", kSizes[i], seeds, false, kAnnealing[i]) && holds;
  }
  for (const char* xml :
       {"<cross_entropy/>", "<simulated_annealing/>", "<random_search/>",
        "<composite><optimizers><cross_entropy/><simulated_annealing/><bobyqa/></optimizers>"
        "</composite>"}) {
    for (const std::size_t n : kSizes) report(xml, n, seeds, true, kNone);
  }
  return holds ? 0 : 1;
}

}  // namespace
}  // namespace coppice

int main(int argc, char** argv) {
  return coppice::run(argc, argv);
}
