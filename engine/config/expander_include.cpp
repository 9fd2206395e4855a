#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/config/config_root.h"
#include "engine/config/control_check.h"
#include "engine/config/expander.h"
#include "registry/suggest.h"
#include "registry/text.h"

namespace coppice::config {

void Expander::include(const Element& element, const Context& context, Element* parent) {
  const Element plain = copy(element, context);  // with its <arg>s and their conditions worked out
  const ControlElement& declaration = *find_control("include", "");
  const LoadedFile* file = nullptr;
  if (check_control(plain, declaration, nullptr, diagnostics_)) file = included_file(plain, context);
  PassedArguments passed;
  for (const Element& child : plain.children) {
    if (child.name != "arg" || !check_control(child, *find_control("arg", "include"), nullptr, diagnostics_))
      continue;
    const Attribute& name = *child.find("name");
    passed.names.emplace(name.value, name.value_place);
    if (!passed.values.emplace(name.value, *child.find("value")).second) {
      diagnostics_.error(name.value_place, fmt::format("'{}' is passed a second time", name.value));
    }
  }
  if (file == nullptr) return leave_out(parent);
  passed.outer = context.passed;
  Context inner = context;
  inner.passed = &passed;
  inner.depth = context.depth + 1;
  inner.trace = std::make_shared<const TraceFrame>(
      TraceFrame{"included from", element.place.file, element.place.line, context.trace});
  check_depth(element, context);
  check_included_root(*file, inner.trace);
  active_.push_back(file);
  const bool complete_before = std::exchange(result_.complete, true);
  children(file->root, inner, parent);
  active_.pop_back();
  if (result_.complete) check_passed(passed, file->source->path);
  result_.complete = result_.complete && complete_before;
}

/// Null after a mistake.
const LoadedFile* Expander::included_file(const Element& plain, const Context& context) {
  const Attribute& attribute = *plain.find("file");
  if (attribute.failed) return nullptr;
  if (trim(attribute.value).empty()) {
    diagnostics_.error(attribute.value_place, "'file' names no file",
                       "the path of a config, relative to this one");
    return nullptr;
  }
  const std::string including = attribute.value_place.file ? attribute.value_place.file->path : "";
  const std::string path = path_beside(including, attribute.value);
  const auto report = [&](const Diagnostic& mistake) {
    if (mistake.place.line > 0) {  // inside the file
      Place place = mistake.place;
      place.trace = std::make_shared<const TraceFrame>(
          TraceFrame{"included from", plain.place.file, plain.place.line, context.trace});
      diagnostics_.error(place, mistake.message, mistake.hint, mistake.notes);
    } else {
      diagnostics_.error(attribute.value_place, fmt::format("{}: {}", path, mistake.message), mistake.hint);
    }
  };
  try {
    const LoadedFile& file = files_.load(path);
    for (const Diagnostic& mistake : file.mistakes) report(mistake);
    return in_circle(file, attribute) ? nullptr : &file;
  } catch (const ConfigError& failure) {
    for (const Diagnostic& mistake : failure.diagnostics()) report(mistake);
  }
  return nullptr;
}

bool Expander::in_circle(const LoadedFile& file, const Attribute& attribute) {
  const auto first = std::find(active_.begin(), active_.end(), &file);
  if (first == active_.end()) return false;
  std::vector<std::string> chain;
  for (auto step = first; step != active_.end(); ++step) chain.push_back((*step)->source->path);
  chain.push_back(file.source->path);
  diagnostics_.error(attribute.value_place,
                     fmt::format("files include each other in a circle: {}", join(chain, " -> ")));
  return true;
}

/// An included file may be an experiment of its own: its name and doc are then without effect. A seed of its
/// own would silently change what it makes when run alone, so it must be the same.
void Expander::check_included_root(const LoadedFile& file, const std::shared_ptr<const TraceFrame>& trace) {
  const RootAttributes included = read_root(file, files_, trace, diagnostics_);
  const Attribute* seed = file.root.find("seed");
  if (seed == nullptr || !included.seed || included.seed == root_seed_) return;
  Place place = seed->value_place;
  place.trace = trace;
  diagnostics_.error(
      place,
      fmt::format("an included file has the seed {}, but the experiment has {}", *included.seed, root_seed_),
      "leave out the seed, or make it the same");
}

/// Every argument passed must have been declared.
void Expander::check_passed(const PassedArguments& passed, const std::string& file) {
  for (const auto& [name, place] : passed.names) {
    if (passed.taken.contains(name)) continue;
    const std::string hint = passed.declared.empty() ? "it declares none" : suggestion(name, passed.declared);
    diagnostics_.error(place, fmt::format("{} declares no argument '{}'", file, name), hint);
  }
}

}  // namespace coppice::config
