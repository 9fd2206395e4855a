#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "registry/component.h"
#include "registry/units.h"
#include "tests/support/make.h"

namespace coppice {

/// A value that the declaration of a required parameter allows.
inline std::string example_value(const ParameterInfo& info) {
  const Bounds& bounds = info.bounds;
  const double low = std::isfinite(bounds.low) ? bounds.low : std::min(0.0, bounds.high - 1);
  const double high = std::isfinite(bounds.high) ? bounds.high : low + 2;
  switch (info.type) {
    case ValueType::number:
      return number_text((low + high) / 2) + (info.unit.empty() ? "" : " " + info.unit);
    case ValueType::integer:
      return number_text(std::floor((low + high) / 2));
    case ValueType::numbers:  // as many as the double integrator has state axes
      return number_text((low + high) / 2) + ", " + number_text((low + high) / 2);
    case ValueType::boolean:
      return "true";
    case ValueType::choice:
      return info.choices.at(0);
    case ValueType::text:
    case ValueType::texts:
      return "example";
    default:
      throw std::logic_error("'" + info.name + "' refers to something outside the component");
  }
}

/// An element that makes the component: only what is required is given.
inline Element example_element(const ComponentInfo& info) {
  Element element;
  element.name = info.name;
  for (const ParameterInfo& parameter : info.parameters) {
    if (parameter.required) element.set(parameter.name, example_value(parameter));
  }
  for (const SlotInfo& slot : info.slots) {
    if (!slot.required || !slot.default_component.empty()) continue;
    const Catalogue& catalogue = Catalogue::instance();
    Element part = example_element(*catalogue.all(slot.interface).at(0));
    if (slot.direct) {
      element.children.push_back(std::move(part));
    } else {
      Element wrapper;
      wrapper.name = slot.name;
      wrapper.children.push_back(std::move(part));
      element.children.push_back(std::move(wrapper));
    }
  }
  return element;
}

/// The component of this name, made of its own example or, without one, with what is required and defaults
/// for the rest. Throws ConfigError.
template <class Interface>
Sub<Interface> make_example(const std::string& name) {
  const ComponentInfo* info = Catalogue::instance().find(Interface::kInterface, name);
  if (info == nullptr) throw std::logic_error("there is no component '" + name + "'");
  if (!info->example.empty()) return make_from_xml<Interface>(info->example);
  Diagnostics diagnostics;
  Sub<Interface> made = make<Interface>(example_element(*info), diagnostics);
  diagnostics.throw_if_any();
  return made;
}

/// Names a test after its component.
inline std::string component_name(const testing::TestParamInfo<std::string>& test) {
  return test.param;
}

}  // namespace coppice
