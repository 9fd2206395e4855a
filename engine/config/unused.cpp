#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "engine/config/attribute_place.h"
#include "engine/config/control_check.h"
#include "engine/config/text_template.h"
#include "registry/component.h"
#include "registry/parameter_text.h"
#include "registry/suggest.h"
#include "registry/text.h"

namespace coppice {
namespace {

using config::find_control;

/// What an element may be, going by its name and place. One name can be several things.
struct Meaning {
  bool top = false;       ///< the root, where nodes stand
  bool anything = false;  ///< where a macro's content will stand is not known
  std::vector<const ControlElement*> controls;
  std::vector<const ComponentInfo*> components;
  std::vector<std::string> slots;  ///< interfaces of what <name> holds

  bool empty() const { return controls.empty() && components.empty() && slots.empty(); }
  void add(const ControlElement* control) {
    if (control != nullptr) controls.push_back(control);
  }
  void add(const std::string& interface, std::string_view name) {
    if (const ComponentInfo* info = Catalogue::instance().find(interface, name)) components.push_back(info);
  }
};

/// Elements that expansion replaces by others, wherever they stand.
bool is_replaced(std::string_view name) {
  return name == "call" || name == "insert" || name == "group" || name == "include" || name == "let";
}

template <class Action>
void each_component(const Action& action) {
  for (const std::string& interface : Catalogue::instance().interfaces()) {
    for (const ComponentInfo* info : Catalogue::instance().all(interface)) action(*info);
  }
}

Meaning of_name(std::string_view name) {
  Meaning meaning;
  for (const ControlElement& control : control_elements()) {
    if (control.name == name && &control != &config::root_element()) meaning.controls.push_back(&control);
  }
  each_component([&](const ComponentInfo& info) {
    if (info.name == name) meaning.components.push_back(&info);
    for (const SlotInfo& slot : info.slots) {
      if (!slot.direct && slot.name == name) meaning.slots.push_back(slot.interface);
    }
  });
  return meaning;
}

Meaning inside(const Meaning& parent, std::string_view name) {
  if (parent.anything) return of_name(name);
  Meaning meaning;
  if (parent.top) {
    meaning.add(find_control(name, ""));
    meaning.add("node", name);
    return meaning;
  }
  if (is_replaced(name)) meaning.add(find_control(name, ""));
  for (const ControlElement* control : parent.controls) {
    const std::vector<std::string>& children = control->children;
    const bool belongs = std::find(children.begin(), children.end(), name) != children.end();
    if (belongs && !is_replaced(name)) meaning.add(find_control(name, control->name));
  }
  for (const ComponentInfo* info : parent.components) {
    for (const SlotInfo& slot : info->slots) {
      if (slot.direct) meaning.add(slot.interface, name);
      if (!slot.direct && slot.name == name) meaning.slots.push_back(slot.interface);
    }
  }
  for (const std::string& interface : parent.slots) meaning.add(interface, name);
  return meaning;
}

std::vector<std::string> names_inside(const Meaning& parent) {
  std::vector<std::string> names;
  const auto add = [&](const std::vector<std::string>& more) {
    names.insert(names.end(), more.begin(), more.end());
  };
  if (parent.top || parent.anything) add(Catalogue::instance().names("node"));
  for (const ControlElement& control : control_elements()) {
    const bool fits = parent.anything || (parent.top && control.inside.empty());
    if (fits && &control != &config::root_element()) names.push_back(control.name);
  }
  if (parent.anything) each_component([&](const ComponentInfo& info) { names.push_back(info.name); });
  for (const ControlElement* control : parent.controls) add(control->children);
  for (const ComponentInfo* info : parent.components) {
    for (const SlotInfo& slot : info->slots) {
      if (slot.direct) add(Catalogue::instance().names(slot.interface));
      if (!slot.direct) names.push_back(slot.name);
    }
  }
  for (const std::string& interface : parent.slots) add(Catalogue::instance().names(interface));
  return names;
}

class UnusedCheck {
 public:
  UnusedCheck(const UnusedPart& part, Diagnostics& diagnostics)
      : trace_(part.element.place.trace),
        known_(part.names_known ? &names_ : nullptr),
        names_(part.names),
        diagnostics_(diagnostics) {}

  void check(const Element& element, const Meaning& parent) {
    const Meaning meaning = inside(parent, element.name);
    if (meaning.empty()) return unknown(element, parent);
    if (element.name == "macro") add_parameters(element.get("params"));
    if (element.name == "insert") check_block(element);
    check_attributes(element, meaning);
    check_required(element, meaning);
    for (const Attribute& attribute : element.attributes) check_expressions(attribute);
    Meaning content = element.name == "group" ? parent : meaning;
    content.anything = content.anything || element.name == "macro" || element.name == "call";
    for (const Element& child : element.children) check(child, content);
  }

 private:
  Place traced(Place place) const {
    if (trace_) place.trace = trace_;
    return place;
  }

