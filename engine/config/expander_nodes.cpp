#include <fmt/format.h>

#include <algorithm>

#include "engine/config/attribute_place.h"
#include "engine/config/control_check.h"
#include "engine/config/expander.h"
#include "registry/suggest.h"
#include "registry/text.h"

namespace coppice::config {
namespace {

std::string point_text(const Point& point) {
  std::vector<std::string> parts;
  for (const auto& [column, value] : point) parts.push_back(column + "=" + value);
  return join(parts);
}

bool same_content(const Element& a, const Element& b) {
  const auto same_attribute = [](const Attribute& x, const Attribute& y) {
    return x.name == y.name && x.value == y.value && x.failed == y.failed;
  };
  return a.name == b.name &&
         std::equal(a.attributes.begin(), a.attributes.end(), b.attributes.begin(), b.attributes.end(),
                    same_attribute) &&
         std::equal(a.children.begin(), a.children.end(), b.children.begin(), b.children.end(), same_content);
}

bool same_node(const NodeElement& a, const NodeElement& b) {
  return a.sweeps == b.sweeps && a.point == b.point && same_content(a.element, b.element);
}

}  // namespace

/// A node of the experiment. One that is met again because two files include its file is no second one.
void Expander::node(const Element& element, const Context& context) {
  std::vector<NodeElement>& nodes = result_.nodes;
  const std::size_t begin = nodes.size();
  node_over_sweeps(element, context);
  const auto [before, added] = made_.try_emplace(Origin(element, context), begin, nodes.size());
  if (added) return;
  const auto at = [&](std::size_t i) { return nodes.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto [first, last] = before->second;
  if (std::equal(at(first), at(last), at(begin), nodes.end(), same_node)) nodes.erase(at(begin), nodes.end());
}

/// One element for each point of the sweeps that the node runs over.
void Expander::node_over_sweeps(const Element& element, const Context& context) {
  Context inner = context;
  inner.inside = true;
  if (left_out_with_its_sweeps(element, inner)) return skip(element, context, nullptr);
  const std::vector<DefinedSweep*> sweeps = sweeps_of(element, inner);
  std::optional<Attribute> id;
  if (const Attribute* raw = element.find("id")) id = evaluator_.attribute(*raw, inner);
  if (id && id->failed) result_.complete = false;
  const std::size_t before = result_.nodes.size();
  if (const Attribute* at = element.find("at")) {
    const std::optional<std::vector<std::size_t>> rows = point_of(*at, sweeps, inner);
    if (rows) node_at_point(element, sweeps, *rows, id, inner);
    if (!rows) result_.complete = false;
  } else if (may_have_so_many(element, sweeps, inner)) {
    node_at_each_point(element, sweeps, id, inner);
  }
  if (!sweeps.empty() && result_.nodes.size() == before) note_left_out(element, inner);
}

void Expander::node_at_each_point(const Element& element, const std::vector<DefinedSweep*>& sweeps,
                                  const std::optional<Attribute>& id, const Context& context) {
  std::vector<std::size_t> rows(sweeps.size(), 0);
  for (bool more = true; more;) {
    node_at_point(element, sweeps, rows, id, context);
    more = false;
    for (std::size_t i = sweeps.size(); i-- > 0 && !more;) {  // the last sweep changes fastest
      more = ++rows[i] < sweeps[i]->rows.rows.size();
      if (!more) rows[i] = 0;
    }
  }
}

/// False, and reported before any is made, when an experiment could have too many nodes.
bool Expander::may_have_so_many(const Element& element, const std::vector<DefinedSweep*>& sweeps,
                                const Context& context) {
  const std::size_t most = kMostPoints - std::min(kMostPoints, result_.nodes.size());
  std::size_t count = 1;
  std::string product;
  for (const DefinedSweep* sweep : sweeps) {
    const std::size_t points = std::max<std::size_t>(1, sweep->rows.rows.size());
    count = points > most / count ? most + 1 : count * points;
    product += fmt::format("{}{}", product.empty() ? "" : " x ", points);
    if (count <= most) continue;
    error(element.find("over")->value_place, context,
          fmt::format("the experiment could have more than {} nodes: {} here", kMostPoints, product),
          "<exclude> leaves points of a sweep out before they are combined");
    result_.complete = false;
    return false;
  }
  return true;
}

/// True when a sweep that the node is to run over is not there, and the node's conditions do not hold either,
/// whatever the columns of that sweep would be.
bool Expander::left_out_with_its_sweeps(const Element& element, Context context) {
  const Attribute* over = element.find("over");
  if (over == nullptr || (element.find("if") == nullptr && element.find("unless") == nullptr)) return false;
  const std::vector<std::string> ids = split_items(quiet_text(*over, context));
  const auto left_out = [&](const std::string& id) { return sweep_left_out(id) != nullptr; };
  if (std::none_of(ids.begin(), ids.end(), left_out)) return false;
  context.names_unknown = true;
  const bool complete = result_.complete;
  const bool stays = wanted(element, context);
  result_.complete = complete;  // where it stays, the missing sweep is a mistake that is reported
  return !stays;
}

/// The sweep of this id that a condition left out; null when there is none.
const LeftOut* Expander::sweep_left_out(const std::string& id) const {
  if (id.empty() || sweeps_.contains(id)) return nullptr;
  const auto found = std::find_if(result_.left_out.begin(), result_.left_out.end(),
                                  [&](const LeftOut& part) { return part.kind == "sweep" && part.id == id; });
  return found == result_.left_out.end() ? nullptr : &*found;
}

/// The sweeps that `over` names. After a mistake, names that could be columns are no mistakes of their own.
std::vector<Expander::DefinedSweep*> Expander::sweeps_of(const Element& element, Context& context) {
  std::vector<DefinedSweep*> sweeps;
  const Attribute* over = element.find("over");
  if (over == nullptr) return sweeps;
  const std::optional<std::string> text = evaluator_.text(*over, context);
  bool good = text.has_value();
  const Attribute worked_out{over->name, text.value_or(""), over->name_place,
                             traced(over->value_place, context)};
  const std::vector<std::string> ids = split_items(worked_out.value);
  good = good && (ids.empty() || check_items(worked_out, diagnostics_));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i].empty()) continue;
    const auto found = sweeps_.find(ids[i]);
    const bool twice = found != sweeps_.end() &&
                       std::find(sweeps.begin(), sweeps.end(), found->second.get()) != sweeps.end();
    if (found == sweeps_.end() || twice) {
      std::vector<std::string> known;
      for (const auto& [id, sweep] : sweeps_) known.push_back(id);
      const Place place =
          place_in(worked_out, item_offsets(worked_out.value)[i], std::max<std::size_t>(1, ids[i].size()));
      if (twice) {
        error(place, context, fmt::format("the sweep '{}' is named twice", ids[i]));
      } else if (const LeftOut* off = sweep_left_out(ids[i])) {
        error(place, context, fmt::format("the sweep '{}' is left out here", ids[i]),
              "the node needs the same condition",
              {fmt::format("by a condition, at {}:{}", off->place.file->path, off->place.line)});
      } else {
        error(place, context, fmt::format("there is no sweep '{}'", ids[i]),
              known.empty() ? "no sweep is defined before this node" : suggestion(ids[i], known));
      }
      good = false;
      continue;
    }
    good = good && !found->second->failed;
    sweeps.push_back(found->second.get());
  }
  if (good && ids.empty()) {
    error(over->value_place, context, "'over' names no sweep",
          "leave it out, or name sweeps separated by commas");
    good = false;
  }
  if (good && check_shared_columns(*over, sweeps, context)) return sweeps;
  result_.complete = false;
  context.names_unknown = true;
  return {};
}

