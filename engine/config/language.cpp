#include "engine/config/language.h"

#include <algorithm>

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
  if (std::erase(element.children, "*") > 0) {
    element.content = control.name == "group" ? LanguageContent::surrounding : LanguageContent::anything;
  }
  return element;
}

/// "In <grid> and <zip>: ..." for what stands in certain elements only.
std::string located(const ControlElement& control, const std::string& doc) {
  std::string text;
  for (const std::string& parent : control.inside) {
    text += text.empty() ? "In <" : (&parent == &control.inside.back() ? "> and <" : ">, <");
    text += parent;
  }
  return text.empty() ? doc : text + ">: " + doc;
}

/// XSD knows one declaration of a name: an attribute that one of two needs and the other lacks is optional in
/// both together.
void merge(LanguageElement& into, const ControlElement& control) {
  LanguageElement other = converted(control);
  into.doc += ' ' + located(control, other.doc);
  for (LanguageAttribute& attribute : into.attributes) {
    const auto same =
        std::find_if(other.attributes.begin(), other.attributes.end(),
                     [&](const LanguageAttribute& known) { return known.name == attribute.name; });
    attribute.required = attribute.required && same != other.attributes.end() && same->required;
    if (same == other.attributes.end()) continue;
    if (same->doc != attribute.doc) attribute.doc += ' ' + located(control, same->doc);
    other.attributes.erase(same);
  }
  for (LanguageAttribute& attribute : other.attributes) {
    into.attributes.push_back({attribute.name, located(control, attribute.doc), false});
  }
}

/// The declarations in one list: those that hold anywhere come before those for certain places.
std::vector<const ControlElement*> in_order() {
  std::vector<const ControlElement*> all;
  for (const ControlElement& control : control_elements()) all.push_back(&control);
  std::stable_partition(all.begin() + 1, all.end(),
                        [](const ControlElement* control) { return control->inside.empty(); });
  return all;
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
      {"optimizer", "Looks for the best parameters by trying them (black-box optimization)."},
      {"solver", "Learns a policy for a problem."}};
  language.root = converted(control_elements().front());
  for (const ControlElement* control : in_order()) {
    if (control->name == language.root.name) continue;
    const auto same = std::find_if(language.elements.begin(), language.elements.end(),
                                   [&](const LanguageElement& known) { return known.name == control->name; });
    if (same != language.elements.end()) {
      merge(*same, *control);
      continue;
    }
    LanguageElement element = converted(*control);
    element.doc = located(*control, element.doc);
    element.in_root = element.in_components = control->inside.empty();
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
