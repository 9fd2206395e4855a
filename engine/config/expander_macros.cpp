#include <fmt/format.h>

#include <algorithm>

#include "engine/config/attribute_place.h"
#include "engine/config/control_check.h"
#include "engine/config/expander.h"
#include "registry/suggest.h"
#include "registry/text.h"

namespace coppice::config {
namespace {

/// The frames of `inner` with `outer` behind them.
std::shared_ptr<const TraceFrame> joined(const std::shared_ptr<const TraceFrame>& inner,
                                         std::shared_ptr<const TraceFrame> outer) {
  if (!inner) return outer;
  TraceFrame frame = *inner;
  frame.outer = joined(inner->outer, std::move(outer));
  return std::make_shared<const TraceFrame>(std::move(frame));
}

std::string with_blanks_as_commas(const std::string& text) {
  std::string fixed;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool gap = text[i] == ' ' && i > 0 && text[i - 1] != ',' && text[i - 1] != ' ';
    fixed += gap ? ", " : text.substr(i, 1);
  }
  return fixed;
}

}  // namespace

void Expander::macro(const Element& element, const Context& context) {
  if (!global_only(element, context) || !check(element, "", context)) return;
  const Attribute& name = *element.find("name");
  const Place place = traced(name.value_place, context);
  if (!check_name(name.value, place, diagnostics_)) return;
  auto made = std::make_unique<Macro>();
  made->name = name.value;
  made->element = &element;
  made->place = place;
  if (const Attribute* params = element.find("params")) made->parameters = parameters(*params, context);
  const auto [before, added] = macros_.try_emplace(name.value, std::move(made));
  if (added || before->second->element == &element) return;
  const Place& first = before->second->place;
  diagnostics_.error(place, fmt::format("the macro '{}' is defined a second time", name.value),
                     fmt::format("it was defined at {}:{}:{}", first.file->path, first.line, first.column));
}

/// "a, b:=1, *c"; the text is not worked out here: defaults are, at each call.
std::vector<Expander::MacroParameter> Expander::parameters(const Attribute& params, const Context& context) {
  std::vector<MacroParameter> all;
  const std::vector<std::string> items = split_items(params.value);
  const std::vector<std::size_t> offsets = item_offsets(params.value);
  for (std::size_t i = 0; i < items.size(); ++i) {
    MacroParameter parameter;
    const std::size_t assign = items[i].find(":=");
    parameter.block = items[i].starts_with('*');
    parameter.name = trim(items[i].substr(0, assign)).substr(parameter.block ? 1 : 0);
    const Place place =
        traced(place_in(params, offsets[i], parameter.name.size() + (parameter.block ? 1 : 0)), context);
    if (parameter.name.find(' ') != std::string::npos) {
      diagnostics_.error(place, "the parameters of a macro are separated by commas",
                         fmt::format("params=\"{}\"", with_blanks_as_commas(params.value)));
      continue;
    }
    if (parameter.name == "macro") {
      diagnostics_.error(place, "'macro' cannot be a parameter",
                         "<call macro=\"...\"> names the macro by it");
      continue;
    }
    if (!check_name(parameter.name, place, diagnostics_)) continue;
    const bool twice = std::any_of(all.begin(), all.end(),
                                   [&](const MacroParameter& other) { return other.name == parameter.name; });
    if (twice) diagnostics_.error(place, fmt::format("the parameter '{}' is there already", parameter.name));
    if (assign != std::string::npos && parameter.block) {
      diagnostics_.error(place, fmt::format("the block '*{}' cannot have a default", parameter.name));
    } else if (assign != std::string::npos) {
      const std::vector<std::string> value = split_items(items[i].substr(assign + 2));  // takes off quotes
      parameter.has_default = true;
      parameter.default_value = {parameter.name,
                                 value.size() == 1 ? value.front() : items[i].substr(assign + 2), place,
                                 place_in(params, offsets[i] + assign + 2, items[i].size() - assign - 2)};
    }
    all.push_back(std::move(parameter));
  }
  return all;
}

void Expander::call(const Element& element, const Context& context, Element* parent) {
  const Macro* macro = check(element, "", context) ? find_macro(element, context) : nullptr;
  if (macro == nullptr) return leave_out(parent);
  called_.insert(macro);
  const std::size_t files = active_.size();
  const Element* const sweep = sweep_;
  std::vector<Exclusion>* const exclusions = exclusions_;
  try {
    expand_call(*macro, element, context, parent);
  } catch (const TooDeep&) {
    if (context.macro != nullptr) throw;  // the call outside of all macros ends, what follows it goes on
    active_.resize(files);
    sweep_ = sweep;
    exclusions_ = exclusions;
    leave_out(parent);
  }
}

void Expander::expand_call(const Macro& macro, const Element& element, const Context& context,
                           Element* parent) {
  check_depth(element, context);
  auto frame = std::make_shared<MacroFrame>();
  frame->macro = macro.name;
  frame->caller = context;
  pass_blocks(macro, element, context, *frame);
  Context body = body_context(macro, element, context);
  pass_values(macro, element, context, body);
  body.macro = std::move(frame);
  children(*macro.element, body, parent);
}

