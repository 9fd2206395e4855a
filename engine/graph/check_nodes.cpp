#include "engine/graph/check_nodes.h"

#include <fmt/format.h>

#include <functional>
#include <map>
#include <set>

#include "engine/graph/key.h"
#include "engine/graph/planned_context.h"

namespace coppice {
namespace {

/// The attribute by which an element, or one inside it, names a file; null when none does.
const Attribute* attribute_naming(const Element& element, const std::string& path) {
  for (const Attribute& attribute : element.attributes) {
    if (attribute.value_place.file && path_of_file(attribute) == path) return &attribute;
  }
  for (const Element& child : element.children) {
    if (const Attribute* found = attribute_naming(child, path)) return found;
  }
  return nullptr;
}

class NodeChecker {
 public:
  NodeChecker(const Declarations& declarations, Plan& plan, Diagnostics& diagnostics)
      : plan_(plan), diagnostics_(diagnostics) {
    for (const DeclaredNode& node : declarations.nodes) {
      for (const DeclaredElement& element : node.elements) written_[element.resolved.get()] = element.written;
    }
  }

  void check(std::size_t index) {
    PlannedNode& node = plan_.nodes[index];
    const Element& written = *written_.at(node.resolved.get());
    const auto check = [&] {
      const PlannedContext context(plan_, index);
      node.node->check(context);
      node.columns = node.node->dataset_columns(context);
      node.progress_columns = node.node->progress_columns(context);
      node.spaces = node.node->spaces(context);
    };
    attempt(check, written, node.place);
  }

 private:
  /// Reports what `check` throws; what has no place of its own stands at `place`.
  void attempt(const std::function<void()>& check, const Element& written, const Place& place) {
    try {
      check();
    } catch (const ConfigError& error) {
      for (const Diagnostic& mistake : error.diagnostics()) report(mistake, written, place);
    } catch (const BrokenRules& broken) {
      for (const BrokenRule& rule : broken.all()) {
        const Attribute* given = written.find(rule.parameter);
        attempt([&] { std::rethrow_exception(rule.why); }, written,
                given != nullptr ? place_of(given, written) : place);
      }
    } catch (const std::invalid_argument& broken) {
      diagnostics_.error(place, fmt::format("<{}>: {}", written.name, broken.what()));
    } catch (const std::runtime_error& broken) {
      diagnostics_.error(place, fmt::format("<{}>: {}", written.name, broken.what()));
    }
  }

  /// A mistake in a file that the element names stands where it names it; one at a place in the file stays
  /// there. One in a whole file that an input names was found there: those are collected in `bad_files_`.
  void report(Diagnostic mistake, const Element& written, const Place& place) {
    const Attribute* naming =
        mistake.place.file ? attribute_naming(written, mistake.place.file->path) : nullptr;
    if (!mistake.place.file) {
      mistake.place = place;
    } else if (naming == nullptr && mistake.place.line == 0 &&
               bad_files_.contains(mistake.place.file->path)) {
      diagnostics_.already_reported();
      return;
    } else if (naming != nullptr && mistake.place.line == 0) {
      bad_files_.insert(mistake.place.file->path);
      mistake.message = fmt::format("{}: {}", naming->value, mistake.message);
      mistake.place = naming->value_place;
    } else if (naming != nullptr) {
      const Place& named = naming->value_place;
      mistake.notes.push_back(
          fmt::format("named by '{}' at {}:{}:{}", naming->name, named.file->path, named.line, named.column));
    }
    diagnostics_.error(mistake.place, std::move(mistake.message), std::move(mistake.hint),
                       std::move(mistake.notes));
  }

  std::map<const Element*, const Element*> written_;  // by the resolved one
  Plan& plan_;
  Diagnostics& diagnostics_;
  std::set<std::string> bad_files_;
};

}  // namespace

void check_nodes(const Declarations& declarations, Plan& plan, Diagnostics& diagnostics) {
  NodeChecker checker(declarations, plan, diagnostics);
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    // Replicates differ in nothing that a node could check.
    if (plan.nodes[i].replicate.value_or(0) == 0) checker.check(i);
  }
}

}  // namespace coppice
