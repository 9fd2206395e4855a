// What pagmo2's CMA-ES costs an evaluation beside the function, for the row "overhead" of docs/optimizers.md;
// built and run by overhead.sh.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <utility>

namespace {

struct Sphere {
  std::size_t n = 1;
  pagmo::vector_double fitness(const pagmo::vector_double& x) const {
    double sum = 0;
    for (const double v : x) sum += v * v;
    return {sum};
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {pagmo::vector_double(n, -5), pagmo::vector_double(n, 5)};
  }
};

double now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Seconds an evaluation.
double cost_of_function(std::size_t n) {
  constexpr int kCalls = 10000;
  const pagmo::problem problem{Sphere{n}};
  const pagmo::vector_double x(n, 1.5);
  double sum = 0;
  const double before = now();
  for (int i = 0; i < kCalls; ++i) sum += problem.fitness(x)[0];
  return sum > 0 ? (now() - before) / kCalls : 0;
}

}  // namespace

int main() {
  const std::pair<std::size_t, unsigned> sizes[] = {{10, 10}, {20, 12}, {40, 15}};
  for (const auto& [n, population] : sizes) {
    double least = 1e9;
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const unsigned generations = 10000 / population;
      pagmo::algorithm method{pagmo::cmaes(generations, -1, -1, -1, -1, 0.2, 0, 0, false, false, seed)};
      pagmo::population start{pagmo::problem{Sphere{n}}, population, seed};
      const double before = now();
      const pagmo::population end = method.evolve(start);
      const double spent = now() - before;
      const double function = cost_of_function(n);
      const auto evaluations = static_cast<double>(end.get_problem().get_fevals() - population);
      least = std::min(least, 1e6 * (spent / evaluations - function));
    }
    std::printf("pagmo2 %3zu %.3f\n", n, least);
  }
}
