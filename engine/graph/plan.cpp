#include "engine/graph/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "engine/graph/check_nodes.h"
#include "engine/graph/declared.h"
#include "engine/graph/key.h"
#include "engine/graph/planner.h"

namespace coppice {
namespace {

/// The name of the experiment becomes a folder beside the store.
void check_name(const ExperimentConfig& experiment, Diagnostics& diagnostics) {
  const std::string& name = experiment.name;
  if (name.empty() && !experiment.complete) return;  // the file was not read so far; that is reported
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-.").find(c) != std::string_view::npos;
  };
  constexpr std::size_t kLongest = 128;
  if (name.size() > kLongest) {
    diagnostics.error(
        experiment.place,
        fmt::format("the name of the experiment has {} characters: '{}...'", name.size(), name.substr(0, 20)),
        fmt::format("a folder is named after it: at most {}", kLongest));
    return;
  }
  const bool plain = !name.empty() && name.front() != '.' && name.front() != '-' &&
                     std::all_of(name.begin(), name.end(), allowed);
  if (!plain || name == "store" || name == "index.sqlite") {
    diagnostics.error(experiment.place, fmt::format("name=\"{}\" cannot be the name of a folder", name),
                      "a name has letters, digits, '_', '-' and '.', and is not 'store'");
  }
}

/// Name of a node's main component: "double_integrator" of a problem, "fpf" of a train.
std::string main_component(const PlannedNode& node) {
  std::string names;
  for (const SlotInfo& slot : Catalogue::instance().find(Node::kInterface, node.kind)->slots) {
    if (!slot.direct) continue;
    for (const Element& child : node.resolved->children) {
      if (Catalogue::instance().find(slot.interface, child.name) != nullptr) names += " " + child.name;
    }
  }
  return names;
}

void set_component(const Plan& plan, PlannedNode& node) {
  node.component = node.kind + main_component(node);
  for (const char* artifact : {"problem", "objective", "policy"}) {
    for (const PlannedInput& input : node.inputs) {
      if (input.artifact != artifact || input.nodes.empty()) continue;
      node.component += main_component(plan.nodes[input.nodes.front()]);
    }
  }
}

/// Key texts of the inputs, which repeat from node to node, are made once.
class KeyWriter {
 public:
  KeyWriter(const Plan& plan) : plan_(plan) {}

  std::string text(const PlannedNode& node) {
    std::string text;
    add_line(text, "key_format", std::to_string(kKeyFormat));
    if (!node.definition && node.node->random()) {
      const std::string& label = node.node->seed_label;
      add_line(text, "seed", std::to_string(plan_.experiment.seed));
      add_line(text, "seed_label", label.empty() ? node.kind : label);
      add_line(text, "replicate", std::to_string(node.replicate.value_or(0)));
    }
    text += node.parameters_text;
    for (const PlannedInput& input : node.inputs) {
      for (std::size_t i = 0; i < input.nodes.size(); ++i) {
        const std::string name = input.nodes.size() == 1 ? fmt::format("input.{}", input.parameter)
                                                         : fmt::format("input.{}.{}", input.parameter, i);
        add_input(text, name, plan_.nodes[input.nodes[i]]);
        if (node.node->shows_labels()) add_labels(text, name, plan_.nodes[input.nodes[i]]);
      }
    }
    return text;
  }

 private:
  /// A definition enters by its content, so that a changed parameter can be named; anything else by its key.
  void add_input(std::string& text, const std::string& name, const PlannedNode& input) {
    if (!input.definition) {
      add_line(text, name, input.key);
      return;
    }
    const auto [known, is_new] = definitions_.try_emplace({&input, name});
    if (is_new) known->second = with_prefix(input.parameters_text, "node", name);
    text += known->second;
  }

  static void add_labels(std::string& text, const std::string& name, const PlannedNode& input) {
    for (const auto& [label, value] : input.labels) add_line(text, name + ".label." + label, value);
    for (const auto& [label, unit] : input.units) add_line(text, name + ".unit." + label, unit);
    if (input.replicate) add_line(text, name + ".label.replicate", std::to_string(*input.replicate));
  }

