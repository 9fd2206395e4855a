#include "engine/config/expander.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/config/control_check.h"
#include "registry/suggest.h"

namespace coppice::config {
namespace {

constexpr std::size_t kMostElements = 2'000'000;

bool is_control(std::string_view name) {
  static constexpr auto kNames =
      std::to_array<std::string_view>({"arg", "let", "macro", "sweep", "include", "call", "insert", "group"});
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

}  // namespace

Expander::Origin::Origin(const Element& met, const Context& context) : element(&met) {
  for (const Way* step = context.way.get(); step != nullptr; step = step->outer.get())
    way.push_back(step->through);
}

Expander::Expander(Files& files, GivenArguments& given, std::uint64_t root_seed, std::uint64_t seed,
                   Diagnostics& diagnostics)
    : files_(files),
      given_(given),
      root_seed_(root_seed),
      seed_(seed),
      diagnostics_(diagnostics),
      evaluator_(files, diagnostics),
      global_(std::make_shared<Scope>()) {}

Expansion Expander::run(const LoadedFile& file) {
  active_.push_back(&file);
  Context context;
  context.scope = global_;
  try {
    children(file.root, context, nullptr);
  } catch (const Endless&) {
    result_.complete = false;
  }
  finish_unused(file);
  for (const DefinedSweep* sweep : sweep_order_) result_.sweeps.push_back(sweep->points);
  return std::move(result_);
}

void Expander::children(const Element& element, const Context& context, Element* parent) {
  for (const Element& child : element.children) this->element(child, context, parent);
}

void Expander::element(const Element& element, const Context& context, Element* parent) {
  count(element, context);
  // The conditions of a node over sweeps may depend on their columns: they are worked out at each point.
  const bool over_sweeps = parent == nullptr && !is_control(element.name) && element.find("over") != nullptr;
  if (!over_sweeps && !wanted(element, context)) return skip(element, context, parent);
  if (parent != nullptr && parent == sweep_ && element.name == "exclude") {
    exclusions_->push_back({&element, context});  // its condition is worked out at each point
    return;
  }
  if (control(element, context, parent)) return;
  if (parent == nullptr) {
    node(element, context);
  } else {
    parent->children.push_back(copy(element, context));
  }
}

bool Expander::control(const Element& element, const Context& context, Element* parent) {
  const std::string& name = element.name;
  const bool passes_value = name == "arg" && parent != nullptr && parent->name == "include";
  if (passes_value || !is_control(name)) return false;
  if (name == "arg")
    argument(element, context);
  else if (name == "let")
    let(element, context);
  else if (name == "macro")
    macro(element, context);
  else if (name == "sweep")
    sweep(element, context);
  else if (name == "include")
    include(element, context, parent);
  else if (name == "call")
    call(element, context, parent);
  else if (name == "insert")
    insert(element, context, parent);
  else if (check(element, "", context))
    children(element, context, parent);
  return true;
}

/// Whether the conditions of the element hold. Where they cannot be worked out the element stays, so that
/// later checks see it.
bool Expander::wanted(const Element& element, const Context& context) {
  const Attribute* required = element.find("if");
  const Attribute* refused = element.find("unless");
  return (required == nullptr || condition(*required, context, true)) &&
         (refused == nullptr || !condition(*refused, context, false));
}

bool Expander::condition(const Attribute& attribute, const Context& context, bool otherwise) {
  const std::optional<Value> value = evaluator_.value(attribute, context);
  if (value && value->as_boolean() != nullptr) return *value->as_boolean();
  if (value) {
    evaluator_.error(attribute, context, 0, attribute.value.size(),
                     fmt::format("'{}' must be true or false, not {}", attribute.name, value->description()),
                     "such as ${a == 1}");
  }
  result_.complete = false;
  return otherwise;
}

Element Expander::copy(const Element& element, const Context& context) {
  Element made;
  made.name = element.name;
  made.place = traced(element.place, context);
  made.attributes.reserve(element.attributes.size());
  for (const Attribute& attribute : element.attributes) {
    if (!is_control_attribute(attribute.name))
      made.attributes.push_back(evaluator_.attribute(attribute, context));
  }
  made.children.reserve(element.children.size());
  children(element, context, &made);
  return made;
}

void Expander::count(const Element& element, const Context& context) {
  if (++elements_ <= kMostElements) return;
  error(element.place, context, fmt::format("the config expands to more than {} elements", kMostElements));
  throw Endless();
}

void Expander::check_depth(const Element& element, const Context& context) {
  constexpr int kDeepest = 50;
  if (context.depth < kDeepest) return;
  std::vector<std::string> called;
  for (const MacroFrame* frame = context.macro.get(); frame != nullptr; frame = frame->caller.macro.get()) {
    if (called.size() == 3) break;
    called.push_back(fmt::format("in macro '{}'", frame->macro));
  }
  // The trace would be as long as the calls are deep.
  diagnostics_.error(element.place, fmt::format("macros call each other more than {} levels deep", kDeepest),
                     "a macro that calls itself needs an if= that ends it", called);
  throw TooDeep();
}

bool Expander::check(const Element& element, std::string_view parent, const Context& context) {
  const ControlElement* declaration = find_control(element.name, parent);
  return check_control(element, *declaration, context.trace, diagnostics_);
}

bool Expander::global_only(const Element& element, const Context& context) {
  if (!context.inside && context.macro == nullptr) return true;
  error(element.place, context,
        fmt::format("<{}> does not belong inside {}", element.name,
                    context.inside ? "another element" : "a macro"),
        fmt::format("<{}> stands at the top level of a file", element.name));
  return false;
}

void Expander::error(const Place& place, const Context& context, std::string message, std::string hint,
                     std::vector<std::string> notes) {
  diagnostics_.error(traced(place, context), std::move(message), std::move(hint), std::move(notes));
}

void Expander::skip(const Element& element, const Context& context, const Element* parent) {
  if (parent == nullptr) note_left_out(element, context);
  keep_unused(element, context, parent == nullptr ? "" : parent->name);
}

void Expander::note_left_out(const Element& element, const Context& context) {
  if (element.name == "group") {
    for (const Element& child : element.children) note_left_out(child, context);
  } else if (const Attribute* id = element.find("id")) {
    result_.left_out.push_back({element.name, quiet_text(*id, context), element.place});
  }
}

/// The attribute's value; empty, and nothing is said, where it cannot be worked out.
std::string Expander::quiet_text(const Attribute& attribute, const Context& context) const {
  Diagnostics ignored;
  return Evaluator(files_, ignored).text(attribute, context).value_or("");
}

void Expander::keep_unused(const Element& element, const Context& context, std::string parent) {
  if (!unused_.insert(&element).second) return;
  UnusedPart part;
  part.element = element;
  part.element.place = traced(element.place, context);
  part.parent = std::move(parent);
  part.names = context.scope->names();
  result_.unused.push_back(std::move(part));
}

/// Adds the macros that nothing called, and the names that what is left out can use. Only those in the config
/// itself are all known: what others include may be meant for names that others have.
void Expander::finish_unused(const LoadedFile& file) {
  for (const auto& [name, macro] : macros_) {
    Context context;
    context.scope = global_;
    context.trace = macro->place.trace;
    if (!called_.contains(macro.get())) keep_unused(*macro->element, context, "");
  }
  if (result_.unused.empty()) return;
  const std::optional<std::vector<std::string>> names = files_.every_name();
  for (UnusedPart& part : result_.unused) {
    part.names_known = names && result_.complete && part.element.place.file == file.source;
    if (part.names_known) part.names.insert(part.names.end(), names->begin(), names->end());
  }
}

void Expander::leave_out(Element* parent) {
  result_.complete = false;
  if (parent != nullptr) parent->failed = true;
}

}  // namespace coppice::config
