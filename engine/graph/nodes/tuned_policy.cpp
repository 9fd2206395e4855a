#include "engine/graph/nodes/tuned_policy.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/vocabulary/policy.h"
#include "registry/suggest.h"
#include "registry/text.h"

namespace coppice {
namespace {

bool is_tunable(const ParameterInfo& parameter) {
  return parameter.type == ValueType::number || parameter.type == ValueType::numbers;
}

/// Declared limits; an open end is moved inside.
Axis axis_of(const ParameterInfo& parameter, std::string name) {
  const Bounds& bounds = parameter.bounds;
  const double infinity = std::numeric_limits<double>::infinity();
  return {.name = std::move(name),
          .unit = parameter.unit,
          .low = bounds.low_open ? std::nextafter(bounds.low, infinity) : bounds.low,
          .high = bounds.high_open ? std::nextafter(bounds.high, -infinity) : bounds.high};
}

/// The numbers of a resolved value; none for "auto".
std::vector<double> numbers_of(std::string_view text) {
  std::vector<double> numbers;
  for (const std::string_view item : split_list(text)) {
    double value = 0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), value);
    if (error != std::errc() || end != item.data() + item.size()) return {};
    numbers.push_back(value);
  }
  return numbers;
}

}  // namespace

TunedPolicy::TunedPolicy(Element policy, const std::vector<std::string>& parameters)
    : policy_(std::move(policy)) {
  for (const std::string& parameter : parameters) add(parameter);
  if (box_.empty()) throw std::invalid_argument("parameters names none; there is nothing to tune");
}

void TunedPolicy::add(const std::string& parameter) {
  const ComponentInfo* info = Catalogue::instance().find(Policy::kInterface, policy_.name);
  if (info == nullptr) throw std::logic_error("no policy <" + policy_.name + ">");
  std::vector<std::string> tunable;
  const ParameterInfo* found = nullptr;
  for (const ParameterInfo& known : info->parameters) {
    if (!is_tunable(known)) continue;
    tunable.push_back(known.name);
    if (known.name == parameter) found = &known;
  }
  if (found == nullptr) {
    const std::string hint = tunable.empty() ? "it has none" : suggestion(parameter, tunable);
    throw std::invalid_argument(
        fmt::format("<{}> has no number or list of numbers '{}'; {}", policy_.name, parameter, hint));
  }
  for (const Part& part : parts_) {
    if (part.parameter == parameter)
      throw std::invalid_argument(fmt::format("parameters names '{}' twice", parameter));
  }
  const std::vector<double> numbers = numbers_of(policy_.get(parameter));
  if (numbers.empty()) {
    throw std::invalid_argument(
        fmt::format("{}=\"{}\" of <{}> has no numbers to begin with; give the policy some", parameter,
                    policy_.get(parameter), policy_.name));
  }
  parts_.push_back({parameter, numbers.size()});
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    box_.push_back(axis_of(*found, numbers.size() == 1 ? parameter : fmt::format("{}_{}", parameter, i)));
    configured_.push_back(numbers[i]);
  }
}

Element TunedPolicy::at(std::span<const double> numbers) const {
  Element element = policy_;
  std::size_t next = 0;
  for (const Part& part : parts_) {
    std::string text;
    for (std::size_t i = 0; i < part.numbers; ++i, ++next) {
      if (i > 0) text += ", ";
      text += fmt::format("{}", numbers[next]);
    }
    element.set(part.parameter, std::move(text));
  }
  return element;
}

}  // namespace coppice
