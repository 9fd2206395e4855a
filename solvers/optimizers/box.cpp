#include "solvers/optimizers/box.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace coppice {
namespace {

double lower_end(const Axis& axis) {
  return std::isfinite(axis.low) ? axis.low : std::min(0.0, axis.high);
}

}  // namespace

void check_task(const SearchTask& task, std::string_view method, std::int64_t least) {
  if (task.box.empty())
    throw std::invalid_argument(fmt::format("<{}>: there is nothing to optimize", method));
  for (const Axis& axis : task.box) {
    if (axis.low <= axis.high && axis.low < std::numeric_limits<double>::infinity() &&
        axis.high > -std::numeric_limits<double>::infinity()) {
      continue;
    }
    throw std::invalid_argument(
        fmt::format("<{}>: the limits of '{}' are {} and {}; expected are two numbers in order", method,
                    axis.name, axis.low, axis.high));
  }
  if (!task.guess.empty() && task.guess.size() != task.box.size()) {
    throw std::invalid_argument(fmt::format("<{}>: the guess has {} numbers, expected are {}", method,
                                            task.guess.size(), task.box.size()));
  }
  for (const double x : task.guess) {
    if (!std::isfinite(x)) {
      throw std::invalid_argument(fmt::format("<{}>: the guess has a {}; expected are numbers", method, x));
    }
  }
  if (task.budget < least) {
    throw std::invalid_argument(fmt::format("<{}>: a budget of {} evaluations is too small; it needs {}",
                                            method, task.budget, least));
  }
}

void check_boxed_task(const SearchTask& task, std::string_view method, std::int64_t least) {
  check_task(task, method, least);
  for (const Axis& axis : task.box) {
    if (std::isfinite(axis.high - axis.low)) continue;
    throw std::invalid_argument(fmt::format(
        "<{}> searches a finite box only, but '{}' is in [{}, {}]; give it limits, or use a method "
        "that needs none (cma_es, nelder_mead, sbplx, bobyqa, cobyla)",
        method, axis.name, axis.low, axis.high));
  }
}

void clip(const Space& box, std::span<double> x) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = std::isnan(x[i]) ? lower_end(box[i]) : std::clamp(x[i], box[i].low, box[i].high);
  }
}

std::vector<double> first_point(const SearchTask& task) {
  std::vector<double> x = task.guess;
  if (x.empty()) {
    for (const Axis& axis : task.box) x.push_back(centre(axis));
  }
  clip(task.box, x);
  return x;
}

std::vector<double> uniform_point(const Space& box, Stream& stream) {
  std::vector<double> x;
  x.reserve(box.size());
  for (const Axis& axis : box) x.push_back(stream.uniform(axis.low, axis.high));
  clip(box, x);
  return x;
}

double comparable(double value) {
  return std::isnan(value) ? -std::numeric_limits<double>::infinity() : value;
}

}  // namespace coppice