/// The columns of a node have different names, and names of their own.
bool Expander::check_shared_columns(const Attribute& over, const std::vector<DefinedSweep*>& sweeps,
                                    const Context& context) {
  std::map<std::string, std::string> seen;
  for (const DefinedSweep* sweep : sweeps) {
    for (const std::string& column : sweep->rows.columns) {
      const auto [first, added] = seen.emplace(column, sweep->points.id);
      if (!added) {
        error(over.value_place, context,
              fmt::format("the sweeps '{}' and '{}' both have the column '{}'", first->second,
                          sweep->points.id, column),
              "a node runs over sweeps with different columns");
        return false;
      }
      const Definition* hidden = context.scope->find_before(*global_, column);
      if (hidden == nullptr) continue;
      error(over.value_place, context,
            fmt::format("the column '{}' of sweep '{}' has the name of {}", column, sweep->points.id,
                        with_article(hidden->what)));
      return false;
    }
  }
  return true;
}

void Expander::node_at_point(const Element& element, const std::vector<DefinedSweep*>& sweeps,
                             const std::vector<std::size_t>& rows, const std::optional<Attribute>& id,
                             const Context& context) {
  ColumnValues columns;
  NodeElement made;
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    const DefinedSweep& sweep = *sweeps[i];
    made.sweeps.push_back(sweep.points.id);
    const Point& point = sweep.points.points[rows[i]];
    made.point.insert(made.point.end(), point.begin(), point.end());
    for (std::size_t c = 0; c < sweep.rows.columns.size(); ++c) {
      columns.push_back({&sweep.rows.columns[c], &sweep.rows.rows[rows[i]][c]});
    }
  }
  Context inner = context;
  inner.columns = &columns;
  inner.scope = std::make_shared<Scope>(context.scope, &columns);
  if (element.find("over") != nullptr && !wanted(element, inner)) return keep_unused(element, inner, "");
  made.element.name = element.name;
  made.element.place = traced(element.place, context);
  made.element.attributes.reserve(element.attributes.size());
  for (const Attribute& attribute : element.attributes) {
    if (is_control_attribute(attribute.name) || attribute.name == "over" || attribute.name == "at") continue;
    made.element.attributes.push_back(attribute.name == "id" ? *id : evaluator_.attribute(attribute, inner));
  }
  made.element.children.reserve(element.children.size());
  children(element, inner, &made.element);
  count(element, context);
  result_.nodes.push_back(std::move(made));
}