  void unknown(const Element& element, const Meaning& parent) {
    Element here;
    here.name = element.name;
    here.place = traced(element.place);
    const std::string hint = suggestion(element.name, names_inside(parent));
    std::vector<std::string> interfaces = parent.slots;  // of components that would stand here
    bool only_direct = parent.controls.empty();
    for (const ComponentInfo* info : parent.components) {
      only_direct = only_direct && info->slots.size() == 1 && info->slots.front().direct;
      if (only_direct) interfaces.push_back(info->slots.front().interface);
    }
    if (parent.top) {
      diagnostics_.error(here.place, fmt::format("there is no node kind <{}>", element.name), hint);
    } else if (parent.anything || !parent.controls.empty()) {
      diagnostics_.error(here.place,
                         parent.anything ? fmt::format("there is no element <{}>", element.name)
                                         : fmt::format("<{}> does not belong in <{}>", element.name,
                                                       parent.controls.front()->name),
                         hint);
    } else if (only_direct && interfaces.size() == 1) {
      detail::report_unknown_component(interfaces.front(), here, diagnostics_);
    } else {
      const std::string& name =
          parent.components.empty() ? parent.slots.front() : parent.components.front()->name;
      diagnostics_.error(here.place, fmt::format("<{}> has no element <{}>", name, element.name), hint);
    }
  }

  void check_attributes(const Element& element, const Meaning& meaning) {
    std::vector<std::string> known = {"if", "unless"};
    for (const ControlElement* control : meaning.controls) {
      for (const auto& [name, doc] : control->attributes) {
        if (name == "*") return;
        known.push_back(name.substr(0, name.size() - (name.ends_with('!') ? 1 : 0)));
      }
    }
    for (const ComponentInfo* info : meaning.components) {
      for (const ParameterInfo& parameter : info->parameters) known.push_back(parameter.name);
    }
    for (const Attribute& attribute : element.attributes) {
      if (std::find(known.begin(), known.end(), attribute.name) != known.end()) continue;
      diagnostics_.error(traced(attribute.name_place),
                         fmt::format("<{}> has no {} '{}'", element.name,
                                     meaning.components.empty() ? "attribute" : "parameter", attribute.name),
                         suggestion(attribute.name, known));
    }
  }

  /// Where it is clear what the element is.
  void check_required(const Element& element, const Meaning& meaning) {
    if (meaning.controls.size() + meaning.components.size() + meaning.slots.size() != 1) return;
    for (const ControlElement* control : meaning.controls)
      config::check_required(element, *control, trace_, diagnostics_);
    Element here = element, unused;
    here.place = traced(element.place);
    std::erase_if(here.attributes, [](const Attribute& a) { return is_control_attribute(a.name); });
    Reader reader(here, &unused, &diagnostics_);
    for (const ComponentInfo* info : meaning.components) {
      for (const ParameterInfo& parameter : info->parameters) {
        if (parameter.required && element.find(parameter.name) == nullptr)
          detail::report_missing(parameter, info->parameters, reader);
      }
    }
  }

  void check_expressions(const Attribute& attribute) {
    if (attribute.value.find('$') == std::string::npos) return;
    for (const config::ExpressionError& mistake : config::TextTemplate(attribute.value).mistakes(known_)) {
      diagnostics_.error(traced(config::place_in(attribute, mistake.offset, mistake.length)), mistake.what(),
                         mistake.hint);
    }
  }

  /// Inside a macro that nothing calls; elsewhere its parameters are not known.
  void check_block(const Element& insert) {
    const Attribute* block = insert.find("block");
    if (block == nullptr || !blocks_ ||
        std::find(blocks_->begin(), blocks_->end(), block->value) != blocks_->end())
      return;
    diagnostics_.error(traced(block->value_place), fmt::format("the macro has no block '{}'", block->value),
                       blocks_->empty() ? fmt::format("params=\"*{}\" would declare it", block->value)
                                        : suggestion(block->value, *blocks_));
  }

  /// "a, b:=1, *c"
  void add_parameters(std::string_view params) {
    blocks_.emplace();
    for (const std::string& item : config::split_items(params)) {
      const std::string name(trim(std::string_view(item).substr(0, item.find(":="))));
      if (name.starts_with('*')) blocks_->push_back(name.substr(1));
      names_.push_back(name);
    }
  }

  std::shared_ptr<const TraceFrame> trace_;
  const std::vector<std::string>* known_;  // null: expressions may use other names, too
  std::vector<std::string> names_;
  std::optional<std::vector<std::string>> blocks_;  // of the macro that is being checked
  Diagnostics& diagnostics_;
};

}  // namespace

void check_unused(const ExperimentConfig& experiment, Diagnostics& diagnostics) {
  for (const UnusedPart& part : experiment.unused) {
    Meaning place = of_name(part.parent);
    place.top = part.parent.empty();
    // Inside of what is a mistake itself, everything is.
    if (!place.top && place.empty()) continue;
    UnusedCheck(part, diagnostics).check(part.element, place);
  }
}

}  // namespace coppice
