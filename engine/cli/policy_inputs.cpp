#include "engine/cli/policy_inputs.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "engine/cli/inputs.h"
#include "registry/suggest.h"

namespace coppice::cli {
namespace {

struct NamedProblem {
  std::shared_ptr<const Problem> problem;
  std::string name;
};

/// From a name, or from an element written out.
NamedProblem make_named(const CommandLine& line, const std::string& text) {
  Element element;
  if (text.starts_with('<')) {
    element = parse_xml(std::make_shared<const SourceFile>(SourceFile{"<--problem>", text}));
  } else {
    element.name = text;
    element.place = line.place(text);
  }
  Diagnostics diagnostics;
  const Sub<Problem> made = make<Problem>(element, diagnostics);
  diagnostics.throw_if_any();
  return {made.object, element.name};
}

/// The problem node `id` of a config.
NamedProblem find_problem(const CommandLine& line, const std::string& config, const std::string& id) {
  ConfigInputs inputs;
  inputs.words = {config};
  const Plan plan = std::move(plan_all(line, inputs).front());
  std::vector<std::string> known;
  for (const PlannedNode& node : plan.nodes) {
    if (node.kind != "problem") continue;
    known.push_back(node.name);
    if (node.name != id) continue;
    return {node.node->problem(), node.id};
  }
  throw line.error(id, fmt::format("{} has no problem '{}'", config, id), suggestion(id, known));
}

/// What keeps a policy for some spaces from being used in others; empty when nothing does. Limits may differ.
std::string difference(const Space& known, const Space& asked, const std::string& what) {
  if (known.size() != asked.size()) {
    return fmt::format("{} has {} axes in the policy file, {} in the problem", what, known.size(),
                       asked.size());
  }
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i].name == asked[i].name && known[i].unit == asked[i].unit) continue;
    return fmt::format("axis {} of {} is '{}' [{}] in the policy file, '{}' [{}] in the problem", i + 1, what,
                       known[i].name, known[i].unit, asked[i].name, asked[i].unit);
  }
  return {};
}

std::string difference(const Spaces& known, const Spaces& asked) {
  if (known.state_size() == 0) return {};  // saved without a problem
  std::string found = difference(known.states, asked.states, "the state");
  if (found.empty() && known.actions.size() != asked.actions.size()) {
    found = fmt::format("the policy file knows {} actions, the problem has {}", known.actions.size(),
                        asked.actions.size());
  }
  for (std::size_t i = 0; found.empty() && i < known.actions.size(); ++i) {
    found =
        difference(known.actions[i].axes, asked.actions[i].axes, "action '" + asked.actions[i].name + "'");
  }
  return found;
}

}  // namespace

ReadyPolicy ready_policy(const CommandLine& line, const PolicyInputs& inputs) {
  require_file(line, inputs.file);
  if (!inputs.config.empty()) require_file(line, inputs.config);
  if (!inputs.config.empty() && inputs.problem.empty()) {
    throw line.error("--config", "'--config' needs '--problem'", "the id of a problem node");
  }
  ReadyPolicy ready;
  ready.file = read_policy_file(inputs.file);
  ready.policy = make_policy(ready.file);
  ready.spaces = ready.file.spaces;
  if (!inputs.problem.empty()) {
    NamedProblem named = inputs.config.empty() ? make_named(line, inputs.problem)
                                               : find_problem(line, inputs.config, inputs.problem);
    ready.problem = std::move(named.problem);
    ready.problem_name = std::move(named.name);
    ready.spaces = ready.problem->spaces();
    const std::string found = difference(ready.file.spaces, ready.spaces);
    if (!found.empty()) throw line.error(inputs.problem, "the policy does not fit this problem: " + found);
  }
  if (ready.spaces.state_size() == 0) {
    throw line.error(inputs.file, "'" + inputs.file + "' was saved without a problem",
                     "give one with --problem");
  }
  try {
    ready.policy.object->prepare(ready.spaces, ready.problem ? ready.problem->simulator() : nullptr);
  } catch (const std::invalid_argument& reason) {
    throw line.error(inputs.file, std::string("the policy cannot be used: ") + reason.what());
  }
  return ready;
}

}  // namespace coppice::cli
