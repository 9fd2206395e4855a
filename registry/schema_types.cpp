#include "registry/schema_types.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "registry/text.h"
#include "registry/units.h"

// Patterns are XSD regular expressions, matched against the whole value with its white space collapsed.

namespace coppice {
namespace {

constexpr const char* kNumber = "[+\\-]?([0-9]+(\\.[0-9]*)?|\\.[0-9]+)([eE][+\\-]?[0-9]+)?";
/// Only what can be a whole number: "12", "12.0", "1.5e3".
constexpr const char* kInteger =
    "[+\\-]?([0-9]+(\\.0*)?|[0-9]+(\\.[0-9]*)?[eE]\\+?[0-9]+|\\.[0-9]+[eE]\\+?[0-9]+|[0-9]+0[eE]-[0-9]+)";
constexpr const char* kExpression = ".*[$][{(].*";

bool may_be_infinite(const ParameterInfo& info) {
  return info.default_text.find("inf") != std::string::npos;
}

/// Units of the declared dimension by name, or any product, quotient or power.
std::string unit_pattern(const std::string& unit) {
  const Dimension dimension = parse_unit(unit).value_or(Quantity{}).dimension;
  std::string names;
  for (const NamedUnit& named : named_units()) {
    if (named.value.dimension == dimension) names.append(named.name).append("|");
  }
  return fmt::format("({}[0-9A-Za-z%]+( ?[*/\\^] ?-?[0-9A-Za-z%]+)+)", names);
}

std::string quantity_pattern(const ParameterInfo& info) {
  return fmt::format("{} ?{}", kNumber, unit_pattern(info.unit));
}

void write_pattern(XmlWriter& xml, const std::string& pattern) {
  const auto type = xml.open("xs:simpleType");
  const auto restriction = xml.open("xs:restriction", {{"base", "xs:token"}});
  xml.leaf("xs:pattern", {{"value", pattern}});
}

/// A number without unit, which the bounds can be checked of.
void write_plain_number(XmlWriter& xml, const ParameterInfo& info) {
  const auto type = xml.open("xs:simpleType");
  const auto restriction = xml.open("xs:restriction", {{"base", "xs:double"}});
  xml.leaf("xs:pattern", {{"value", info.type == ValueType::integer ? kInteger : kNumber}});
  const Bounds& bounds = info.bounds;
  if (!std::isinf(bounds.low)) {
    xml.leaf(bounds.low_open ? "xs:minExclusive" : "xs:minInclusive", {{"value", number_text(bounds.low)}});
  }
  if (!std::isinf(bounds.high)) {
    xml.leaf(bounds.high_open ? "xs:maxExclusive" : "xs:maxInclusive", {{"value", number_text(bounds.high)}});
  }
}

void write_number(XmlWriter& xml, const ParameterInfo& info, const std::string& named) {
  const auto type = xml.open("xs:simpleType");
  const auto all = xml.open("xs:union", {{"memberTypes", named}});
  write_plain_number(xml, info);
  write_pattern(xml, quantity_pattern(info));
  if (may_be_infinite(info)) write_pattern(xml, "[+\\-]?inf");
}

void write_numbers(XmlWriter& xml, const ParameterInfo& info, const std::string& named) {
  const std::string number = fmt::format("({}( ?{})?{})", kNumber, unit_pattern(info.unit),
                                         may_be_infinite(info) ? "|[+\\-]?inf" : "");
  const auto type = xml.open("xs:simpleType");
  const auto all = xml.open("xs:union", {{"memberTypes", named}});
  write_pattern(xml, fmt::format("({0}( ?, ?{0})*){1}", number, info.required ? "" : "?"));
}

void write_choice(XmlWriter& xml, const ParameterInfo& info, const std::string& named) {
  const auto type = xml.open("xs:simpleType");
  const auto all = xml.open("xs:union", {{"memberTypes", named}});
  const auto choice = xml.open("xs:simpleType");
  const auto restriction = xml.open("xs:restriction", {{"base", "xs:token"}});
  for (const std::string& name : info.choices) xml.leaf("xs:enumeration", {{"value", name}});
}

void write_named(XmlWriter& xml, const std::string& named) {
  const auto type = xml.open("xs:simpleType");
  xml.leaf("xs:union", {{"memberTypes", named}});
}

}  // namespace

void write_value_type(XmlWriter& xml, const ParameterInfo& info) {
  const std::string named = info.automatic ? "expression auto" : "expression";
  switch (info.type) {
    case ValueType::number:
    case ValueType::integer:
      return write_number(xml, info, named);
    case ValueType::numbers:
      return write_numbers(xml, info, named);
    case ValueType::choice:
      return write_choice(xml, info, named);
    case ValueType::boolean:
      return write_named(xml, named + " truth");
    case ValueType::reference:
      return write_named(xml, named + (info.required ? " id" : " id none"));
    case ValueType::text:
    case ValueType::texts:
    case ValueType::file:
    case ValueType::references:
      return write_named(xml, named + (info.required ? " something" : " xs:string"));
  }
}

void write_value_types(XmlWriter& xml) {
  const auto write = [&xml](const std::string& name, const std::string& doc, const std::string& pattern) {
    const auto type = xml.open("xs:simpleType", {{"name", name}});
    xml.documentation(doc);
    const auto restriction = xml.open("xs:restriction", {{"base", "xs:token"}});
    xml.leaf("xs:pattern", {{"value", pattern}});
  };
  write("expression", "Worked out when the config is read: ${...} or $(...).", kExpression);
  write("auto", "The component works the value out.", "auto");
  write("truth", "true or false.", "true|false|1|0");
  write("id", "The id of an element.", "[^,]+");
  write("none", "Left open.", "");
  write("something", "Any text that is not blank.", ".+");
}

}  // namespace coppice
