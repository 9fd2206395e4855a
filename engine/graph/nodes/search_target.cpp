#include "engine/graph/nodes/search_target.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace coppice {
namespace {

void set_limits(Space& box, const std::vector<double>& given, double Axis::*side, std::string_view name) {
  if (given.empty()) return;
  if (given.size() != 1 && given.size() != box.size()) {
    throw std::invalid_argument(fmt::format(
        "{} has {} numbers, expected is one for all, or one for each of the {} numbers that are tuned", name,
        given.size(), box.size()));
  }
  for (std::size_t i = 0; i < box.size(); ++i) box[i].*side = given[given.size() == 1 ? 0 : i];
}

Space within(const Space& outer, const std::vector<double>& low, const std::vector<double>& high,
             std::string_view prefix) {
  Space box = outer;
  set_limits(box, low, &Axis::low, fmt::format("{}low", prefix));
  set_limits(box, high, &Axis::high, fmt::format("{}high", prefix));
  for (std::size_t i = 0; i < box.size(); ++i) {
    const Axis& axis = box[i];
    if (axis.low <= axis.high && axis.low >= outer[i].low && axis.high <= outer[i].high) continue;
    const bool open = std::isinf(outer[i].low) && std::isinf(outer[i].high);
    throw std::invalid_argument(
        fmt::format("the limits {}low and {}high of {} are {} and {}; expected are two in order{}", prefix,
                    prefix, axis.name, axis.low, axis.high,
                    open ? "" : fmt::format(" in [{}, {}]", outer[i].low, outer[i].high)));
  }
  return box;
}

}  // namespace

std::string point_text(const Space& box, std::span<const double> x) {
  constexpr std::size_t kMost = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(x.size(), kMost); ++i) {
    text += fmt::format("{}{} = {}", i > 0 ? ", " : "", box[i].name, x[i]);
  }
  return x.size() > kMost ? text + ", ..." : text;
}

Space limited(Space box, const std::vector<double>& low, const std::vector<double>& high) {
  return within(box, low, high, "");
}

std::vector<double> search_start(const Space& box, std::vector<double> guess, const std::vector<double>& low,
                                 const std::vector<double>& high, const Draws& draws) {
  if (low.empty() != high.empty()) throw std::invalid_argument("start_low and start_high go together");
  if (!low.empty()) {
    Stream stream = draws.stream("start");
    guess.clear();
    for (const Axis& axis : within(box, low, high, "start_")) {
      guess.push_back(stream.uniform(axis.low, axis.high));
    }
  }
  for (std::size_t i = 0; i < guess.size(); ++i) {
    if (guess[i] >= box[i].low && guess[i] <= box[i].high) continue;
    throw std::invalid_argument(fmt::format("{} begins at {}, outside of its limits {} and {}", box[i].name,
                                            guess[i], box[i].low, box[i].high));
  }
  return guess;
}

}  // namespace coppice
