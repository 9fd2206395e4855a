#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "engine/config/attribute_place.h"
#include "engine/config/control_check.h"
#include "engine/config/expander.h"
#include "registry/suggest.h"
#include "registry/text.h"

namespace coppice::config {
namespace {

constexpr auto kTypes = std::to_array<std::string_view>({"number", "integer", "boolean", "text", "list"});

bool same_place(const Place& a, const Place& b) {
  return a.file == b.file && a.line == b.line && a.column == b.column;
}

std::string where(const Place& place) {
  if (!place.file) return "before";
  return fmt::format("at {}:{}:{}", place.file->path, place.line, place.column);
}

}  // namespace

void Expander::let(const Element& element, const Context& context) {
  if (!check(element, "", context)) return;
  define(*element.find("name"), evaluator_.value(*element.find("value"), context), element, "constant",
         context);
}

/// Adds a definition to the scope. `value` is empty when it could not be worked out.
void Expander::define(const Attribute& name, std::optional<Value> value, const Element& element,
                      std::string what, const Context& context) {
  const Place place = traced(name.value_place, context);
  if (!check_name(name.value, place, diagnostics_)) return;
  Definition made{value.value_or(Value::boolean(false)), place, std::move(what), !value};
  const Definition* before = context.scope->find_here(name.value);
  if (before == nullptr) {
    context.scope->define(name.value, std::move(made));
  } else if (!same_place(before->place, place) || before->value.to_text() != made.value.to_text()) {
    // Two files may include a third one: the same definition with the same value is no second one.
    diagnostics_.error(place, fmt::format("'{}' is defined a second time", name.value),
                       fmt::format("it is the {} defined {}", before->what, where(before->place)));
    return;
  }
  if (context.scope != global_) return;
  for (const auto& [id, sweep] : sweeps_) {
    const std::vector<std::string>& columns = sweep->points.columns;
    if (std::find(columns.begin(), columns.end(), name.value) == columns.end()) continue;
    diagnostics_.error(place, fmt::format("'{}' is a column of sweep '{}' already", name.value, id),
                       fmt::format("<{}> and columns have different names", element.name));
  }
}

void Expander::argument(const Element& element, const Context& context) {
  const std::size_t before = diagnostics_.size();
  if (!global_only(element, context) || !check(element, "", context)) return;
  const bool sound = diagnostics_.size() == before;
  const Attribute& name = *element.find("name");
  for (PassedArguments* passed = context.passed; passed != nullptr; passed = passed->outer) {
    passed->declared.push_back(name.value);
  }
  check_values(element, context);
  std::optional<Value> value;
  // What looks like a missing default may be the attribute that was misspelt.
  if (sound || element.find("default") != nullptr) value = argument_value(element, name.value, context);
  if (!value) result_.complete = false;
  result_.arguments.emplace(name.value, value ? value->to_text() : "");
  define(name, std::move(value), element, "argument", context);
}

/// From the command line, else from the <include> of the file, else the default.
std::optional<Value> Expander::argument_value(const Element& element, const std::string& name,
                                              const Context& context) {
  const Attribute* from_include = nullptr;
  for (PassedArguments* passed = context.passed; passed != nullptr; passed = passed->outer) {
    const auto found = passed->values.find(name);
    if (found == passed->values.end()) continue;
    passed->taken.insert(name);
    if (from_include == nullptr) from_include = &found->second;
  }
  if (GivenArgument* given = given_.find(name)) return given_value(element, *given, context);
  if (from_include != nullptr) {
    if (from_include->failed) return std::nullopt;
    return checked(element, *from_include, Value::inferred(from_include->value), context);
  }
  if (const Attribute* otherwise = element.find("default")) {
    return checked(element, *otherwise, evaluator_.value(*otherwise, context), context);
  }
  error(element.find("name")->value_place, context, fmt::format("the argument '{}' has no value", name),
        fmt::format("give {}:=... on the command line, or a default", name));
  return std::nullopt;
}

std::optional<Value> Expander::given_value(const Element& element, GivenArgument& given,
                                           const Context& context) {
  given.taken = true;
  if (given.values.size() > 1 && !check_items(given.whole, diagnostics_)) return std::nullopt;
  if (given.values.size() > 1 && element.get("type") != "list") given_.sweep(given);
  if (!given.swept) return checked(element, given.whole, evaluator_.value(given.whole, context), context);
  std::optional<Value> chosen;
  for (std::size_t i = 0; i < given.values.size(); ++i) {
    const Attribute& source = given.values[i];
    std::optional<Value> value = checked(element, source, evaluator_.value(source, context), context);
    if (i == given.chosen) chosen = std::move(value);
  }
  return chosen;
}

/// Reports what no list of values has: nothing, an empty item, an item twice.
void Expander::check_values(const Element& element, const Context& context) {
  const Attribute* attribute = element.find("values");
  if (attribute == nullptr) return;
  Attribute values = *attribute;
  values.value_place = traced(attribute->value_place, context);
  const std::vector<std::string> texts = split_items(values.value);
  if (texts.empty())
    diagnostics_.error(values.value_place, "'values' is empty", "values are separated by commas");
  if (!check_items(values, diagnostics_)) return;
  std::set<std::string_view> seen;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (seen.insert(texts[i]).second) continue;
    const Place place = place_in(values, item_offsets(values.value)[i], texts[i].size());
    error(place, context, fmt::format("'values' has '{}' twice", texts[i]));
  }
}

