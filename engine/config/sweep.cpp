#include "engine/config/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "engine/config/attribute_place.h"
#include "engine/config/control_check.h"
#include "registry/text.h"

namespace coppice::config {
namespace {

std::string row_text(const SweepRows& rows, const std::vector<Value>& row) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < row.size(); ++i) parts.push_back(rows.columns[i] + "=" + row[i].to_text());
  return join(parts);
}

std::string count_text(std::size_t count) {
  return fmt::format("{} point{}", count, count == 1 ? "" : "s");
}

class Builder {
 public:
  Builder(std::uint64_t seed, std::string label, Diagnostics& diagnostics)
      : seed_(seed), label_(std::move(label)), diagnostics_(diagnostics) {}

  /// The points of one part.
  std::optional<SweepRows> part(const Element& element) {
    if (element.name == "param") return param(element);
    if (element.name == "grid" || element.name == "zip") return combined(element);
    if (element.name == "list") return list(element);
    if (element.name == "sobol") return draw_rows(element, seed_, label_, 0, diagnostics_);
    return draw_rows(element, seed_, label_, random_parts_++, diagnostics_);
  }

  /// Elements that are not parts were reported by check_control.
  static bool is_part(const Element& parent, const Element& child) {
    const std::vector<std::string>& parts = find_control(parent.name, "sweep")->children;
    return std::find(parts.begin(), parts.end(), child.name) != parts.end();
  }

 private:
  std::optional<SweepRows> param(const Element& element) {
    const std::optional<std::string> column = read_column(element, diagnostics_);
    const Attribute* values = element.find("values");
    if (values == nullptr) return std::nullopt;  // reported
    const std::optional<std::vector<Value>> items = read_values(*values, diagnostics_);
    if (!column || !items) return std::nullopt;
    SweepRows rows{{*column}, {}, false};
    for (const Value& item : *items) rows.rows.push_back({item});
    return rows;
  }

  std::optional<SweepRows> list(const Element& element) {
    SweepRows rows;
    bool good = true;
    for (const Element& point : element.children) {
      if (point.name != "point") continue;
      good = add_point(point, rows) && good;
    }
    if (good && rows.rows.empty())
      return none(element, "a <list> needs at least one <point a=\"1\" b=\"2\"/>");
    return good ? std::optional(std::move(rows)) : std::nullopt;
  }

  bool add_point(const Element& point, SweepRows& rows) {
    std::vector<std::string> columns;
    bool good = true;
    for (const Attribute& attribute : point.attributes) {
      good = check_name(attribute.name, attribute.name_place, diagnostics_) && good;
      columns.push_back(attribute.name);
    }
    if (!good) return false;
    if (rows.columns.empty()) rows.columns = columns;
    if (columns.empty()) {
      none(point, "a <point> needs at least one column");
      return false;
    }
    std::vector<Value> row;
    for (const std::string& column : rows.columns) {
      const Attribute* value = point.find(column);
      if (value == nullptr || columns.size() != rows.columns.size()) {
        diagnostics_.error(point.place, fmt::format("this point has the columns {}", join(columns)),
                           fmt::format("the first point of the list has {}", join(rows.columns)));
        return false;
      }
      if (value->failed) return false;
      row.push_back(Value::inferred(value->value));
    }
    rows.rows.push_back(std::move(row));
    return true;
  }

  /// <grid>: every combination of the children's points; <zip>: the points side by side.
  std::optional<SweepRows> combined(const Element& element) {
    const bool zip = element.name == "zip";
    std::optional<SweepRows> all;
    bool good = true;
    const Element* first = nullptr;
    for (const Element& child : element.children) {
      if (!is_part(element, child)) continue;
      const std::optional<SweepRows> next = part(child);
      good = good && next && new_columns(child, all, *next);
      if (!good) continue;
      if (!all) {
        all = next;
        first = &child;
      } else if (zip && all->rows.size() != next->rows.size()) {
        diagnostics_.error(child.place,
                           fmt::format("<zip> needs parts of equal length: this one has {}, the first one {}",
                                       count_text(next->rows.size()), count_text(all->rows.size())),
                           fmt::format("the first one is <{}> in line {}", first->name, first->place.line));
        good = false;
      } else {
        good = combine(element, zip, *all, *next);
      }
    }
    if (good && !all) return none(element, fmt::format("a <{}> needs at least one <param>", element.name));
    return good ? all : std::nullopt;
  }

  bool new_columns(const Element& child, const std::optional<SweepRows>& all, const SweepRows& next) {
    if (!all) return true;
    for (const std::string& column : next.columns) {
      if (std::find(all->columns.begin(), all->columns.end(), column) == all->columns.end()) continue;
      diagnostics_.error(child.place, fmt::format("the column '{}' is there already", column),
                         "the parts of a grid or a zip have different columns");
      return false;
    }
    return true;
  }