const Expander::Macro* Expander::find_macro(const Element& element, const Context& context) {
  const Attribute& attribute = *element.find("macro");
  const std::optional<std::string> name = evaluator_.text(attribute, context);
  if (!name) return nullptr;
  if (const auto found = macros_.find(*name); found != macros_.end()) return found->second.get();
  std::vector<std::string> known;
  for (const auto& [other, macro] : macros_) known.push_back(other);
  evaluator_.error(attribute, context, 0, attribute.value.size(),
                   fmt::format("there is no macro '{}'", *name),
                   known.empty() ? "no macro is defined before this call" : suggestion(*name, known));
  return nullptr;
}

/// The body sees its parameters, what the experiment defines, and the columns of the node that it stands in;
/// not the definitions around the call.
Context Expander::body_context(const Macro& macro, const Element& call, const Context& context) {
  std::shared_ptr<const Scope> outer = global_;
  if (context.columns != nullptr) outer = std::make_shared<const Scope>(global_, context.columns);
  Context body = context;
  body.scope = std::make_shared<Scope>(std::move(outer));
  body.depth = context.depth + 1;
  body.way = std::make_shared<const Way>(Way{&call, context.way});
  std::shared_ptr<const TraceFrame> called = std::make_shared<const TraceFrame>(TraceFrame{
      fmt::format("in macro '{}' called at", macro.name), call.place.file, call.place.line, context.trace});
  // How expansion came to the macro's definition, unless the call came the same way.
  body.trace = macro.place.trace == context.trace ? called : joined(macro.place.trace, called);
  return body;
}

void Expander::pass_values(const Macro& macro, const Element& call, const Context& context,
                           const Context& body) {
  std::vector<std::string> names;
  for (const MacroParameter& parameter : macro.parameters) {
    if (parameter.block) continue;
    names.push_back(parameter.name);
    std::optional<Value> value;
    const Attribute* given = call.find(parameter.name);
    if (given != nullptr) {
      value = evaluator_.value(*given, context);
    } else if (parameter.has_default) {
      value = evaluator_.value(parameter.default_value, body);
    } else {
      error(call.place, context,
            fmt::format("the macro '{}' needs the argument '{}'", macro.name, parameter.name),
            fmt::format("its parameters: {}", macro.element->get("params")));
    }
    body.scope->define(parameter.name, {value.value_or(Value::boolean(false)),
                                        given != nullptr ? given->value_place : call.place,
                                        fmt::format("parameter of macro '{}'", macro.name), !value});
  }
  for (const Attribute& attribute : call.attributes) {
    const bool known = attribute.name == "macro" || is_control_attribute(attribute.name) ||
                       std::find(names.begin(), names.end(), attribute.name) != names.end();
    if (known) continue;
    error(attribute.name_place, context,
          fmt::format("the macro '{}' has no parameter '{}'", macro.name, attribute.name),
          names.empty() ? "it has none" : suggestion(attribute.name, names));
  }
}

/// A single block takes the whole content of the call; several take one element each, in order.
void Expander::pass_blocks(const Macro& macro, const Element& call, const Context& context,
                           MacroFrame& frame) {
  std::vector<std::string> blocks;
  for (const MacroParameter& parameter : macro.parameters) {
    if (parameter.block) blocks.push_back(parameter.name);
  }
  for (std::size_t i = 0; i < call.children.size() && !blocks.empty(); ++i) {
    const std::size_t block = blocks.size() == 1 ? 0 : std::min(i, blocks.size() - 1);
    frame.blocks[blocks[block]].push_back(&call.children[i]);
  }
  const bool fits = blocks.size() == 1 ? !call.children.empty() : call.children.size() == blocks.size();
  if (fits) return;
  for (const std::string& block : blocks) frame.blocks[block];  // so that <insert> finds it
  error(call.place, context,
        fmt::format("the macro '{}' takes {}, but the call has {}", macro.name,
                    blocks.empty()       ? "no content"
                    : blocks.size() == 1 ? fmt::format("the block '{}' as content", blocks.front())
                                         : fmt::format("{} elements ({})", blocks.size(), join(blocks)),
                    call.children.empty() ? "none" : fmt::format("{}", call.children.size())));
  result_.complete = false;
}

void Expander::insert(const Element& element, const Context& context, Element* parent) {
  if (!check(element, "", context)) return leave_out(parent);
  const Attribute& block = *element.find("block");
  if (context.macro == nullptr) {
    error(element.place, context, "<insert> has a meaning only inside a macro");
    return leave_out(parent);
  }
  const MacroFrame& frame = *context.macro;
  const auto found = frame.blocks.find(block.value);
  if (found == frame.blocks.end()) {
    std::vector<std::string> known;
    for (const auto& [name, elements] : frame.blocks) known.push_back(name);
    evaluator_.error(block, context, 0, block.value.size(),
                     fmt::format("the macro '{}' has no block '{}'", frame.macro, block.value),
                     known.empty() ? fmt::format("params=\"*{}\" would declare it", block.value)
                                   : suggestion(block.value, known));
    return leave_out(parent);
  }
  // The block means what it means where the call stands, and sees the columns of the node that it is put
  // into.
  Context inner = frame.caller;
  if (context.inside) inner.scope = std::make_shared<Scope>(frame.caller.scope, context.columns);
  inner.columns = context.columns;
  inner.inside = context.inside;
  inner.names_unknown = context.names_unknown || frame.caller.names_unknown;
  inner.depth = context.depth + 1;
  inner.way = std::make_shared<const Way>(Way{&element, context.way});
  check_depth(element, context);
  for (const Element* child : found->second) this->element(*child, inner, parent);
}

}  // namespace coppice::config
