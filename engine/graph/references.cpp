#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

#include "engine/graph/declared.h"
#include "registry/suggest.h"
#include "registry/text.h"

namespace coppice {
namespace {

/// Finds the nodes that reference parameters name.
class ReferenceReader {
 public:
  ReferenceReader(Declarations& declarations, Diagnostics& diagnostics)
      : declarations_(declarations), diagnostics_(diagnostics) {
    for (std::size_t i = 0; i < declarations.nodes.size(); ++i) by_id_[declarations.nodes[i].id] = i;
  }

  void read(const DeclaredNode& node, DeclaredElement& declared) {
    const Element& element = *declared.written;
    for (const ParameterInfo& parameter : node.info->parameters) {
      if (parameter.type != ValueType::reference && parameter.type != ValueType::references) continue;
      const Attribute* given = element.find(parameter.name);
      if (given == nullptr || given->failed) continue;
      DeclaredReference reference{&parameter, {}};
      std::set<std::string_view> seen;
      const std::vector<std::string_view> ids = split_list(given->value);
      if (parameter.type == ValueType::reference && ids.size() > 1) continue;  // reported
      for (const std::string_view id : ids) {
        if (id.empty()) continue;  // reported, as in all lists
        const Place place = place_of_item(*given, id, element);
        const auto target = by_id_.find(id);
        if (target == by_id_.end()) {
          if (!declarations_.of_unknown_kind.contains(id)) unknown(parameter, id, place);
          declared.sound = false;
        } else if (seen.insert(id).second) {  // reading the element reports what stands twice
          reference.targets.push_back({target->second, place});
        }
      }
      if (!reference.targets.empty()) declared.references.push_back(std::move(reference));
    }
  }

  /// A node must make what its readers need.
  void check_artifacts(DeclaredElement& declared) {
    for (const DeclaredReference& reference : declared.references) {
      const ParameterInfo& parameter = *reference.parameter;
      for (const DeclaredTarget& target : reference.targets) {
        if (parameter.artifact.empty() || makes(target.node, parameter.artifact)) continue;
        const DeclaredNode& read = declarations_.nodes[target.node];
        diagnostics_.error(target.place,
                           fmt::format("'{}' needs a node that makes {}, and '{}' (<{}>) makes none",
                                       parameter.name, with_article(parameter.artifact), read.id, read.kind),
                           suggestion("", makers(parameter.artifact)));
        declared.sound = false;
      }
    }
  }

 private:
  /// The place of one item of a list, where the text stands in the file as it is.
  static Place place_of_item(const Attribute& given, std::string_view item, const Element& element) {
    Place place = place_of(&given, element);
    if (item.size() == given.value.size()) return place;  // finding a line takes as long as the file is
    const auto offset = static_cast<std::size_t>(item.data() - given.value.data());
    const std::string_view line = place.file ? place.file->line(place.line) : std::string_view();
    const auto start = static_cast<std::size_t>(place.column) - 1 + offset;
    if (place.column > 0 && start < line.size() && line.substr(start, item.size()) == item) {
      place.column += static_cast<int>(offset);
      place.length = static_cast<int>(item.size());
    }
    return place;
  }

  bool makes(std::size_t node, const std::string& artifact) {
    const auto [known, is_new] = makes_.emplace(std::make_pair(node, artifact), true);
    if (!is_new) return known->second;
    for (const DeclaredElement& element : declarations_.nodes[node].elements) {
      if (!element.node) return known->second = true;  // broken: who knows
      const std::vector<std::string> made = element.node->makes();
      if (std::find(made.begin(), made.end(), artifact) == made.end()) return known->second = false;
    }
    return true;
  }

  std::vector<std::string> makers(const std::string& artifact) {
    std::vector<std::string> ids;
    for (std::size_t i = 0; i < declarations_.nodes.size(); ++i) {
      const std::vector<DeclaredElement>& elements = declarations_.nodes[i].elements;
      const bool broken = elements.empty() || std::any_of(elements.begin(), elements.end(),
                                                          [](const auto& element) { return !element.node; });
      if (!broken && makes(i, artifact)) ids.push_back(declarations_.nodes[i].id);
    }
    return ids;
  }

  void unknown(const ParameterInfo& parameter, std::string_view id, const Place& place) {
    if (const auto off = declarations_.left_out.find(id); off != declarations_.left_out.end()) {
      const Place& there = off->second;
      diagnostics_.error(place, fmt::format("'{}' names '{}', which is left out here", parameter.name, id),
                         {}, {fmt::format("by a condition, at {}:{}", there.file->path, there.line)});
      return;
    }
    std::vector<std::string> all;
    for (const DeclaredNode& node : declarations_.nodes) all.push_back(node.id);
    const std::vector<std::string> fitting = makers(parameter.artifact);
    const std::vector<std::string>& known =
        nearest(id, fitting).empty() && !nearest(id, all).empty() ? all : fitting;
    diagnostics_.error(place, fmt::format("'{}' names '{}', and no node has this id", parameter.name, id),
                       suggestion(id, known.empty() ? all : known));
  }

  Declarations& declarations_;
  Diagnostics& diagnostics_;
  std::map<std::string, std::size_t, std::less<>> by_id_;
  std::map<std::pair<std::size_t, std::string>, bool> makes_;
};

/// Depth-first, in document order; a node met again on its own path closes a cycle.
class Orderer {
 public:
  Orderer(Declarations& declarations, Diagnostics& diagnostics)
      : declarations_(declarations),
        diagnostics_(diagnostics),
        state_(declarations.nodes.size(), State::fresh) {}

  void order() {
    for (std::size_t i = 0; i < declarations_.nodes.size(); ++i) visit(i);
  }

 private:
  enum class State { fresh, on_path, done };

  void visit(std::size_t node) {
    if (state_[node] == State::done) return;
    state_[node] = State::on_path;
    path_.push_back(node);
    for (const DeclaredElement& element : declarations_.nodes[node].elements) {
      for (const DeclaredReference& reference : element.references) {
        for (const DeclaredTarget& target : reference.targets) {
          if (state_[target.node] == State::fresh) visit(target.node);
          if (state_[target.node] == State::on_path) report(target);
        }
      }
    }
    path_.pop_back();
    state_[node] = State::done;
    declarations_.order.push_back(node);
  }

  void report(const DeclaredTarget& target) {
    std::string cycle;
    for (auto i = std::find(path_.begin(), path_.end(), target.node); i != path_.end(); ++i) {
      cycle += "'" + declarations_.nodes[*i].id + "' needs ";
      for (DeclaredElement& element : declarations_.nodes[*i].elements) element.sound = false;
    }
    cycle += "'" + declarations_.nodes[target.node].id + "'";
    diagnostics_.error(target.place, "nodes need each other in a circle: " + cycle);
  }

  Declarations& declarations_;
  Diagnostics& diagnostics_;
  std::vector<State> state_;
  std::vector<std::size_t> path_;
};

}  // namespace

void resolve_references(Declarations& declarations, Diagnostics& diagnostics) {
  ReferenceReader reader(declarations, diagnostics);
  for (DeclaredNode& node : declarations.nodes) {
    for (DeclaredElement& element : node.elements) reader.read(node, element);
  }
  for (DeclaredNode& node : declarations.nodes) {
    for (DeclaredElement& element : node.elements) reader.check_artifacts(element);
  }
  Orderer(declarations, diagnostics).order();
}

}  // namespace coppice