  const Plan& plan_;
  std::map<std::pair<const PlannedNode*, std::string>, std::string> definitions_;
};

void compute_keys(Plan& plan, Diagnostics& diagnostics) {
  FileHashes files;
  std::map<const Element*, std::pair<std::string, std::string>>
      done;  // of replicates: the same text and hash
  KeyWriter writer(plan);
  for (PlannedNode& node : plan.nodes) {
    const auto [known, is_new] = done.try_emplace(node.resolved.get());
    auto& [text, family] = known->second;
    if (is_new) {
      add_component(text, "node", Node::kInterface, *node.resolved, files, diagnostics);
      for (const ComponentInfo* used : node.node->uses())
        add_line(text, "node." + used->interface, fmt::format("{}/{}", used->name, used->version));
      family = content_hash(text);
    }
    node.parameters_text = text;
    node.family = family;
    set_component(plan, node);
    node.key = content_hash(writer.text(node));
  }
  plan.files = plan.experiment.files;
  for (InputFile& file : files.all()) plan.files.push_back(std::move(file));
}

/// Gives the experiment's nodes their resolved elements.
void resolve_elements(const Declarations& declarations, ExperimentConfig& experiment) {
  std::map<const Element*, std::shared_ptr<const Element>> resolved;
  for (const DeclaredNode& node : declarations.nodes) {
    for (const DeclaredElement& element : node.elements) resolved[element.written] = element.resolved;
  }
  for (NodeElement& node : experiment.nodes) {
    const auto found = resolved.find(&node.element);
    if (found != resolved.end()) node.resolved = found->second;
  }
}

Plan plan_all(ExperimentConfig experiment, Diagnostics& diagnostics) {
  Plan plan;
  plan.experiment = std::move(experiment);
  check_name(plan.experiment, diagnostics);
  const std::size_t before = diagnostics.size();
  check_unused(plan.experiment, diagnostics);
  Declarations declarations = declare(plan.experiment, diagnostics);
  Planner(declarations, plan, diagnostics).make_nodes();
  check_nodes(declarations, plan, diagnostics);
  compute_keys(plan, diagnostics);
  if (diagnostics.size() == before) resolve_elements(declarations, plan.experiment);
  return plan;
}

}  // namespace

std::string Plan::key_text(std::size_t node) const {
  return KeyWriter(*this).text(nodes.at(node));
}

std::vector<std::size_t> Plan::find(std::string_view id_or_name) const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].id == id_or_name || nodes[i].name == id_or_name) found.push_back(i);
  }
  return found;
}

std::vector<std::string> Plan::ids() const {
  std::vector<std::string> ids;
  std::set<std::string_view> seen;
  for (const NodeElement& node : experiment.nodes) {
    const std::string_view id = node.element.get("id");
    if (seen.insert(id).second) ids.emplace_back(id);
  }
  return ids;
}

Plan make_plan(ExperimentConfig experiment) {
  Diagnostics diagnostics;
  Plan plan = plan_all(std::move(experiment), diagnostics);
  diagnostics.throw_if_any();
  return plan;
}

std::vector<Plan> make_plans(std::vector<ExperimentConfig> experiments) {
  Diagnostics diagnostics;
  std::vector<Plan> plans;
  std::map<std::string, std::string> names;
  for (ExperimentConfig& experiment : experiments) {
    const auto [first, is_new] = names.emplace(experiment.name, experiment.path);
    const bool unread = experiment.name.empty() && !experiment.complete;  // its name is not known
    if (!is_new && !unread) {
      diagnostics.error(experiment.place, fmt::format("the experiment '{}' is also made by {}",
                                                      experiment.name, first->second));
    }
    plans.push_back(plan_all(std::move(experiment), diagnostics));
  }
  diagnostics.throw_if_any();
  return plans;
}

}  // namespace coppice
