#include "engine/config/control_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/config/attribute_place.h"
#include "engine/config/expression_tree.h"
#include "engine/config/value.h"
#include "registry/suggest.h"
#include "registry/text.h"

namespace coppice::config {
namespace {

using Trace = std::shared_ptr<const TraceFrame>;

Place traced(Place place, const Trace& trace) {
  if (trace) place.trace = trace;
  return place;
}

bool contains(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string> attribute_names(const ControlElement& declaration) {
  std::vector<std::string> names;
  for (const auto& [name, doc] : declaration.attributes) {
    names.push_back(name.ends_with('!') ? name.substr(0, name.size() - 1) : name);
  }
  return names;
}

void check_attributes(const Element& element, const ControlElement& declaration, const Trace& trace,
                      Diagnostics& diagnostics) {
  std::vector<std::string> known = attribute_names(declaration);
  if (contains(known, "*")) return;
  if (declaration.name != "experiment") known.insert(known.end(), {"if", "unless"});
  for (const Attribute& attribute : element.attributes) {
    if (contains(known, attribute.name)) continue;
    const bool as_in_ros = declaration.name == "arg" && attribute.name == "value";
    diagnostics.error(
        traced(attribute.name_place, trace),
        fmt::format("<{}> has no attribute '{}'", element.name, attribute.name),
        as_in_ros ? "its value is the 'default'; a constant is a <let>" : suggestion(attribute.name, known));
  }
}

}  // namespace

const ControlElement* find_control(std::string_view name, std::string_view parent) {
  const ControlElement* anywhere = nullptr;
  for (const ControlElement& element : control_elements()) {
    if (element.name != name || &element == &root_element()) continue;
    if (contains(element.inside, parent)) return &element;
    if (element.inside.empty()) anywhere = &element;
  }
  return anywhere;
}

const ControlElement& root_element() {
  return control_elements().front();
}

bool is_id(const std::string& text) {
  return !text.empty() && text.front() != '-' && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

bool check_name(const std::string& name, const Place& place, Diagnostics& diagnostics) {
  std::string problem;
  if (!is_identifier(name)) {
    problem = "letters, digits and '_', not beginning with a digit, make a name";
  } else if (is_reserved_name(name) || is_control_attribute(name)) {
    problem = "the language keeps this word for itself";
  } else if (find_function(name) != nullptr) {
    problem = "this is the name of a function";
  }
  if (problem.empty()) return true;
  diagnostics.error(place, fmt::format("'{}' cannot be a name", name), problem);
  return false;
}

bool check_required(const Element& element, const ControlElement& declaration, const Trace& trace,
                    Diagnostics& diagnostics) {
  const std::vector<std::string> known = attribute_names(declaration);
  bool complete = true;
  for (const auto& [name, doc] : declaration.attributes) {
    const std::string required = name.substr(0, name.size() - 1);
    if (!name.ends_with('!') || element.find(required) != nullptr) continue;
    complete = false;
    const auto misspelt = [&](const Attribute& given) {
      return !contains(known, "*") && !contains(known, given.name) && !is_control_attribute(given.name) &&
             nearest(given.name, known) == required;
    };
    if (std::any_of(element.attributes.begin(), element.attributes.end(), misspelt)) continue;
    diagnostics.error(traced(element.place, trace),
                      fmt::format("<{}> needs the attribute '{}'", element.name, required), doc);
  }
  return complete;
}

bool check_items(const Attribute& list, Diagnostics& diagnostics) {
  const std::vector<std::string> items = split_items(list.value);
  const std::vector<std::size_t> offsets = item_offsets(list.value);
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!items[i].empty() || trim(list.value.substr(offsets[i])).substr(0, 1) == "'") continue;
    const bool is_last = offsets[i] == list.value.size();  // behind the comma that makes it
    Place place = place_in(list, is_last ? list.value.rfind(',') : offsets[i], 1);
    place.trace = list.value_place.trace;
    diagnostics.error(place, fmt::format("'{}' has an empty item", list.name),
                      "values are separated by single commas");
    return false;
  }
  return true;
}

bool check_control(const Element& element, const ControlElement& declaration, const Trace& trace,
                   Diagnostics& diagnostics) {
  check_attributes(element, declaration, trace, diagnostics);
  const bool complete = check_required(element, declaration, trace, diagnostics);
  for (const Element& child : element.children) {
    if (contains(declaration.children, "*") || contains(declaration.children, child.name)) continue;
    const std::string hint = declaration.children.empty() ? fmt::format("<{}> has no content", element.name)
                                                          : suggestion(child.name, declaration.children);
    diagnostics.error(traced(child.place, trace),
                      fmt::format("<{}> does not belong in <{}>", child.name, element.name), hint);
  }
  return complete;
}

}  // namespace coppice::config
