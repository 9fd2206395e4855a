#include "engine/graph/planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "engine/data/file_system.h"
#include "engine/graph/labelled.h"
#include "registry/text.h"
#include "registry/units.h"

namespace coppice {

/// What an element becomes besides its own: at which point, for which item of its fan-out, which replicate.
struct Planner::Variant {
  Standing standing;
  int replicates = 0;
  std::string item;
  const DeclaredReference* fan_out = nullptr;
  std::size_t target = 0;  ///< planned node that `fan_out` leads to
};

namespace {

constexpr std::size_t kMostNodes = 1'000'000;

Standing standing_of(const PlannedNode& node) {
  return {node.sweeps, node.point, node.replicate};
}

/// "variant=HA,gamma=0.9"
std::string point_text(const Point& point) {
  std::string text;
  for (const auto& [column, value] : point) text += (text.empty() ? "" : ",") + column + "=" + value;
  return text;
}

/// The point's name as a folder; different points get different names.
std::string point_folder(const Point& point) {
  std::string text;
  for (const auto& [column, value] : point)
    text += (text.empty() ? "" : ",") + column + "=" + safe_name(value);
  return short_name(text);
}

void name_node(PlannedNode& node) {
  node.name = node.id;
  node.folder = "nodes/" + node.id;
  const auto add = [&](const std::string& part, const std::string& folder) {
    node.name += " " + part;
    node.folder += "/" + folder;
  };
  if (!node.point.empty()) add(point_text(node.point), point_folder(node.point));
  if (!node.item.empty()) add(node.item, safe_name(node.item));
  if (node.replicate) {
    const std::string replicate = fmt::format("r{:03}", *node.replicate);
    add(replicate, replicate);
  }
}

bool makes(const PlannedNode& node, std::string_view artifact) {
  const std::vector<std::string> made = node.node->makes();
  return std::find(made.begin(), made.end(), artifact) != made.end();
}

/// The SI units of the columns whose values are all quantities of one kind.
std::map<std::string, std::string> units_of(const SweepPoints& sweep) {
  std::map<std::string, std::string> units;
  for (std::size_t i = 0; i < sweep.columns.size() && !sweep.points.empty(); ++i) {
    const std::optional<Quantity> first = parse_quantity(sweep.points.front()[i].second);
    if (!first || first->dimension == Dimension{}) continue;
    const auto like_first = [&](const Point& point) {
      const std::optional<Quantity> value = parse_quantity(point[i].second);
      return value && value->dimension == first->dimension && std::isfinite(value->value);
    };
    if (std::all_of(sweep.points.begin(), sweep.points.end(), like_first))
      units[sweep.columns[i]] = unit_text(first->dimension);
  }
  return units;
}

/// Sweep columns, quantities as numbers in SI units; then the ids of the problem, the objective and the
/// policy that it makes or reads.
void label_node(PlannedNode& node, const Plan& plan) {
  node.labels = node.point;
  for (auto& [column, value] : node.labels) {
    if (node.units.contains(column)) value = number_text(parse_quantity(value)->value);
  }
  for (const char* artifact : {"problem", "objective", "policy"}) {
    if (makes(node, artifact)) {
      node.labels.emplace_back(artifact, node.id);
      continue;
    }
    for (const PlannedInput& input : node.inputs) {
      if (input.artifact != artifact || input.nodes.size() != 1) continue;
      const PlannedNode& read = plan.nodes[input.nodes.front()];
      node.labels.emplace_back(artifact, node.item.empty() || !input.fans_out ? read.id : node.item);
      break;
    }
  }
}

/// How the rows of its input table name what they stand for.
void label_rows(PlannedNode& node, const Plan& plan) {
  const std::optional<InputTable> table = node.node->input_table();
  for (const PlannedInput& input : node.inputs) {
    if (!table || input.parameter != table->parameter) continue;
    for (const std::size_t i : input.nodes) node.row_labels.push_back(labels_of(plan.nodes[i]));
  }
}

/// Its own stream of draws, then those of what it reads.
void collect_streams(PlannedNode& node, const Plan& plan) {
  if (!node.definition && node.node->random()) {
    const std::string& label = node.node->seed_label.empty() ? node.kind : node.node->seed_label;
    node.streams.push_back(fmt::format("{} {}", label, node.replicate.value_or(0)));
  }
  std::set<std::string> seen(node.streams.begin(), node.streams.end());
  for (const PlannedInput& input : node.inputs) {
    for (const std::size_t i : input.nodes) {
      for (const std::string& stream : plan.nodes[i].streams) {
        if (seen.insert(stream).second) node.streams.push_back(stream);
      }
    }
  }
}

/// The node itself when it learns, or takes one of several learned policies; else that of the policy it
/// reads.
std::optional<std::size_t> training_of(const PlannedNode& node, const Plan& plan) {
  const std::size_t self = plan.nodes.size();
  if (node.node->learns()) return self;
  for (const PlannedInput& input : node.inputs) {
    if (input.artifact != "policy") continue;
    for (const std::size_t i : input.nodes) {
      if (plan.nodes[i].training) return makes(node, "policy") ? self : plan.nodes[i].training;
    }
  }
  return std::nullopt;
}

}  // namespace

Planner::Planner(Declarations& declarations, Plan& plan, Diagnostics& diagnostics)
    : declarations_(declarations), plan_(plan), diagnostics_(diagnostics), index_(plan.experiment.sweeps) {
  for (const SweepPoints& sweep : plan.experiment.sweeps) units_[sweep.id] = units_of(sweep);
}

void Planner::make_nodes() {
  for (const std::size_t declared : declarations_.order) {
    for (DeclaredElement& element : declarations_.nodes[declared].elements) {
      if (element.sound) expand(declared, element);
    }
  }
}

void Planner::expand(std::size_t declared, DeclaredElement& element) {
  for (const Variant& variant : variants(element)) {
    const int count = variant.replicates;
    if (count == 0 || variant.standing.replicate) {
      add(declared, element, variant);
      continue;
    }
    if (plan_.nodes.size() + static_cast<std::size_t>(count) > kMostNodes) {
      diagnostics_.error(place_of(element.written->find("replicates"), *element.written),
                         fmt::format("the experiment has more than {} nodes", kMostNodes));
      element.sound = false;
      return;
    }
    Variant replicate = variant;
    for (int r = 0; r < count; ++r) {
      replicate.standing.replicate = r;
      if (!add(declared, element, replicate)) break;  // the others have the same mistake
    }
  }
}

std::vector<Planner::Variant> Planner::variants(DeclaredElement& element) {
  Variant own;
  own.standing = {element.sweeps, element.point, std::nullopt};
  own.replicates = element.node->replicates.value_or(0);
  for (const DeclaredReference& reference : element.references) {
    if (!reference.parameter->fan_out) continue;
    std::vector<Variant> result;
    own.fan_out = &reference;
    result.push_back(own);
    return fan_out(element, reference, result) ? result : std::vector<Variant>();
  }
  return {own};
}

/// Replaces the only variant by one for each node that the reference leads to, with its sweeps and
/// replicates.
bool Planner::fan_out(DeclaredElement& element, const DeclaredReference& reference,
                      std::vector<Variant>& variants) {
  const Variant own = variants.front();
  variants.clear();
  for (const DeclaredTarget& target : reference.targets) {
    const std::vector<std::size_t> found = index_.find(target.node, own.standing);
    if (found.empty()) {
      PlannedNode reader;
      reader.point = element.point;
      element.sound = false;
      return check_match(element, reference, target, reader, found);
    }
    for (const std::size_t i : found) {
      const PlannedNode& read = plan_.nodes[i];
      Variant variant = own;
      for (const std::string& sweep : read.sweeps) {
        std::vector<std::string>& sweeps = variant.standing.sweeps;
        if (std::find(sweeps.begin(), sweeps.end(), sweep) == sweeps.end()) sweeps.push_back(sweep);
      }
      for (const PointValue& value : read.point) {
        if (value_of(variant.standing.point, value.first) == nullptr) variant.standing.point.push_back(value);
      }
      variant.item = read.item.empty() ? read.id : read.id + "." + read.item;
      variant.target = i;
      if (read.replicates > 0) {
        if (own.replicates > 0 && own.replicates != read.replicates) {
          diagnostics_.error(place_of(element.written->find("replicates"), *element.written),
                             fmt::format("'{}' has {} replicates and cannot be joined one to one with {}",
                                         read.id, read.replicates, own.replicates),
                             "leave replicates out to take over those of '" + read.id + "'");
          element.sound = false;
          return false;
        }
        variant.replicates = read.replicates;
        variant.standing.replicate = read.replicate;
      }
      variants.push_back(std::move(variant));
    }
  }
  return true;
}

bool Planner::add(std::size_t declared, DeclaredElement& element, const Variant& variant) {
  const DeclaredNode& origin = declarations_.nodes[declared];
  PlannedNode node;
  node.id = origin.id;
  node.kind = origin.kind;
  node.sweeps = variant.standing.sweeps;
  node.point = variant.standing.point;
  node.item = variant.item;
  node.replicate = variant.standing.replicate;
  node.replicates = variant.replicates;
  node.definition = element.node->definition();
  node.place = element.written->place;
  node.node = element.node;
  node.resolved = element.resolved;
  for (const DeclaredReference& reference : element.references) {
    if (&reference == variant.fan_out) {
      node.inputs.push_back(
          {reference.parameter->name, reference.parameter->artifact, true, {variant.target}});
    } else if (!join(element, reference, node)) {
      element.sound = false;
      return false;
    }
  }
  name_node(node);
  for (const std::string& sweep : node.sweeps) node.units.insert(units_[sweep].begin(), units_[sweep].end());
  label_node(node, plan_);
  label_rows(node, plan_);
  collect_streams(node, plan_);
  node.training = training_of(node, plan_);
  index_.add(declared, plan_.nodes.size(), standing_of(node));
  plan_.nodes.push_back(std::move(node));
  return true;
}

bool Planner::join(const DeclaredElement& element, const DeclaredReference& reference, PlannedNode& node) {
  PlannedInput input{reference.parameter->name, reference.parameter->artifact, false, {}};
  const Standing standing = standing_of(node);
  for (const DeclaredTarget& target : reference.targets) {
    const std::vector<std::size_t> found = index_.find(target.node, standing);
    if (!check_match(element, reference, target, node, found)) return false;
    input.nodes.insert(input.nodes.end(), found.begin(), found.end());
  }
  node.inputs.push_back(std::move(input));
  return true;
}

/// What to write so that the element runs over further sweeps.
std::string Planner::over_hint(const DeclaredElement& element,
                               const std::vector<std::string>& missing) const {
  std::vector<std::string> over;
  for (const SweepPoints& sweep : plan_.experiment.sweeps) {
    const bool has =
        std::find(element.sweeps.begin(), element.sweeps.end(), sweep.id) != element.sweeps.end();
    if (has && !sweep.from_command_line) over.push_back(sweep.id);
  }
  const bool none = over.empty();
  over.insert(over.end(), missing.begin(), missing.end());
  return fmt::format("{} over=\"{}\" {} this node", none ? "add" : "write", coppice::join(over),
                     none ? "to" : "for");
}

bool Planner::check_match(const DeclaredElement& element, const DeclaredReference& reference,
                          const DeclaredTarget& target, const PlannedNode& reader,
                          const std::vector<std::size_t>& found) {
  const DeclaredNode& read = declarations_.nodes[target.node];
  const std::string& parameter = reference.parameter->name;
  if (found.empty()) {
    const auto broken = [](const DeclaredElement& e) { return !e.sound; };
    const bool reported =
        index_.empty(target.node) || std::any_of(read.elements.begin(), read.elements.end(), broken);
    if (!reported) {
      diagnostics_.error(target.place, fmt::format("'{}' names '{}', which has no node at {}", parameter,
                                                   read.id, point_text(reader.point)));
    }
    return false;
  }
  const PlannedNode& first = plan_.nodes[found.front()];
  if (reader.replicates > 0 && first.replicates > 0 && reader.replicates != first.replicates) {
    diagnostics_.error(
        target.place,
        fmt::format("'{}' has {} replicates and cannot be joined one to one with the {} of this node",
                    read.id, first.replicates, reader.replicates),
        "give both the same number, or one of them none");
    return false;
  }
  if (found.size() == 1 || element.node->gathers(parameter)) return true;
  std::vector<std::string> missing;
  std::copy_if(first.sweeps.begin(), first.sweeps.end(), std::back_inserter(missing),
               [&](const std::string& sweep) {
                 return std::find(reader.sweeps.begin(), reader.sweeps.end(), sweep) == reader.sweeps.end();
               });
  const bool replicates = element.node->gathers_replicates(parameter);
  if (missing.empty() && replicates) return true;
  const std::string what =
      fmt::format("'{}' takes {}, and '{}' stands for {}", parameter,
                  replicates ? "a node at one sweep point" : "one node", read.id, found.size());
  if (!missing.empty()) {
    diagnostics_.error(target.place,
                       fmt::format("{}: it runs over the sweep{} '{}', this node does not", what,
                                   missing.size() > 1 ? "s" : "", coppice::join(missing, "', '")),
                       over_hint(element, missing));
  } else if (first.replicates > 1) {
    diagnostics_.error(target.place,
                       fmt::format("{}: it has {} replicates, this node has none", what, first.replicates),
                       fmt::format("add replicates=\"{}\" to this node", first.replicates));
  } else {
    diagnostics_.error(target.place, what + ": it fans out");
  }
  return false;
}

}  // namespace coppice