/// The value that `source` gives, if there is one and the declaration allows it.
std::optional<Value> Expander::checked(const Element& element, const Attribute& source,
                                       std::optional<Value> value, const Context& context) {
  if (value) value = with_unit(element, source, *value, context);
  if (value) value = typed(element, source, *value, context);
  if (value && !allowed(element, source, *value, context)) return std::nullopt;
  return value;
}

std::optional<Value> Expander::typed(const Element& element, const Attribute& source, const Value& value,
                                     const Context& context) {
  const Attribute* attribute = element.find("type");
  if (attribute == nullptr) return value;
  const std::string& type = attribute->value;
  if (std::find(kTypes.begin(), kTypes.end(), type) == kTypes.end()) {
    error(attribute->value_place, context, fmt::format("there is no type '{}'", type),
          suggestion(type, {kTypes.begin(), kTypes.end()}));
    return value;
  }
  if (type == "text") return Value::text(value.to_text());
  if (type == "list") {
    Attribute list = source;
    list.value_place = traced(source.value_place, context);
    const bool as_written = source.value.find("${") == std::string::npos;
    if (as_written && !check_items(list, diagnostics_)) return std::nullopt;
    return value.as_list() != nullptr ? value : Value::list({value});
  }
  const double* plain = value.as_plain_number();
  const bool integer = plain != nullptr && *plain == std::floor(*plain) && std::abs(*plain) <= 0x1p53;
  const bool good = type == "boolean"   ? value.as_boolean() != nullptr
                    : type == "integer" ? integer
                                        : value.as_quantity() != nullptr;
  if (good) return value;
  error(source.value_place, context,
        fmt::format("the argument '{}' must be {}, not {}", element.get("name"),
                    type == "boolean"   ? "true or false"
                    : type == "integer" ? "an integer"
                                        : "a number",
                    value.description()));
  return std::nullopt;
}

/// A plain number gets the unit that the argument declares.
std::optional<Value> Expander::with_unit(const Element& element, const Attribute& source, const Value& value,
                                         const Context& context) {
  const Attribute* attribute = element.find("unit");
  if (attribute == nullptr) return value;
  const std::optional<Quantity> unit = parse_unit(attribute->value);
  if (!unit) {
    error(attribute->value_place, context, fmt::format("'{}' is not a unit", attribute->value),
          "units: m, cm, s, ms, min, h, Hz, deg, rad, kg, N, byte, MB, m/s, kg*m^2, ...");
    return value;
  }
  const Quantity* quantity = value.as_quantity();
  if (quantity != nullptr && quantity->dimension == unit->dimension) return value;
  if (value.as_plain_number() != nullptr) return Value::inferred(value.to_text() + " " + attribute->value);
  error(source.value_place, context,
        fmt::format("the argument '{}' must be {}, not {}", element.get("name"),
                    dimension_text(unit->dimension), value.description()),
        fmt::format("such as 2 {}", attribute->value));
  return std::nullopt;
}

bool Expander::allowed(const Element& element, const Attribute& source, const Value& value,
                       const Context& context) {
  const Attribute* attribute = element.find("values");
  if (attribute == nullptr) return true;
  const std::vector<std::string> texts = split_items(attribute->value);
  if (texts.empty()) return true;  // reported
  const bool listed = std::any_of(texts.begin(), texts.end(), [&](const std::string& text) {
    return equal(value, Value::inferred(text)).value_or(false);
  });
  if (listed) return true;
  const std::string hint = suggestion(value.to_text(), texts);
  error(source.value_place, context,
        fmt::format("the argument '{}' cannot be '{}'; its values: {}", element.get("name"), value.to_text(),
                    join(texts)),
        hint.starts_with("did you mean") ? hint : "");
  return false;
}

}  // namespace coppice::config
