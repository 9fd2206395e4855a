#include "engine/vocabulary/space.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace coppice {

double centre(const Axis& axis) {
  if (std::isfinite(axis.low) && std::isfinite(axis.high)) return axis.low / 2 + axis.high / 2;
  return std::clamp(0.0, axis.low, axis.high);
}

namespace {

double clamp(double value, const Axis& axis) {
  if (std::isnan(value)) return centre(axis);
  if (value >= axis.low && value <= axis.high) return value;
  const double width = axis.high - axis.low;
  if (!axis.circular || !std::isfinite(value) || !(width > 0)) return std::clamp(value, axis.low, axis.high);
  return std::clamp(value - width * std::floor((value - axis.low) / width), axis.low, axis.high);
}

void check_axes(const std::string& whose, const Space& axes, std::size_t limit) {
  if (axes.size() > limit) {
    throw std::invalid_argument(fmt::format("{} has {} axes; {} is the most", whose, axes.size(), limit));
  }
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const Axis& axis = axes[i];
    if (axis.name.empty())
      throw std::invalid_argument(fmt::format("axis {} of {} has no name", i + 1, whose));
    const auto same = [&axis](const Axis& other) { return other.name == axis.name; };
    if (std::any_of(axes.begin(), axes.begin() + static_cast<std::ptrdiff_t>(i), same)) {
      throw std::invalid_argument(fmt::format("{} has two axes called '{}'", whose, axis.name));
    }
    if (!(axis.low <= axis.high)) {
      throw std::invalid_argument(
          fmt::format("axis '{}' of {} reaches from {} to {}", axis.name, whose, axis.low, axis.high));
    }
  }
}

}  // namespace

std::size_t Spaces::widest_action() const {
  std::size_t widest = 0;
  for (const ActionBox& box : actions) widest = std::max(widest, box.axes.size());
  return widest;
}

void Spaces::check() const {
  if (states.empty()) throw std::invalid_argument("the state has no axis");
  check_axes("the state", states, kMaxStateSize);
  if (actions.empty()) throw std::invalid_argument("there is no action");
  for (const ActionBox& box : actions)
    check_axes(fmt::format("action '{}'", box.name), box.axes, kMaxActionSize);
}

void clamp_in_place(Action& action, const std::vector<ActionBox>& boxes) {
  if (action.id < 0 || static_cast<std::size_t>(action.id) >= boxes.size()) {
    throw std::invalid_argument(
        fmt::format("action {} does not exist; there are {}", action.id, boxes.size()));
  }
  const Space& axes = boxes[static_cast<std::size_t>(action.id)].axes;
  if (action.values.size() != axes.size()) {
    throw std::invalid_argument(fmt::format("action {} has {} parameters instead of {}", action.id,
                                            action.values.size(), axes.size()));
  }
  for (std::size_t i = 0; i < axes.size(); ++i) action.values[i] = clamp(action.values[i], axes[i]);
}

Action clamp(Action action, const std::vector<ActionBox>& boxes) {
  clamp_in_place(action, boxes);
  return action;
}

}  // namespace coppice