  bool combine(const Element& element, bool zip, SweepRows& all, const SweepRows& next) {
    const std::size_t count = zip ? all.rows.size() : all.rows.size() * next.rows.size();
    if (count > kMostPoints) {
      diagnostics_.error(element.place, fmt::format("the grid has more than {} points", kMostPoints));
      return false;
    }
    std::vector<std::vector<Value>> rows;
    rows.reserve(count);
    for (std::size_t i = 0; i < all.rows.size(); ++i) {
      for (std::size_t j = zip ? i : 0; j < (zip ? i + 1 : next.rows.size()); ++j) {
        std::vector<Value> row = all.rows[i];
        row.insert(row.end(), next.rows[j].begin(), next.rows[j].end());
        rows.push_back(std::move(row));
      }
    }
    all.rows = std::move(rows);
    all.columns.insert(all.columns.end(), next.columns.begin(), next.columns.end());
    all.drawn = all.drawn || next.drawn;
    return true;
  }

  std::optional<SweepRows> none(const Element& element, const std::string& message) {
    diagnostics_.error(element.place, message);
    return std::nullopt;
  }

  std::uint64_t seed_;
  std::string label_;
  Diagnostics& diagnostics_;
  std::uint64_t random_parts_ = 0;
};

/// The rows with their columns in another order; nothing when the columns are not the same.
std::optional<SweepRows> reordered(SweepRows rows, const std::vector<std::string>& columns) {
  if (rows.columns == columns) return rows;
  std::vector<std::size_t> order;
  for (const std::string& column : columns) {
    const auto found = std::find(rows.columns.begin(), rows.columns.end(), column);
    if (found == rows.columns.end()) return std::nullopt;
    order.push_back(static_cast<std::size_t>(found - rows.columns.begin()));
  }
  if (rows.columns.size() != columns.size()) return std::nullopt;
  for (std::vector<Value>& row : rows.rows) {
    std::vector<Value> sorted;
    for (const std::size_t i : order) sorted.push_back(row[i]);
    row = std::move(sorted);
  }
  rows.columns = columns;
  return rows;
}

/// Adds the points of a part to the union; false after a mistake.
bool unite(const Element& part, SweepRows rows, SweepRows& all, std::set<std::string>& seen,
           Diagnostics& diagnostics) {
  if (all.columns.empty()) all.columns = rows.columns;
  const std::vector<std::string> columns = rows.columns;
  std::optional<SweepRows> fitting = reordered(std::move(rows), all.columns);
  if (!fitting) {
    diagnostics.error(part.place, fmt::format("this part of the sweep has the columns {}", join(columns)),
                      fmt::format("the first part has {}", join(all.columns)));
    return false;
  }
  std::set<std::string> here;
  for (std::vector<Value>& row : fitting->rows) {
    const std::string key = point_key(row);
    if (!here.insert(key).second && !fitting->drawn) {
      diagnostics.error(part.place, fmt::format("the point {} comes twice", row_text(*fitting, row)),
                        "a sweep has each point once");
      return false;
    }
    if (seen.insert(key).second) all.rows.push_back(std::move(row));
  }
  return true;
}

}  // namespace

std::string point_key(const std::vector<Value>& row) {
  std::string key;
  for (const Value& value : row) {
    const Quantity* quantity = value.as_quantity();
    key += quantity ? Value::quantity(*quantity).to_text() : value.to_text();
    key += '\0';
  }
  return key;
}

std::optional<std::vector<Value>> read_values(const Attribute& attribute, Diagnostics& diagnostics) {
  if (attribute.failed) return std::nullopt;
  const std::vector<std::string> items = split_items(attribute.value);
  if (items.empty()) {
    diagnostics.error(attribute.value_place, fmt::format("'{}' is empty", attribute.name),
                      "values are separated by commas");
    return std::nullopt;
  }
  if (!check_items(attribute, diagnostics)) return std::nullopt;
  std::vector<Value> values;
  for (const std::string& item : items) values.push_back(Value::inferred(item));
  return values;
}

std::optional<std::string> read_column(const Element& element, Diagnostics& diagnostics) {
  const Attribute* name = element.find("name");
  if (name == nullptr || name->failed) return std::nullopt;  // reported
  return check_name(name->value, name->value_place, diagnostics) ? std::optional(name->value) : std::nullopt;
}

std::optional<SweepRows> build_sweep(const Element& sweep, std::uint64_t seed, Diagnostics& diagnostics) {
  Builder builder(seed, std::string(sweep.get("seed_label", "sweep")), diagnostics);
  SweepRows all;
  std::set<std::string> seen;
  bool good = !sweep.failed, any = false;
  for (const Element& child : sweep.children) {
    if (!Builder::is_part(sweep, child)) continue;
    any = true;
    std::optional<SweepRows> rows = builder.part(child);
    good = rows && unite(child, std::move(*rows), all, seen, diagnostics) && good;
    if (all.rows.size() <= kMostPoints) continue;
    diagnostics.error(sweep.place, fmt::format("the sweep has more than {} points", kMostPoints));
    return std::nullopt;
  }
  if (!any && good) {
    diagnostics.error(sweep.place, "the sweep is empty",
                      "it needs a <grid>, <zip>, <list>, <random> or <sobol>");
    return std::nullopt;
  }
  return good ? std::optional(std::move(all)) : std::nullopt;
}

}  // namespace coppice::config
