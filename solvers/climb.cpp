#include "solvers/climb.h"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <stdexcept>

namespace coppice {
namespace {

struct Climb {
  const Hill& hill;
  nlopt_opt optimizer;
  std::vector<double> best, slope;
  double best_value = -std::numeric_limits<double>::infinity();
  std::exception_ptr error;

  double evaluate(std::span<const double> x, double* gradient) {
    try {
      const double value = hill(x, slope);
      if (gradient != nullptr) std::copy(slope.begin(), slope.end(), gradient);
      if (value > best_value) {
        best_value = value;
        best.assign(x.begin(), x.end());
      }
      if (!std::isfinite(value)) nlopt_force_stop(optimizer);
      return value;
    } catch (...) {  // must not pass through the C library
      error = std::current_exception();
      nlopt_force_stop(optimizer);
      return 0;
    }
  }
};

}  // namespace

double climb(const Hill& hill, std::span<const double> low, std::span<const double> high,
             std::vector<double>& at, int evaluations) {
  const std::size_t n = at.size();
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> optimizer(
      nlopt_create(NLOPT_LD_LBFGS, static_cast<unsigned>(n)), nlopt_destroy);
  if (!optimizer) throw std::bad_alloc();
  for (std::size_t i = 0; i < n; ++i) at[i] = std::clamp(at[i], low[i], high[i]);
  Climb state{hill, optimizer.get(), at, std::vector<double>(n), -std::numeric_limits<double>::infinity(),
              {}};
  nlopt_set_lower_bounds(optimizer.get(), low.data());
  nlopt_set_upper_bounds(optimizer.get(), high.data());
  nlopt_set_maxeval(optimizer.get(), evaluations);
  nlopt_set_xtol_rel(optimizer.get(), 1e-9);
  nlopt_set_ftol_rel(optimizer.get(), 1e-10);
  nlopt_set_max_objective(
      optimizer.get(),
      [](unsigned size, const double* x, double* gradient, void* data) {
        return static_cast<Climb*>(data)->evaluate({x, size}, gradient);
      },
      &state);
  double value = 0;
  std::vector<double> x = at;
  nlopt_optimize(optimizer.get(), x.data(), &value);  // its status matters less than the best place seen
  if (state.error) std::rethrow_exception(state.error);
  for (std::size_t i = 0; i < n; ++i) at[i] = std::clamp(state.best[i], low[i], high[i]);
  return state.best_value;
}

}  // namespace coppice
