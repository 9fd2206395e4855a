#include "registry/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "registry/parameter_text.h"
#include "registry/text.h"
#include "registry/units.h"

namespace coppice {
namespace {

constexpr int kDeepestExample = 4;  // components inside each other

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// A value that type and bounds allow, for a parameter without default.
std::string example_value(const ParameterInfo& info) {
  const Bounds& bounds = info.bounds;
  const bool low = !std::isinf(bounds.low), high = !std::isinf(bounds.high);
  double number = low ? bounds.low : high ? bounds.high : 1;
  if (low && high) {
    number = info.type == ValueType::integer ? std::ceil(bounds.low) : (bounds.low + bounds.high) / 2;
  }
  if (low && !high && bounds.low_open) number += 1;
  if (!low && high && bounds.high_open) number -= 1;
  const std::string unit = info.unit.empty() ? "" : " " + info.unit;
  switch (info.type) {
    case ValueType::number:
    case ValueType::integer:
    case ValueType::numbers:
      return number_text(number) + unit;
    case ValueType::boolean:
      return "true";
    case ValueType::choice:
      return info.choices.front();
    case ValueType::file:
      return info.name + ".csv";
    case ValueType::text:
    case ValueType::texts:
      return "my_" + info.name;
    case ValueType::reference:
    case ValueType::references:
      return "my_" + (info.artifact.empty() ? info.name : info.artifact);
  }
  return "";
}

/// The default component, else the one that needs least.
const ComponentInfo* example_component(const Catalogue& catalogue, const SlotInfo& slot) {
  if (const ComponentInfo* info = catalogue.find(slot.interface, slot.default_component)) return info;
  const auto needs = [](const ComponentInfo* info) {
    const auto required = [](const auto& declared) { return declared.required; };
    return std::count_if(info->slots.begin(), info->slots.end(), required) * 100 +
           std::count_if(info->parameters.begin(), info->parameters.end(), required);
  };
  const std::vector<const ComponentInfo*> all = catalogue.all(slot.interface);
  const auto least = std::min_element(all.begin(), all.end(),
                                      [&](const auto* a, const auto* b) { return needs(a) < needs(b); });
  return least == all.end() ? nullptr : *least;
}

Element example(const Catalogue& catalogue, const ComponentInfo& info, int depth) {
  constexpr std::size_t kShown = 3;
  const std::vector<std::string> common = common_parameters(catalogue, info.interface);
  Element element;
  element.name = info.name;
  std::size_t shown = 0;
  for (const ParameterInfo& parameter : info.parameters) {
    if (parameter.required) {
      element.set(parameter.name, example_value(parameter));
    } else if (depth == 0 && shown < kShown && !parameter.default_text.empty() &&
               !contains(common, parameter.name)) {
      element.set(parameter.name, default_text(parameter));
      ++shown;
    }
  }
  for (const SlotInfo& slot : info.slots) {
    const bool wanted = slot.required || (depth == 0 && !slot.default_component.empty());
    const ComponentInfo* part =
        wanted && depth < kDeepestExample ? example_component(catalogue, slot) : nullptr;
    if (part != nullptr) detail::fill_slot(slot, element, {example(catalogue, *part, depth + 1)});
  }
  return element;
}

/// The words of `text` in lines of at most `width` columns, each after `indent` blanks.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t width) {
  std::string lines, line;
  const std::size_t room = std::max<std::size_t>(width, indent + 20) - indent;
  const auto flush = [&] {
    if (!line.empty()) lines += std::string(indent, ' ') + line + "\n";
    line.clear();
  };
  while (!(text = trim(text)).empty()) {
    const std::string_view word = text.substr(0, text.find_first_of(" \n\t"));
    if (!line.empty() && line.size() + 1 + word.size() > room) flush();
    line.append(line.empty() ? "" : " ").append(word);
    text.remove_prefix(word.size());
  }
  flush();
  return lines;
}

std::string type_name(ValueType type) {
  switch (type) {
    case ValueType::number:
      return "number";
    case ValueType::integer:
      return "integer";
    case ValueType::boolean:
      return "boolean";
    case ValueType::text:
      return "text";
    case ValueType::choice:
      return "choice";
    case ValueType::numbers:
      return "numbers";
    case ValueType::texts:
      return "texts";
    case ValueType::file:
      return "file";
    case ValueType::reference:
      return "reference";
    case ValueType::references:
      return "references";
  }
  return "";
}

nlohmann::ordered_json parameter_json(const ParameterInfo& info) {
  nlohmann::ordered_json json = {{"name", info.name}, {"type", type_name(info.type)}, {"doc", info.doc}};
  if (!info.unit.empty()) json["unit"] = info.unit;
  if (!std::isinf(info.bounds.low)) json[info.bounds.low_open ? "above" : "at_least"] = info.bounds.low;
  if (!std::isinf(info.bounds.high)) json[info.bounds.high_open ? "below" : "at_most"] = info.bounds.high;
  if (!info.choices.empty()) json["choices"] = info.choices;
  if (!info.artifact.empty()) json["artifact"] = info.artifact;
  json["required"] = info.required;
  if (!info.required) json["default"] = info.default_text;
  if (info.automatic) json["automatic"] = true;
  if (info.fan_out) json["fan_out"] = true;
  return json;
}

nlohmann::ordered_json slot_json(const SlotInfo& slot) {
  nlohmann::ordered_json json = {{"name", slot.name}, {"interface", slot.interface},
                                 {"doc", slot.doc},   {"direct", slot.direct},
                                 {"many", slot.many}, {"required", slot.required}};
  if (!slot.default_component.empty()) json["default"] = slot.default_component;
  return json;
}

}  // namespace

