#include "registry/parameter_text.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

#include "registry/text.h"
#include "registry/units.h"

namespace coppice {
namespace {

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() || text.empty() || text == "auto" ? text : text + " " + unit;
}

std::string limit_text(double limit, const std::string& unit) {
  return with_unit(number_text(limit), unit);
}

}  // namespace

std::string type_text(const ParameterInfo& info) {
  const std::string artifact = info.artifact.empty() ? "node" : info.artifact;
  switch (info.type) {
    case ValueType::number:
      return "number";
    case ValueType::integer:
      return "integer";
    case ValueType::boolean:
      return "true or false";
    case ValueType::text:
      return "text";
    case ValueType::choice:
      return "one of " + join(info.choices);
    case ValueType::numbers:
      return "list of numbers";
    case ValueType::texts:
      return "list of texts";
    case ValueType::file:
      return "file";
    case ValueType::reference:
      return fmt::format("id of {}", with_article(artifact));
    case ValueType::references:
      return fmt::format("ids, each of {}", with_article(artifact));
  }
  return "";
}

std::string bounds_text(const ParameterInfo& info) {
  const Bounds& bounds = info.bounds;
  const bool low = !std::isinf(bounds.low), high = !std::isinf(bounds.high);
  const std::string low_text = limit_text(bounds.low, info.unit),
                    high_text = limit_text(bounds.high, info.unit);
  if (low && high) {
    return fmt::format("in {}{}, {}{}", bounds.low_open ? '(' : '[', number_text(bounds.low),
                       number_text(bounds.high), bounds.high_open ? ')' : ']') +
           (info.unit.empty() ? "" : " " + info.unit);
  }
  if (low) return fmt::format("{} {}", bounds.low_open ? ">" : ">=", low_text);
  if (high) return fmt::format("{} {}", bounds.high_open ? "<" : "<=", high_text);
  return "";
}

std::string default_text(const ParameterInfo& info) {
  return with_unit(info.default_text, info.unit);
}

std::string parameter_text(const ParameterInfo& info) {
  std::string text = type_text(info);
  const std::string bounds = bounds_text(info);
  if (!bounds.empty()) {
    text += " " + bounds;
  } else if (!info.unit.empty()) {
    text += fmt::format(" in {}", info.unit);
  }
  if (info.required) return text + ", required";
  return info.default_text.empty() ? text : text + ", default " + default_text(info);
}

std::string slot_text(const SlotInfo& slot) {
  std::string text = slot.doc + " (" + (slot.many ? "any number of: " : "") + with_article(slot.interface);
  if (!slot.default_component.empty()) {
    text += ", default " + slot.default_component;
  } else if (slot.required) {
    text += ", required";
  }
  return text + ")";
}

}  // namespace coppice
