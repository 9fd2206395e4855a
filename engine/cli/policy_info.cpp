#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/layout.h"
#include "engine/cli/policy_inputs.h"
#include "registry/units.h"

namespace coppice::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Median wall time of one action, over states spread over the state space; s.
double action_time(const ReadyPolicy& ready) {
  constexpr std::size_t kStates = 256, kRounds = 41;
  const Draws draws(0, "latency", 0);
  const Space& axes = ready.spaces.states;
  std::vector<double> states(kStates * axes.size());
  for (std::size_t i = 0; i < kStates; ++i) {
    for (std::size_t k = 0; k < axes.size(); ++k) {
      states[i * axes.size() + k] =
          draws.scenario(i).uniform("state", axes[k].low, axes[k].high, static_cast<std::uint32_t>(k));
    }
  }
  std::vector<double> memory(ready.policy->memory_size());
  Action action;
  std::vector<double> times;
  for (std::size_t round = 0; round < kRounds; ++round) {
    ready.policy->reset(memory);
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < kStates; ++i) {
      ready.policy->act({&states[i * axes.size()], axes.size()}, memory, draws.scenario(i), action);
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    times.push_back(taken.count() / kStates);
  }
  std::nth_element(times.begin(), times.begin() + kRounds / 2, times.end());
  return times[kRounds / 2];
}

Json json(const Axis& axis) {
  return {{"name", axis.name},
          {"unit", axis.unit},
          {"low", axis.low},
          {"high", axis.high},
          {"circular", axis.circular}};
}

Json json(const Space& space) {
  Json axes = Json::array();
  for (const Axis& axis : space) axes.push_back(json(axis));
  return axes;
}

std::string type_name(const Archive::Array& array) {
  static constexpr const char* kNames[] = {"float64", "float32", "int64", "int32", "uint8", "text"};
  return kNames[array.index()];
}

std::size_t length(const Archive::Array& array) {
  return std::visit([](const auto& values) { return values.size(); }, array);
}

Json json(const ReadyPolicy& ready, std::uint64_t bytes, double action_s) {
  Json object = {{"component", ready.file.component.name},
                 {"writer", ready.file.writer},
                 {"provenance", ready.file.provenance},
                 {"bytes", bytes},
                 {"states", json(ready.spaces.states)},
                 {"actions", Json::array()},
                 {"memory", ready.policy->memory_size()},
                 {"action_s", action_s},
                 {"facts", Json::object()},
                 {"parameters", to_xml(ready.file.component)},
                 {"arrays", Json::array()}};
  for (const ActionBox& box : ready.spaces.actions) {
    object["actions"].push_back({{"name", box.name}, {"axes", json(box.axes)}});
  }
  for (const auto& [name, value] : ready.policy->facts()) object["facts"][name] = value;
  for (const auto& [name, array] : ready.file.arrays.arrays()) {
    object["arrays"].push_back({{"name", name}, {"type", type_name(array)}, {"length", length(array)}});
  }
  return object;
}

std::vector<std::string> row(const std::string& label, const Axis& axis) {
  return {label, axis.name,
          fmt::format("[{}, {}]{}{}", number_text(axis.low), number_text(axis.high),
                      axis.unit.empty() ? "" : " ", axis.unit) +
              (axis.circular ? ", circular" : "")};
}

std::string text(const ReadyPolicy& ready, std::uint64_t bytes, double action_s) {
  const auto or_dash = [](const std::string& value) { return value.empty() ? std::string("-") : value; };
  std::vector<std::vector<std::string>> rows = {
      {"policy", ready.file.component.name},
      {"size", fmt::format("{} byte", bytes)},
      {"written by", or_dash(ready.file.writer)},
      {"made by node", or_dash(ready.file.provenance)},
      {"time per action", fmt::format("{:.2f} us", action_s * 1e6)}};
  for (const auto& [name, value] : ready.policy->facts()) rows.push_back({name, number_text(value)});
  for (const auto& [name, array] : ready.file.arrays.arrays()) {
    rows.push_back({"array", fmt::format("{}: {} x {}", name, length(array), type_name(array))});
  }
  std::vector<std::vector<std::string>> axes;
  for (const Axis& axis : ready.spaces.states) axes.push_back(row("state", axis));
  for (std::size_t id = 0; id < ready.spaces.actions.size(); ++id) {
    const ActionBox& box = ready.spaces.actions[id];
    const std::string label = fmt::format("action {} {}", id, box.name);
    if (box.axes.empty()) axes.push_back({label, "", "no parameters"});
    for (const Axis& axis : box.axes) axes.push_back(row(label, axis));
  }
  return aligned(rows) + '\n' + aligned(axes) + '\n' + to_xml(ready.file.component);
}

struct PolicyInfo : PolicyInputs {
  bool as_json = false;

  static Arguments<PolicyInfo> arguments() {
    return policy_arguments<PolicyInfo>().flag("--json", &PolicyInfo::as_json, "The same as JSON.");
  }

  int run(const CommandLine& line, Console& console) const {
    const ReadyPolicy ready = ready_policy(line, *this);
    const double action_s = action_time(ready);
    const std::uint64_t bytes = std::filesystem::file_size(file);
    console.out(as_json ? json(ready, bytes, action_s).dump(2) + '\n' : text(ready, bytes, action_s));
    return kDone;
  }
};

const Command<PolicyInfo> kPolicyInfo(
    {.name = "policy info",
     .group = Group::policies,
     .doc = "Shows what a policy file holds: component, spaces, origin, sizes, time per action.",
     .details = "The time per action is measured: the median over states spread over the state space.",
     .examples = {{"runner policy info learned.policy", "For people."},
                  {"runner policy info learned.policy --json", "For programs."}}});

}  // namespace
}  // namespace coppice::cli