std::vector<std::string> common_parameters(const Catalogue& catalogue, std::string_view interface) {
  constexpr std::size_t kFew = 3;
  const std::vector<const ComponentInfo*> all = catalogue.all(interface);
  std::vector<std::string> names;
  if (all.size() < kFew) return names;
  for (const ParameterInfo& parameter : all.front()->parameters) {
    const bool shared = std::all_of(all.begin(), all.end(), [&](const ComponentInfo* info) {
      return std::any_of(info->parameters.begin(), info->parameters.end(), [&](const ParameterInfo& other) {
        return other.name == parameter.name && other.doc == parameter.doc;
      });
    });
    if (shared) names.push_back(parameter.name);
  }
  return names;
}

Element example_of(const Catalogue& catalogue, const ComponentInfo& info) {
  if (info.example.empty()) return example(catalogue, info, 0);
  return parse_xml(std::make_shared<const SourceFile>(SourceFile{"example of " + info.name, info.example}));
}

std::string describe_text(const Catalogue& catalogue, const ComponentInfo& info, std::size_t width) {
  std::string text = fmt::format("{} ({})\n", info.name, info.interface);
  text += wrapped(info.doc, 2, width);
  text += wrapped("Source: " + info.source, 2, width);
  if (!info.parameters.empty()) text += "\nParameters\n";
  for (const ParameterInfo& parameter : info.parameters) {
    text += fmt::format("  {}: {}\n", parameter.name, parameter_text(parameter)) +
            wrapped(parameter.doc, 6, width);
  }
  if (!info.slots.empty()) text += "\nElements inside\n";
  for (const SlotInfo& slot : info.slots) {
    const std::vector<std::string> names = catalogue.names(slot.interface);
    text += slot.direct ? fmt::format("  {}\n", with_article(slot.interface))
                        : fmt::format("  <{}>\n", slot.name);
    text += wrapped(slot_text(slot), 6, width);
    if (!names.empty()) text += wrapped("one of " + join(names), 6, width);
  }
  return text + "\nExample\n" + to_xml(example_of(catalogue, info), 2);
}

nlohmann::ordered_json describe_json(const Catalogue& catalogue, const ComponentInfo& info) {
  nlohmann::ordered_json json = {{"interface", info.interface},
                                 {"name", info.name},
                                 {"doc", info.doc},
                                 {"source", info.source},
                                 {"version", info.version},
                                 {"parameters", nlohmann::ordered_json::array()},
                                 {"elements", nlohmann::ordered_json::array()}};
  for (const ParameterInfo& parameter : info.parameters)
    json["parameters"].push_back(parameter_json(parameter));
  for (const SlotInfo& slot : info.slots) json["elements"].push_back(slot_json(slot));
  json["example"] = to_xml(example_of(catalogue, info));
  return json;
}

}  // namespace coppice
