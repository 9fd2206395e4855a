#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/layout.h"
#include "engine/cli/policy_measures.h"
#include "registry/units.h"

namespace coppice::cli {
namespace {

using Json = nlohmann::ordered_json;

/// What is found out by letting the policy act.
struct Measures {
  Latency latency;
  std::vector<double> importance;
};

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

Json json(const ReadyPolicy& ready, std::uint64_t bytes, const Measures& measures) {
  Json object = {{"component", ready.file.component.name},
                 {"writer", ready.file.writer},
                 {"provenance", ready.file.provenance},
                 {"bytes", bytes},
                 {"states", json(ready.spaces.states)},
                 {"actions", Json::array()},
                 {"memory", ready.policy->memory_size()},
                 {"action_s", measures.latency.median},
                 {"action_p99_s", measures.latency.p99},
                 {"action_worst_state_s", measures.latency.worst_state},
                 {"importance", Json::object()},
                 {"facts", Json::object()},
                 {"parameters", to_xml(ready.file.component)},
                 {"arrays", Json::array()}};
  for (const ActionBox& box : ready.spaces.actions) {
    object["actions"].push_back({{"name", box.name}, {"axes", json(box.axes)}});
  }
  for (std::size_t k = 0; k < measures.importance.size(); ++k) {
    object["importance"][ready.spaces.states[k].name] = measures.importance[k];
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

std::string text(const ReadyPolicy& ready, std::uint64_t bytes, const Measures& measures) {
  const auto or_dash = [](const std::string& value) { return value.empty() ? std::string("-") : value; };
  std::vector<std::vector<std::string>> rows = {
      {"policy", ready.file.component.name},
      {"size", fmt::format("{} byte", bytes)},
      {"written by", or_dash(ready.file.writer)},
      {"made by node", or_dash(ready.file.provenance)},
      {"time per action",
       fmt::format("{:.2f} us (median), {:.2f} us (99 %), {:.2f} us (worst state's median); measured here",
                   measures.latency.median * 1e6, measures.latency.p99 * 1e6,
                   measures.latency.worst_state * 1e6)}};
  for (const auto& [name, value] : ready.policy->facts()) rows.push_back({name, number_text(value)});
  for (const auto& [name, array] : ready.file.arrays.arrays()) {
    rows.push_back({"array", fmt::format("{}: {} x {}", name, length(array), type_name(array))});
  }
  std::vector<std::vector<std::string>> axes;
  for (std::size_t k = 0; k < ready.spaces.states.size(); ++k) {
    std::vector<std::string>& cells = axes.emplace_back(row("state", ready.spaces.states[k]));
    if (measures.importance.empty()) continue;
    cells.push_back(fmt::format("importance {:.3f}", measures.importance[k]));
  }
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
    const Measures measures{measure_latency(ready), importance(ready)};
    const std::uint64_t bytes = std::filesystem::file_size(file);
    console.out(as_json ? json(ready, bytes, measures).dump(2) + '\n' : text(ready, bytes, measures));
    return kDone;
  }
};

const Command<PolicyInfo> kPolicyInfo({.name = "policy info",
                                       .group = Group::policies,
                                       .doc = "Shows what a policy file holds: component, spaces, origin, "
                                              "sizes, which inputs matter, time per action.",
                                       .details = "The time per action is measured here, over states spread "
                                                  "over the state space. Importance is that of a "
                                                  "state axis for the actions: the part of their variance "
                                                  "over the state space that is lost when it alone "
                                                  "is not known (the total-effect index). Of forests, visits "
                                                  "is the largest number of nodes that an action "
                                                  "can take.",
                                       .examples = {
                                           {"runner policy info learned.policy", "For people."},
                                           {"runner policy info learned.policy --json", "For programs."}}});

}  // namespace
}  // namespace coppice::cli
