// The bars of docs/optimizers.md about CMA-ES, measured: cma_es_table [part] [seeds] [dimensions...]
// Parts: exact, bounded, switch, rastrigin, noisy, overhead; all without arguments.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "solvers/optimizers/cma_es.h"
#include "tests/benchmarks/optimizers/test_functions.h"

namespace coppice::benchmark {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Outcome {
  double evaluations = kInfinity;  ///< up to 1e-8
  double spent = 0;
  double returned = 0;  ///< true value of the point returned
  double seconds = 0;   ///< processor time of the optimizer alone
  double restarts = 0;
};

double now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

Outcome run(CmaEs method, TestFunction function, std::size_t n, std::uint64_t seed, double budget,
            bool bounded, bool noisy, double target) {
  const double side = bounded ? 5 : kInfinity;
  method.sigma = bounded ? 0.2 : 2;
  SearchTask task;
  task.box.assign(n, {"x", "", -side, side});
  task.guess = function.guess();
  task.budget = static_cast<std::int64_t>(budget);
  task.noisy = noisy;
  task.draws = Draws(seed, "cma_es", 0);
  Outcome outcome;
  const auto search = method.start(task);
  std::vector<double> values;
  while (true) {
    const double before = now();
    const Candidates candidates = search->ask(std::numeric_limits<std::int64_t>::max());
    outcome.seconds += now() - before;
    const std::size_t rows = candidates.points.rows();
    if (rows == 0) break;
    values.resize(rows);
    for (std::size_t i = 0; i < rows; ++i) {
      const double* x = candidates.points.values().data() + i;
      values[i] = -function.noisy(x, rows);
      ++outcome.spent;
      if (-values[i] <= target) {
        outcome.evaluations = outcome.spent;
        break;
      }
    }
    if (std::isfinite(outcome.evaluations)) break;
    const double then = now();
    search->tell(values);
    outcome.seconds += now() - then;
  }
  outcome.returned = function.exact(search->best().data(), 1);
  outcome.restarts = search->measures()[2];
  return outcome;
}

/// Upper end of a one-sided 95 % confidence interval of the median: an order statistic.
double upper_bound(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto m = static_cast<double>(values.size());
  double below = 0, term = std::pow(0.5, m);
  for (std::size_t k = 0; k < values.size(); ++k) {  // P(Binomial(m, 1/2) <= k) >= 0.95
    below += term;
    if (below >= 0.95) return values[std::min(k, values.size() - 1)];
    term *= (m - static_cast<double>(k)) / (static_cast<double>(k) + 1);
  }
  return values.back();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t h = values.size() / 2;
  return values.size() % 2 == 1 ? values[h] : (values[h - 1] + values[h]) / 2;
}

struct Options {
  std::string part = "all";
  std::uint64_t seeds = 51;
  std::vector<std::size_t> dimensions;
  bool wants(const std::string& name) const { return part == "all" || part == name; }
  std::vector<std::size_t> sizes(std::vector<std::size_t> all) const {
    return dimensions.empty() ? all : dimensions;
  }
};

const std::map<std::string, std::map<std::size_t, double>> kLibcmaes = {
    {"sphere", {{5, 698}, {10, 1476}, {20, 2780}, {40, 5286}}},
    {"ellipsoid", {{5, 1690}, {10, 4361}, {20, 12846}, {40, 43972}}},
    {"ellipsoid_rot", {{5, 1690}, {10, 4361}, {20, 12846}, {40, 43972}}},
    {"rosenbrock", {{5, 1788}, {10, 5443}, {20, 16866}, {40, 58600}}}};

void exact(const Options& options, bool bounded, bool noisy) {
  fmt::print("# to 1e-8, {}{}: median evaluations, upper 95 % bound, libcmaes, ratios, successes\n",
             bounded ? "in the box [-5, 5]^n" : "unbounded", noisy ? ", taken for noisy" : "");
  double logarithms = 0, cells = 0;
  for (const auto& [name, peers] : kLibcmaes) {
    for (const std::size_t n : options.sizes({5, 10, 20, 40})) {
      std::vector<double> counts;
      for (std::uint64_t s = 1; s <= options.seeds; ++s) {
        counts.push_back(
            run({}, {name, n, s}, n, s, 1e4 * static_cast<double>(n), bounded, noisy, 1e-8).evaluations);
      }
      const double middle = median(counts), upper = upper_bound(counts), peer = peers.at(n);
      const auto solved =
          std::count_if(counts.begin(), counts.end(), [](double c) { return std::isfinite(c); });
      fmt::print("{:14} {:3} {:8.0f} {:8.0f} {:8.0f} {:6.3f} {:6.3f} {}/{}\n", name, n, middle, upper, peer,
                 middle / peer, upper / peer, solved, counts.size());
      std::fflush(stdout);
      logarithms += std::log(middle / peer);
      ++cells;
    }
  }
  fmt::print("geometric mean of the ratios {:.3f}\n", std::exp(logarithms / cells));
}

void rastrigin(const Options& options) {
  fmt::print(
      "# rotated Rastrigin, budget 1e4 n: successes, expected running time, median of the successes\n");
  for (const std::size_t n : options.sizes({5, 10, 20})) {
    double spent = 0;
    std::vector<double> counts;
    for (std::uint64_t s = 1; s <= options.seeds; ++s) {
      const Outcome o =
          run({}, {"rastrigin_rot", n, s}, n, s, 1e4 * static_cast<double>(n), false, false, 1e-8);
      spent += o.spent;
      if (std::isfinite(o.evaluations)) counts.push_back(o.evaluations);
    }
    fmt::print("{:3} {}/{} ERT {:.3g} median {:.0f}\n", n, counts.size(), options.seeds,
               spent / static_cast<double>(counts.size()), counts.empty() ? 0 : median(counts));
    std::fflush(stdout);
  }
}

void noisy(const Options& options) {
  fmt::print(
      "# sphere with N(0, 1) added, unbounded: median true value of the returned point, upper 95 % bound\n");
  for (const double budget : {100.0, 1000.0}) {
    for (const std::size_t n : options.sizes({5, 10, 20, 40})) {
      std::vector<double> values;
      for (std::uint64_t s = 1; s <= options.seeds; ++s) {
        values.push_back(
            run({}, {"sphere", n, s, 1}, n, s, budget * static_cast<double>(n), false, true, -kInfinity)
                .returned);
      }
      fmt::print("{:5}n {:3} {:9.4f} {:9.4f}\n", budget, n, median(values), upper_bound(values));
      std::fflush(stdout);
    }
  }
}

void overhead(const Options& options) {
  fmt::print(
      "# microseconds an evaluation, the function subtracted (sphere, N(0, 1) added, 2e4 evaluations)\n");
  for (const std::size_t n : options.sizes({5, 10, 20, 40, 100})) {
    double least = kInfinity;
    for (std::uint64_t s = 1; s <= 5; ++s) {
      CmaEs method;
      method.noise = CmaEs::Noise::off;
      method.restarts = CmaEs::Restarts::none;
      const Outcome o = run(method, {"sphere", n, s, 1}, n, s, 2e4, false, false, -kInfinity);
      least = std::min(least, 1e6 * o.seconds / o.spent);
    }
    fmt::print("{:3} {:.3f}\n", n, least);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace coppice::benchmark

int main(int argc, char** argv) {
  using namespace coppice::benchmark;
  Options options;
  if (argc > 1) options.part = argv[1];
  if (argc > 2) options.seeds = std::strtoull(argv[2], nullptr, 10);
  for (int i = 3; i < argc; ++i) options.dimensions.push_back(std::strtoull(argv[i], nullptr, 10));
  if (options.wants("exact")) exact(options, false, false);
  if (options.wants("bounded")) exact(options, true, false);
  if (options.wants("switch")) exact(options, false, true);
  if (options.wants("rastrigin")) rastrigin(options);
  if (options.wants("noisy")) noisy(options);
  if (options.wants("overhead")) overhead(options);
}
