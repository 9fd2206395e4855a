#include "engine/config/evaluator.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "engine/config/attribute_place.h"
#include "engine/config/expression_tree.h"
#include "registry/suggest.h"
#include "registry/text.h"

namespace coppice::config {
namespace {

constexpr int kMostFailures =
    5;  // reported for one attribute; its values at further sweep points are likely alike

/// The attribute that says the value of an <arg> or a <let>.
const Attribute* value_of(const Element& definition) {
  return definition.find(definition.name == "arg" ? "default" : "value");
}

/// The way from `name` back to `target` along the names that definitions use; empty when there is none.
std::vector<std::string> way(const std::string& name, const std::string& target,
                             const std::vector<const Element*>& definitions, std::set<std::string>& visited) {
  if (name == target) return {name};
  if (!visited.insert(name).second) return {};
  for (const Element* definition : definitions) {
    const Attribute* value = value_of(*definition);
    if (definition->get("name") != name || value == nullptr) continue;
    for (const std::string& used : TextTemplate(value->value).names()) {
      std::vector<std::string> rest = way(used, target, definitions, visited);
      if (rest.empty()) continue;
      rest.insert(rest.begin(), name);
      return rest;
    }
  }
  return {};
}

/// The circle in which the definition that has the attribute `use` needs `name`, which needs it; empty
/// without one.
std::vector<std::string> circle(const std::string& name, const Attribute& use,
                                const std::vector<const Element*>& definitions) {
  for (const Element* definition : definitions) {
    if (value_of(*definition) != &use) continue;
    std::set<std::string> visited;
    const std::string own(definition->get("name"));
    std::vector<std::string> names = way(name, own, definitions, visited);
    if (names.empty()) continue;
    names.insert(names.begin(), own);
    return names;
  }
  return {};
}

}  // namespace

class Evaluator::ContextNames : public Names {
 public:
  ContextNames(Evaluator& evaluator, const Attribute& attribute, const Context& context)
      : evaluator_(evaluator), attribute_(attribute), context_(context) {}

  const Value* find(std::string_view name) const override {
    const Scope::Found found = context_.scope->find(name);
    if (found.failed || (found.value == nullptr && context_.names_unknown)) throw AlreadyReported();
    return found.value;
  }

  ExpressionError unknown(std::string_view name, std::size_t offset) const override {
    return evaluator_.unknown_name(name, offset, attribute_, context_);
  }

  std::string folder() const override {
    const std::string path = attribute_.value_place.file ? attribute_.value_place.file->path : "";
    return std::filesystem::absolute(path).lexically_normal().parent_path().string();
  }

 private:
  Evaluator& evaluator_;
  const Attribute& attribute_;
  const Context& context_;
};

Place traced(const Place& place, const Context& context) {
  Place result = place;
  result.trace = context.trace;
  return result;
}

const TextTemplate& Evaluator::compiled(const Attribute& attribute) {
  return compiled_.try_emplace(&attribute, attribute.value).first->second;
}

std::optional<Value> Evaluator::value(const Attribute& attribute, const Context& context) {
  if (attribute.failed) return std::nullopt;
  std::vector<ExpressionError> errors;
  std::optional<Value> value = compiled(attribute).value(ContextNames(*this, attribute, context), errors);
  report(attribute, context, errors);
  return value;
}

std::optional<std::string> Evaluator::text(const Attribute& attribute, const Context& context) {
  if (attribute.failed) return std::nullopt;
  if (attribute.value.find('$') == std::string::npos) return attribute.value;
  std::vector<ExpressionError> errors;
  std::optional<std::string> text = compiled(attribute).text(ContextNames(*this, attribute, context), errors);
  report(attribute, context, errors);
  return text;
}

Attribute Evaluator::attribute(const Attribute& raw, const Context& context) {
  Attribute made{raw.name, {}, traced(raw.name_place, context), traced(raw.value_place, context)};
  std::optional<std::string> worked_out = text(raw, context);
  made.failed = !worked_out;
  made.value = worked_out ? std::move(*worked_out) : raw.value;
  return made;
}

void Evaluator::error(const Attribute& attribute, const Context& context, std::size_t offset,
                      std::size_t length, std::string message, std::string hint) {
  diagnostics_.error(traced(place_in(attribute, offset, length), context), std::move(message),
                     std::move(hint));
}

void Evaluator::report(const Attribute& attribute, const Context& context,
                       const std::vector<ExpressionError>& errors) {
  for (const ExpressionError& mistake : errors) {
    if (++failures_[&attribute] > kMostFailures) return;
    error(attribute, context, mistake.offset, mistake.length, mistake.what(), mistake.hint);
  }
}

ExpressionError Evaluator::unknown_name(std::string_view name, std::size_t offset, const Attribute& attribute,
                                        const Context& context) {
  const std::string text(name);
  if (const FunctionInfo* function = find_function(name)) {
    return {offset, name.size(), fmt::format("'{}' is a function", name),
            fmt::format("it is {}", function->signature)};
  }
  if (const auto column = columns_.find(text); column != columns_.end()) {
    const std::string sweeps = join({column->second.begin(), column->second.end()}, "' or '");
    return {offset, name.size(),
            fmt::format("'{}' is a column of sweep '{}' and has no single value here", name, sweeps),
            fmt::format("it has one inside a node with over=\"{}\", but not in the node's id",
                        *column->second.begin())};
  }
  const std::vector<const Element*> definitions = files_.definitions();
  if (const std::vector<std::string> names = circle(text, attribute, definitions); !names.empty()) {
    if (circular_.contains(names.front())) throw AlreadyReported();
    circular_.insert(names.begin(), names.end());
    std::string message = fmt::format("'{}' is defined by itself", names.front());
    if (names.size() > 2) message += ", in a circle: " + join(names, " -> ");
    return {offset, name.size(), message};
  }
  for (const Element* definition : definitions) {
    if (definition->get("name") != name) continue;
    return {
        offset, name.size(), fmt::format("'{}' has no value here", name),
        fmt::format("it is defined at {}:{}; a definition stands before its use, where its conditions hold",
                    definition->place.file->path, definition->place.line)};
  }
  std::string hint = suggestion(name, context.scope->names());
  if (!hint.starts_with("did you mean")) {
    hint += fmt::format("{}a text stands in single quotes: '{}'", hint.empty() ? "" : "; ", name);
  }
  return {offset, name.size(), fmt::format("there is no name '{}'", name), hint};
}

}  // namespace coppice::config
