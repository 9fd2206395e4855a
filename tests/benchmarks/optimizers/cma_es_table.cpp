// The bars of docs/optimizers.md about CMA-ES, measured: cma_es_table [part] [seeds] [dimensions...]
// Parts: exact, bounded, switch, border, rastrigin, rastrigin_bounded, noisy, overhead; all without
// arguments. Seeds: how many, or the first and the last ("1001-1051": seeds that no rate was chosen with).
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

/// The box is [-side, side]^n.
Outcome run(CmaEs method, TestFunction function, std::size_t n, std::uint64_t seed, double budget,
            double side, bool noisy, double target) {
  method.sigma = std::isfinite(side) ? 0.2 : 2;
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
  std::uint64_t first = 1001, last = 1051;  ///< seeds
  std::vector<std::size_t> dimensions;
  void read_seeds(const std::string& text) {
    const std::size_t dash = text.find('-');
    if (dash == std::string::npos) {
      last = first + std::strtoull(text.c_str(), nullptr, 10) - 1;
    } else {
      first = std::strtoull(text.c_str(), nullptr, 10);
      last = std::strtoull(text.c_str() + dash + 1, nullptr, 10);
    }
  }
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

/// One row; `peer`: libcmaes's evaluations, 0 where there are none.
void print_counts(const std::string& name, std::size_t n, const std::vector<double>& counts, double peer) {
  const double middle = median(counts), upper = upper_bound(counts);
  const auto solved = std::count_if(counts.begin(), counts.end(), [](double c) { return std::isfinite(c); });
  fmt::print("{:14} {:3} {:8.0f} {:8.0f}", name, n, middle, upper);
  if (peer > 0) fmt::print(" {:8.0f} {:6.3f} {:6.3f}", peer, middle / peer, upper / peer);
  fmt::print(" {}/{}\n", solved, counts.size());
  std::fflush(stdout);
}

void exact(const Options& options, bool bounded, bool noisy) {
  fmt::print("# to 1e-8, {}{}: median evaluations, upper 95 % bound, libcmaes, ratios, successes\n",
             bounded ? "in the box [-5, 5]^n" : "unbounded", noisy ? ", taken for noisy" : "");
  double logarithms = 0, upper_logarithms = 0, cells = 0;
  for (const auto& [name, peers] : kLibcmaes) {
    for (const std::size_t n : options.sizes({5, 10, 20, 40})) {
      std::vector<double> counts;
      for (std::uint64_t s = options.first; s <= options.last; ++s) {
        counts.push_back(
            run({}, {name, n, s}, n, s, 1e4 * static_cast<double>(n), bounded ? 5 : kInfinity, noisy, 1e-8)
                .evaluations);
      }
      print_counts(name, n, counts, peers.at(n));
      logarithms += std::log(median(counts) / peers.at(n));
      upper_logarithms += std::log(upper_bound(counts) / peers.at(n));
      ++cells;
    }
  }
  fmt::print("geometric mean of the ratios {:.3f} {:.3f}\n", std::exp(logarithms / cells),
             std::exp(upper_logarithms / cells));
}

void rastrigin(const Options& options, bool bounded) {
  fmt::print(
      "# rotated Rastrigin, {}, budget 1e4 n: successes, expected running time, median of the successes\n",
      bounded ? "in the box [-5, 5]^n" : "unbounded");
  for (const std::size_t n : options.sizes({5, 10, 20})) {
    double spent = 0;
    std::vector<double> counts;
    for (std::uint64_t s = options.first; s <= options.last; ++s) {
      const Outcome o = run({}, {"rastrigin_rot", n, s}, n, s, 1e4 * static_cast<double>(n),
                            bounded ? 5 : kInfinity, false, 1e-8);
      spent += o.spent;
      if (std::isfinite(o.evaluations)) counts.push_back(o.evaluations);
    }
    fmt::print("{:3} {}/{} ERT {:.3g} median {:.0f}\n", n, counts.size(), options.last - options.first + 1,
               spent / static_cast<double>(counts.size()), counts.empty() ? 0 : median(counts));
    std::fflush(stdout);
  }
}

void border(const Options& options) {
  fmt::print("# sphere in the box [-1, 1]^n, about half of whose sides the optimum lies beyond: as above\n");
  for (const std::size_t n : options.sizes({5, 10, 20, 40})) {
    std::vector<double> counts;
    for (std::uint64_t s = options.first; s <= options.last; ++s) {
      TestFunction function("sphere", n, s);
      std::vector<double> best = function.optimum();
      for (double& x : best) x = std::clamp(x, -1.0, 1.0);
      const double target = function.exact(best.data(), 1) + 1e-8;
      counts.push_back(run({}, function, n, s, 1e4 * static_cast<double>(n), 1, false, target).evaluations);
    }
    print_counts("border", n, counts, 0);
  }
}

void noisy(const Options& options) {
  fmt::print(
      "# sphere with N(0, 1) added, unbounded: median true value of the returned point, upper 95 % bound\n");
  for (const double budget : {100.0, 1000.0}) {
    for (const std::size_t n : options.sizes({5, 10, 20, 40})) {
      std::vector<double> values;
      for (std::uint64_t s = options.first; s <= options.last; ++s) {
        values.push_back(
            run({}, {"sphere", n, s, 1}, n, s, budget * static_cast<double>(n), kInfinity, true, -kInfinity)
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
      const Outcome o = run(method, {"sphere", n, s, 1}, n, s, 2e4, kInfinity, false, -kInfinity);
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
  if (argc > 2) options.read_seeds(argv[2]);
  for (int i = 3; i < argc; ++i) options.dimensions.push_back(std::strtoull(argv[i], nullptr, 10));
  if (options.wants("exact")) exact(options, false, false);
  if (options.wants("bounded")) exact(options, true, false);
  if (options.wants("switch")) exact(options, false, true);
  if (options.wants("rastrigin")) rastrigin(options, false);
  if (options.wants("rastrigin_bounded")) rastrigin(options, true);
  if (options.wants("border")) border(options);
  if (options.wants("noisy")) noisy(options);
  if (options.wants("overhead")) overhead(options);
}
