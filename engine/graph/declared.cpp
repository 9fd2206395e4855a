#include "engine/graph/declared.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "registry/suggest.h"
#include "registry/text.h"

namespace coppice {
namespace {

constexpr std::size_t kLongestId = 100;

bool is_name(std::string_view text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto other = [](char c) { return (c >= '0' && c <= '9') || c == '-'; };
  return !text.empty() && letter(text.front()) &&
         std::all_of(text.begin(), text.end(), [&](char c) { return letter(c) || other(c); });
}

/// Reads the elements of an experiment one after the other into declared nodes.
class ElementReader {
 public:
  ElementReader(Declarations& declarations, Diagnostics& diagnostics)
      : declarations_(declarations), diagnostics_(diagnostics), kinds_(Catalogue::instance().names("node")) {}

  void read(const NodeElement& given) {
    const Element& element = given.element;
    const ComponentInfo* info = Catalogue::instance().find(Node::kInterface, element.name);
    if (info == nullptr) {
      diagnostics_.error(element.place, fmt::format("there is no node kind <{}>", element.name),
                         suggestion(element.name, kinds_));
      declarations_.of_unknown_kind.emplace(trim(element.get("id")));
      return;
    }
    DeclaredNode* node = node_of(given, *info);
    if (node == nullptr) return;
    DeclaredElement declared;
    declared.written = &element;
    declared.sweeps = given.sweeps;
    declared.point = given.point;
    Sub<Node> made = make<Node>(element, diagnostics_);
    declared.node = std::move(made.object);
    declared.sound = declared.node != nullptr;
    std::erase_if(made.resolved.attributes,
                  [](const Attribute& a) { return a.name == "over" || a.name == "at"; });
    declared.resolved = std::make_shared<const Element>(std::move(made.resolved));
    if (declared.sound && declared.node->definition())
      declared.sound = computes_nothing(*declared.node, element);
    node->elements.push_back(std::move(declared));
  }

 private:
  /// False, and reported, when a definition is given what only work can have.
  bool computes_nothing(const Node& node, const Element& element) {
    const std::array<std::pair<const char*, bool>, 5> given = {{{"replicates", node.replicates.has_value()},
                                                                {"seed_label", !node.seed_label.empty()},
                                                                {"time_limit", node.time_limit > 0},
                                                                {"memory_limit", node.memory_limit > 0},
                                                                {"threads", node.threads > 0}}};
    bool good = true;
    for (const auto& [name, is_given] : given) {
      if (!is_given) continue;
      diagnostics_.error(place_of(element.find(name), element),
                         fmt::format("<{}> has no {}: it computes nothing", element.name, name));
      good = false;
    }
    return good;
  }

  /// False, and reported, for what cannot be an id.
  bool is_good(const Attribute& id, const std::string& name, const Element& element) {
    if (id.failed) return false;  // reported
    if (!is_name(name)) {
      diagnostics_.error(place_of(&id, element), fmt::format("id=\"{}\" is no name", id.value),
                         "a name has letters, digits, '_' and '-', and starts with a letter or '_'");
      return false;
    }
    if (name.size() <= kLongestId) return true;
    diagnostics_.error(place_of(&id, element),
                       fmt::format("the id '{}...' has {} characters", name.substr(0, 20), name.size()),
                       fmt::format("files are named after it: at most {}", kLongestId));
    return false;
  }

  /// The declared node that the element belongs to; null after a mistake in its id.
  DeclaredNode* node_of(const NodeElement& given, const ComponentInfo& info) {
    const Element& element = given.element;
    const Attribute* id = element.find("id");
    const std::string name(trim(id == nullptr ? std::string_view() : std::string_view(id->value)));
    if (id != nullptr && !is_good(*id, name, element)) {
      make<Node>(element, diagnostics_);  // reports its other mistakes
      return nullptr;
    }
    if (id == nullptr) {  // reading the element reports it
      make<Node>(element, diagnostics_);
      return nullptr;
    }
    const auto [known, is_new] = by_id_.emplace(name, declarations_.nodes.size());
    if (is_new) declarations_.nodes.push_back({name, element.name, &info, {}});
    DeclaredNode& node = declarations_.nodes[known->second];
    if (is_new || is_another_point(node, given)) return &node;
    const Place& first = node.elements.empty() ? element.place : node.elements.front().written->place;
    diagnostics_.error(place_of(id, element), fmt::format("the id '{}' is already used", name), {},
                       first.file ? std::vector<std::string>{fmt::format("first used at {}:{}",
                                                                         first.file->path, first.line)}
                                  : std::vector<std::string>{});
    make<Node>(element, diagnostics_);
    return nullptr;
  }

  /// True when the element is a further sweep point of the node (in a flat file each has a place of its own).
  bool is_another_point(const DeclaredNode& node, const NodeElement& given) {
    if (node.elements.empty()) return true;
    const DeclaredElement& first = node.elements.front();
    if (node.kind != given.element.name || first.sweeps != given.sweeps || given.sweeps.empty()) return false;
    std::set<Point>& points = points_[node.id];
    if (points.empty()) points.insert(first.point);
    return points.insert(given.point).second;
  }

  Declarations& declarations_;
  Diagnostics& diagnostics_;
  std::vector<std::string> kinds_;
  std::map<std::string, std::size_t, std::less<>> by_id_;
  std::map<std::string, std::set<Point>> points_;
};

}  // namespace

Declarations declare(const ExperimentConfig& experiment, Diagnostics& diagnostics) {
  Declarations declarations;
  ElementReader reader(declarations, diagnostics);
  for (const LeftOut& part : experiment.left_out) {
    if (Catalogue::instance().find(Node::kInterface, part.kind) != nullptr)
      declarations.left_out.emplace(part.id, part.place);
  }
  for (const NodeElement& given : experiment.nodes) reader.read(given);
  resolve_references(declarations, diagnostics);
  return declarations;
}

}  // namespace coppice
