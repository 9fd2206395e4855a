#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/config/control_check.h"
#include "engine/config/expander.h"

namespace coppice::config {
namespace {

constexpr const char* kRenamed = "sweep_";

/// Checks the attributes and children of a sweep whose conditions, groups, calls and includes are worked out.
void check_parts(const Element& element, std::string_view parent, Diagnostics& diagnostics) {
  const ControlElement* declaration = find_control(element.name, parent);
  if (declaration == nullptr) return;  // reported as not belonging in its parent
  check_control(element, *declaration, nullptr, diagnostics);
  for (const Element& child : element.children) {
    const std::vector<std::string>& allowed = declaration->children;
    if (std::find(allowed.begin(), allowed.end(), child.name) != allowed.end()) {
      check_parts(child, element.name, diagnostics);
    }
  }
}

}  // namespace

void Expander::sweep(const Element& element, const Context& context) {
  if (context.inside) {
    error(element.place, context, "<sweep> does not belong inside another element",
          "<sweep> stands at the top level of a file, or of a macro");
    return leave_out(nullptr);
  }
  Element plain;
  plain.name = element.name;
  plain.place = traced(element.place, context);
  for (const Attribute& attribute : element.attributes) {
    if (!is_control_attribute(attribute.name))
      plain.attributes.push_back(evaluator_.attribute(attribute, context));
  }
  Context inner = context;
  inner.inside = true;
  inner.scope = std::make_shared<Scope>(context.scope);
  std::vector<Exclusion> exclusions;
  exclusions_ = &exclusions;
  sweep_ = &plain;
  children(element, inner, &plain);
  sweep_ = nullptr;
  exclusions_ = nullptr;

  check_parts(plain, "", diagnostics_);
  const Attribute* id = plain.find("id");
  if (id == nullptr || id->failed) return leave_out(nullptr);
  if (!is_id(id->value)) {
    diagnostics_.error(id->value_place, fmt::format("'{}' cannot be the id of a sweep", id->value),
                       "letters, digits, '_' and '-' make an id");
    return leave_out(nullptr);
  }
  const auto known = sweeps_.find(id->value);
  if (known != sweeps_.end() && known->second->failed) return leave_out(nullptr);  // once is enough
  auto made = std::make_unique<DefinedSweep>();
  made->origin = Origin(element, context);
  made->points.id = id->value;
  made->points.place = plain.place;
  fill(*made, plain, exclusions, context);
  const auto [before, added] = sweeps_.try_emplace(id->value, std::move(made));
  if (added) {
    if (!before->second->failed) sweep_order_.push_back(before->second.get());
    return;
  }
  if (met_again(*before->second, *made)) return;
  const Place& first = before->second->points.place;
  diagnostics_.error(id->value_place, fmt::format("the sweep '{}' is defined a second time", id->value),
                     fmt::format("it was defined at {}:{}:{}", first.file->path, first.line, first.column));
  leave_out(nullptr);
}

/// Two files may include the same third one: the same sweep with the same points is no second one.
bool Expander::met_again(const DefinedSweep& first, const DefinedSweep& again) {
  if (first.origin != again.origin) return false;
  return again.failed ||
         (first.points.columns == again.points.columns && first.points.points == again.points.points);
}

void Expander::fill(DefinedSweep& sweep, const Element& plain, const std::vector<Exclusion>& exclusions,
                    const Context& context) {
  std::optional<SweepRows> rows = build_sweep(plain, seed_, diagnostics_);
  if (rows) {
    sweep.rows = std::move(*rows);
    sweep.points.columns = sweep.rows.columns;
    check_columns(sweep, context);
    exclude(sweep, exclusions);
  }
  sweep.failed = sweep.failed || !rows;
  if (sweep.failed) return leave_out(nullptr);
  for (const std::vector<Value>& row : sweep.rows.rows) {
    Point point;
    for (std::size_t i = 0; i < row.size(); ++i) point.emplace_back(sweep.rows.columns[i], row[i].to_text());
    sweep.points.points.push_back(std::move(point));
  }
}

/// A column may not hide an argument or a constant of the experiment.
void Expander::check_columns(const DefinedSweep& sweep, const Context& context) {
  for (const std::string& column : sweep.rows.columns) {
    evaluator_.add_column(column, sweep.points.id);
    if (column.starts_with(kRenamed)) {
      error(sweep.points.place, context,
            fmt::format("the column '{}' of sweep '{}' begins with '{}'", column, sweep.points.id, kRenamed),
            "tables call a column so that has the name of one of theirs");
    }
    const Definition* definition = global_->find_here(column);
    if (definition == nullptr) continue;
    const Place& place = definition->place;
    error(sweep.points.place, context,
          fmt::format("the column '{}' of sweep '{}' has the name of the {} '{}'", column, sweep.points.id,
                      definition->what, column),
          place.file ? fmt::format("which is defined at {}:{}", place.file->path, place.line) : "");
  }
}

void Expander::exclude(DefinedSweep& sweep, const std::vector<Exclusion>& exclusions) {
  SweepRows& rows = sweep.rows;
  ColumnValues columns(rows.columns.size());
  for (const Exclusion& exclusion : exclusions) {
    if (!check(*exclusion.element, "sweep", exclusion.context)) {
      sweep.failed = true;
      continue;
    }
    const Attribute& when = *exclusion.element->find("when");
    Context context = exclusion.context;
    context.scope = std::make_shared<Scope>(exclusion.context.scope, &columns);
    std::erase_if(rows.rows, [&](const std::vector<Value>& row) {
      for (std::size_t i = 0; i < row.size(); ++i) columns[i] = {&rows.columns[i], &row[i]};
      const bool complete = std::exchange(result_.complete, true);
      const bool excluded = condition(when, context, false);
      sweep.failed = sweep.failed || !result_.complete;
      result_.complete = result_.complete && complete;
      return excluded;
    });
  }
  if (!rows.rows.empty() || sweep.failed) return;
  diagnostics_.error(
      sweep.points.place,
      fmt::format("the sweep '{}' is empty: <exclude> leaves out every point", sweep.points.id));
  sweep.failed = true;
}

}  // namespace coppice::config