/// The row of each sweep that at="column=value, ..." selects; nothing after a mistake.
std::optional<std::vector<std::size_t>> Expander::point_of(const Attribute& at,
                                                           const std::vector<DefinedSweep*>& sweeps,
                                                           const Context& context) {
  const std::optional<std::string> text = evaluator_.text(at, context);
  if (!text || context.names_unknown) return std::nullopt;
  std::map<std::string, std::string> given;
  for (const std::string& item : split_items(*text)) {
    const std::size_t equals = item.find('=');
    const std::string column(trim(item.substr(0, equals)));
    if (equals == std::string::npos ||
        !given.emplace(column, unquoted_item(item.substr(equals + 1))).second) {
      error(at.value_place, context, fmt::format("'{}' is not one column=value for each column", *text));
      return std::nullopt;
    }
  }
  std::vector<std::size_t> rows;
  std::size_t used = 0;
  for (DefinedSweep* sweep : sweeps) {
    if (sweep->index.empty()) {
      for (std::size_t i = 0; i < sweep->points.points.size(); ++i)
        sweep->index[point_text(sweep->points.points[i])] = i;
    }
    Point point;
    for (const std::string& column : sweep->points.columns) {
      used += given.contains(column) ? 1 : 0;
      point.emplace_back(column, given[column]);
    }
    const auto found = sweep->index.find(point_text(point));
    if (found == sweep->index.end()) {
      error(at.value_place, context,
            fmt::format("the sweep '{}' has no point {}", sweep->points.id, point_text(point)));
      return std::nullopt;
    }
    rows.push_back(found->second);
  }
  if (used == given.size() && !sweeps.empty()) return rows;
  error(at.value_place, context,
        fmt::format("'at' names columns that the node's sweeps do not have: {}", *text),
        "'over' names the sweeps");
  return std::nullopt;
}

}  // namespace coppice::config
