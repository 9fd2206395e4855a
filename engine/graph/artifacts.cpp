#include "engine/graph/artifacts.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "registry/text.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

template <class Interface>
Sub<Interface> made_component(const Element& element) {
  Diagnostics diagnostics;
  Sub<Interface> made = make<Interface>(element, diagnostics);
  diagnostics.throw_if_any();
  return made;
}

void require_same(const Space& given, const Space& wanted, std::string_view what, std::string_view part) {
  if (given.size() != wanted.size()) {
    throw std::invalid_argument(
        fmt::format("{} has {} axes for {}, the problem {}", what, given.size(), part, wanted.size()));
  }
  for (std::size_t i = 0; i < given.size(); ++i) {
    const Axis& a = given[i];
    const Axis& b = wanted[i];
    if (a.name == b.name && a.unit == b.unit && a.circular == b.circular) continue;
    const auto text = [](const Axis& axis) {
      return fmt::format("'{}'{}{}{}", axis.name, axis.unit.empty() ? "" : " in ", axis.unit,
                         axis.circular ? " (circular)" : "");
    };
    throw std::invalid_argument(
        fmt::format("{} has {} as axis {} of {}, the problem {}", what, text(a), i + 1, part, text(b)));
  }
}

/// The component of a policy that is nothing but its element; null for learned ones and those from files.
const Element* configured_policy(const InputNode& node) {
  const bool configured = node.kind == "policy" && !node.element->children.empty();
  return configured ? &node.element->children.front() : nullptr;
}

/// Where the policy file of a node is; empty where there is none yet.
fs::path policy_file(const InputNode& node) {
  if (!node.folder.empty()) return node.folder / kPolicyFile;
  return node.kind == "policy" ? fs::path(node.element->get("file")) : fs::path();
}

}  // namespace

void require_same_axes(const Spaces& given, const Spaces& problem, std::string_view what) {
  require_same(given.states, problem.states, what, "the state");
  if (given.actions.size() != problem.actions.size()) {
    throw std::invalid_argument(
        fmt::format("{} has {} actions, the problem {}", what, given.actions.size(), problem.actions.size()));
  }
  for (std::size_t i = 0; i < given.actions.size(); ++i) {
    const ActionBox& a = given.actions[i];
    const ActionBox& b = problem.actions[i];
    if (a.name != b.name) {
      throw std::invalid_argument(
          fmt::format("{} has '{}' as action {}, the problem '{}'", what, a.name, i, b.name));
    }
    require_same(a.axes, b.axes, what, fmt::format("action '{}'", a.name));
  }
}

std::shared_ptr<const Problem> load_problem(const InputNode& node) {
  if (!node.problem) throw std::logic_error("node " + node.id + " has no problem");
  return node.problem;
}

Sub<Objective> load_objective(const InputNode& node) {
  if (node.element->children.empty()) throw std::logic_error("node " + node.id + " has no objective");
  return made_component<Objective>(node.element->children.front());
}

std::shared_ptr<const Spaces> load_spaces(const InputNode& node) {
  const std::shared_ptr<const Problem> problem = load_problem(node);
  return {problem, &problem->spaces()};
}

MadePolicy load_policy(const InputNode& node, const Problem& problem) {
  MadePolicy policy;
  if (const Element* configured = configured_policy(node)) {
    policy = made_component<Policy>(*configured);
  } else if (const fs::path path = policy_file(node); !path.empty()) {
    const PolicyFile file = read_policy_file(path);
    const bool general = file.spaces.actions.empty();  // saved without a problem
    if (!general) require_same_axes(file.spaces, problem.spaces(), fmt::format("policy '{}'", node.id));
    policy = make_policy(file);
  } else if (node.spaces) {
    require_same_axes(*node.spaces, problem.spaces(), fmt::format("policy '{}'", node.id));
  }
  if (policy) policy.object->prepare(problem.spaces(), problem.simulator());
  return policy;
}

void write_policy(const MadePolicy& policy, const Spaces& spaces, NodeContext& context) {
  PolicyFile file{.writer = {},
                  .provenance = context.key(),
                  .spaces = spaces,
                  .component = policy.resolved,
                  .arrays = {}};
  policy->save(file.arrays);
  write_policy_file(context.folder() / kPolicyFile, file);
}

std::string common_origin(const InputNode& a, const InputNode& b) {
  if (!a.streams.empty() && !b.streams.empty() && a.streams.front() == b.streams.front())
    return fmt::format("come from the same draws ({})", b.streams.front());
  const std::string_view file = a.element->get("file");  // of datasets, which draw nothing
  const bool same_file = a.streams.empty() && !file.empty() && file == b.element->get("file");
  return same_file ? "are the same file" : "";
}

void require_samples_of(const InputNode& node, const Problem& problem) {
  if (node.spaces) return require_same_axes(*node.spaces, problem.spaces(), fmt::format("'{}'", node.id));
  if (node.columns.empty()) return;  // not known
  for (const std::string& column : dataset_column_names(problem.spaces())) {
    if (std::find(node.columns.begin(), node.columns.end(), column) != node.columns.end()) continue;
    throw std::invalid_argument(
        fmt::format("'{}' has no column '{}', which samples of the problem have; it has {}", node.id, column,
                    join(node.columns)));
  }
}

Dataset load_dataset(const InputNode& node, const Spaces& spaces) {
  return read_dataset(node.folder / kDatasetFile, spaces);
}

std::vector<std::string> value_columns(const Spaces& spaces, bool of_actions) {
  std::vector<std::string> columns;
  for (const Axis& axis : spaces.states) columns.push_back("s_" + axis.name);
  if (!of_actions) return columns;
  for (const ActionBox& box : spaces.actions) {
    if (box.axes.size() != spaces.widest_action()) continue;
    for (const Axis& axis : box.axes) columns.push_back("a_" + axis.name);
    break;
  }
  return columns;
}

FunctionFile load_function_file(const InputNode& node) {
  const fs::path trained = node.folder / kValueFile;
  const fs::path path = fs::exists(trained) ? trained : node.folder / kFunctionFile;
  if (!fs::exists(path)) {
    throw ConfigError(fmt::format("node '{}' made no value function: its solver has none", node.id));
  }
  return read_function_file(path);
}

MadeFunction load_value_function(const InputNode& node, const Spaces& spaces) {
  if (node.folder.empty()) return {};
  const FunctionFile file = load_function_file(node);
  const std::vector<std::string> axes = value_columns(spaces, false);
  if (file.inputs != axes && file.inputs != value_columns(spaces, true)) {
    throw ConfigError(fmt::format(
        "the function of node '{}' depends on {}; a value function depends on {}, or on state and action",
        node.id, join(file.inputs), join(axes)));
  }
  return make_function(file);
}

}  // namespace coppice
