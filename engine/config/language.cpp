#include "engine/config/language.h"

#include <utility>

#include "engine/config/experiment.h"

namespace coppice {
namespace {

LanguageElement converted(const ControlElement& control) {
  LanguageElement element;
  element.name = control.name;
  element.doc = control.doc;
  for (const auto& [name, doc] : control.attributes) {
    if (name == "*") {
      element.free_attributes = true;
    } else if (name.ends_with('!')) {
      element.attributes.push_back({name.substr(0, name.size() - 1), doc, true});
    } else {
      element.attributes.push_back({name, doc, false});
    }
  }
  element.children = control.children;
  element.inside = control.inside;
  if (std::erase(element.children, "*") > 0) {
    element.content = control.name == "group" ? LanguageContent::surrounding : LanguageContent::anything;
  }
  return element;
}

/// Definitions that stand at the top level of a file.
bool is_global(const std::string& name) {
  return name == "arg" || name == "sweep" || name == "macro";
}

Language make_language() {
  Language language;
  language.root_interface = "node";
  language.common = {{"if", "The element counts only when this is true.", false},
                     {"unless", "The element counts only when this is false.", false}};
  language.interfaces = {
      {"node", "A step of an experiment: what it makes is stored under a key of everything it depends on."},
      {"problem", "A Markov decision process: states, actions, rewards, and how a step goes."},
      {"policy", "Chooses an action in a state."},
      {"approximator", "Learns a function from samples."},
      {"function", "A learned or given function of several variables."},
      {"exporter", "A format that policies are exported in (`policy export --to`, `<export to=\"\"/>`)."},
      {"objective", "A function to be made large by an optimizer."},
      {"optimizer", "Looks for the best parameters by trying them (black-box optimization)."},
      {"solver", "Learns a policy for a problem."}};
  language.root = converted(control_elements().front());
  for (const ControlElement& control : control_elements()) {
    if (control.name == language.root.name) continue;
    LanguageElement element = converted(control);
    element.in_root = control.inside.empty();
    element.in_components = control.inside.empty() && !is_global(control.name);
    language.elements.push_back(std::move(element));
  }
  return language;
}

}  // namespace

const Language& config_language() {
  static const Language kLanguage = make_language();
  return kLanguage;
}

}  // namespace coppice
