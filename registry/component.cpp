#include "registry/component.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "registry/parameter_text.h"
#include "registry/suggest.h"
#include "registry/text.h"
#include "registry/units.h"

namespace coppice {
namespace {

/// What is wrong with one parameter's declaration.
void verify_parameter(const ParameterInfo& info, const std::string& owner,
                      std::vector<std::string>& problems) {
  const std::string name = owner + ": parameter '" + info.name + "'";
  if (info.name.empty()) problems.push_back(owner + ": a parameter has no name");
  if (info.doc.empty()) problems.push_back(name + " has no doc");
  const std::optional<Quantity> unit = parse_unit(info.unit);
  if (!unit || unit->value != 1)
    problems.push_back(fmt::format("{}: '{}' is not an SI unit", name, info.unit));
  if (info.type == ValueType::choice && info.choices.empty()) problems.push_back(name + " has no choices");
  if (!(info.bounds.low <= info.bounds.high)) problems.push_back(name + " has bounds that nothing satisfies");
}

/// The default must be a value that the user may give.
void verify_default(const ParameterInfo& info, const std::string& owner, std::vector<std::string>& problems) {
  if (info.required || info.automatic || (info.type != ValueType::number && info.type != ValueType::integer))
    return;
  const std::optional<Quantity> value = parse_quantity(info.default_text);
  const Bounds& bounds = info.bounds;
  const bool inside = value && (bounds.low_open ? value->value > bounds.low : value->value >= bounds.low) &&
                      (bounds.high_open ? value->value < bounds.high : value->value <= bounds.high);
  if (!inside) {
    problems.push_back(fmt::format("{}: the default {} of '{}' is not {}", owner, info.default_text,
                                   info.name, bounds_text(info)));
  }
}

void verify_names(const ComponentInfo& info, const std::string& owner, const Catalogue& catalogue,
                  std::vector<std::string>& problems) {
  std::set<std::string> names, interfaces;
  for (const ParameterInfo& parameter : info.parameters) {
    if (!names.insert(parameter.name).second)
      problems.push_back(owner + ": '" + parameter.name + "' stands twice");
  }
  for (const SlotInfo& slot : info.slots) {
    if (slot.doc.empty())
      problems.push_back(owner + ": the " + slot.interface + " '" + slot.name + "' has no doc");
    if (slot.direct) {
      if (!interfaces.insert(slot.interface).second) {
        problems.push_back(fmt::format("{}: two of its {} stand directly in it", owner, slot.interface));
      }
    } else if (!names.insert(slot.name).second) {
      problems.push_back(owner + ": '" + slot.name + "' stands twice");
    }
    if (!slot.default_component.empty() &&
        catalogue.find(slot.interface, slot.default_component) == nullptr) {
      problems.push_back(fmt::format("{}: the default of '{}', the {} '{}', does not exist", owner, slot.name,
                                     slot.interface, slot.default_component));
    }
  }
  for (const SlotInfo& slot : info.slots) {  // <a> would be either
    for (const SlotInfo& direct : info.slots) {
      if (slot.direct || !direct.direct || catalogue.find(direct.interface, slot.name) == nullptr) continue;
      problems.push_back(
          fmt::format("{}: '{}' is also {}", owner, slot.name, with_article(direct.interface)));
    }
  }
}

}  // namespace

Catalogue& Catalogue::instance() {
  static Catalogue catalogue;
  return catalogue;
}

void Catalogue::add(ComponentInfo info) {
  auto& components = components_[info.interface];
  const std::string name = info.name;
  if (components.contains(name)) {
    problems_.push_back(fmt::format("{}/{} is registered twice", info.interface, name));
    return;
  }
  components.emplace(name, std::move(info));
}

const ComponentInfo* Catalogue::find(std::string_view interface, std::string_view name) const {
  const auto components = components_.find(interface);
  if (components == components_.end()) return nullptr;
  const auto info = components->second.find(name);
  return info == components->second.end() ? nullptr : &info->second;
}

std::vector<std::string> Catalogue::interfaces() const {
  std::vector<std::string> names;
  for (const auto& [interface, components] : components_) names.push_back(interface);
  return names;
}

std::vector<const ComponentInfo*> Catalogue::all(std::string_view interface) const {
  std::vector<const ComponentInfo*> infos;
  if (const auto components = components_.find(interface); components != components_.end()) {
    for (const auto& [name, info] : components->second) infos.push_back(&info);
  }
  return infos;
}

std::vector<std::string> Catalogue::names(std::string_view interface) const {
  std::vector<std::string> names;
  for (const ComponentInfo* info : all(interface)) names.push_back(info->name);
  return names;
}

void Catalogue::verify() const {
  std::vector<std::string> problems = problems_;
  for (const auto& [interface, components] : components_) {
    for (const auto& [name, info] : components) {
      const std::string owner = interface + "/" + name;
      if (name.empty()) problems.push_back(owner + " has no name");
      if (info.doc.empty()) problems.push_back(owner + " has no doc");
      if (info.source.empty()) problems.push_back(owner + " has no source");
      if (info.version < 1) problems.push_back(owner + " has a version below 1");
      verify_names(info, owner, *this, problems);
      for (const ParameterInfo& parameter : info.parameters) {
        verify_parameter(parameter, owner, problems);
        verify_default(parameter, owner, problems);
      }
    }
  }
  if (!problems.empty())
    throw std::logic_error("the catalogue of components is broken:\n  " + join(problems, "\n  "));
}

std::shared_ptr<void> detail::make_component(std::string_view interface, const Element& element,
                                             Element* resolved, Diagnostics& diagnostics) {
  if (const ComponentInfo* info = Catalogue::instance().find(interface, element.name); info != nullptr) {
    return info->make(element, resolved, diagnostics);
  }
  report_unknown_component(interface, element, diagnostics);
  return nullptr;
}

void detail::report_broken(const std::invalid_argument& broken, const Element& element,
                           Diagnostics& diagnostics) {
  const auto report = [&](const BrokenRule& rule) {
    const Place& place = place_of(element.find(rule.parameter), element);
    const std::string component = fmt::format("<{}>: ", element.name);
    try {
      std::rethrow_exception(rule.why);
    } catch (const ConfigError& mistakes) {
      for (const Diagnostic& mistake : mistakes.diagnostics())
        diagnostics.error(place, component + mistake.message, mistake.hint);
    } catch (const std::exception& why) {
      diagnostics.error(place, component + why.what());
    }
  };
  if (const auto* several = dynamic_cast<const BrokenRules*>(&broken)) {
    for (const BrokenRule& rule : several->all()) report(rule);
  } else {
    report({"", std::make_exception_ptr(broken)});
  }
}

void detail::report_unknown_component(std::string_view interface, const Element& element,
                                      Diagnostics& diagnostics) {
  const Catalogue& catalogue = Catalogue::instance();
  const std::vector<std::string> names = catalogue.names(interface);
  std::string message = fmt::format("there is no {} '{}'", interface, element.name);
  for (const std::string& other : catalogue.interfaces()) {
    if (catalogue.find(other, element.name) == nullptr) continue;
    message = fmt::format("'{}' is {}, not {}", element.name, with_article(other), with_article(interface));
  }
  std::vector<std::string> notes;
  if (!nearest(element.name, names).empty()) notes.push_back("valid: " + join(names));
  diagnostics.error(element.place, std::move(message), suggestion(element.name, names), std::move(notes));
}

}  // namespace coppice
