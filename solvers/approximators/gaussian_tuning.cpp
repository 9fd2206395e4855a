#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/vocabulary/elementary.h"
#include "solvers/approximators/gaussian_process.h"
#include "solvers/climb.h"

namespace coppice {
namespace {

GaussianKernel kernel_at(std::span<const double> logarithms) {
  GaussianKernel kernel;
  for (const double t : logarithms.first(logarithms.size() - 1)) kernel.lengths.push_back(elementary::exp(t));
  kernel.noise = elementary::exp(logarithms.back());
  return kernel;
}

}  // namespace

void tune(GaussianProcess& process, const GaussianTuning& tuning, int starts) {
  const std::size_t d = process.inputs();
  std::vector<double> low(d + 1), high(d + 1), begin(d + 1);
  for (std::size_t k = 0; k < d; ++k) {
    low[k] = elementary::log(tuning.shortest[k]);
    high[k] = elementary::log(tuning.longest[k]);
    begin[k] = elementary::log(process.kernel().lengths[k]);
  }
  low[d] = elementary::log(tuning.noise_low);
  high[d] = elementary::log(tuning.noise_high);
  begin[d] = elementary::log(process.kernel().noise);

  std::vector<double> values(process.values().begin(), process.values().end());
  const Hill likelihood = [&](std::span<const double> x, std::span<double> gradient) {
    process.set_kernel(kernel_at(x));
    process.set_values(values);
    return process.log_likelihood(gradient);
  };
  std::vector<double> best = begin;
  double best_value = -std::numeric_limits<double>::infinity();
  for (int start = 0; start < starts; ++start) {
    std::vector<double> at = begin;
    // Other starts: all lengths, and the noise, at parts of their logarithmic range; long and quiet first.
    const double part = start == 0 ? 0 : 1 - static_cast<double>(start) / static_cast<double>(starts + 1);
    for (std::size_t k = 0; start > 0 && k < d; ++k) at[k] = low[k] + part * (high[k] - low[k]);
    if (start > 0) at[d] = low[d] + (start % 2 == 1 ? 0.25 : 0.75) * (high[d] - low[d]);
    const double value = climb(likelihood, low, high, at, tuning.evaluations);
    if (value > best_value) {
      best_value = value;
      best = at;
    }
  }
  process.set_kernel(kernel_at(best));
  process.set_values(values);
}

}  // namespace coppice
