#include "engine/graph/nodes/search_tables.h"

namespace coppice {
namespace {

using Type = ColumnInfo::Type;

Cell cell(const std::optional<double>& value) {
  return value ? Cell(*value) : Cell();
}

}  // namespace

Table optimum_table(const SearchTask& task, const std::vector<double>& best) {
  Table table;
  table.columns = {
      {"parameter", Type::text, "", "Number that was tuned; those of a list are counted from 0."},
      {"unit", Type::text, "", "Its SI unit."},
      {"low", Type::number, "", "Lower limit."},
      {"high", Type::number, "", "Upper limit."},
      {"start", Type::number, "", "Where the search began; empty: where the optimizer does."},
      {"value", Type::number, "", "What was found best."}};
  for (std::size_t i = 0; i < best.size(); ++i) {
    const Axis& axis = task.box[i];
    table.rows.push_back({axis.name, axis.unit, axis.low, axis.high,
                          task.guess.empty() ? Cell() : Cell(task.guess[i]), best[i]});
  }
  return table;
}

void add_truth(Table& summary, const SearchTarget& sought, const std::vector<double>& best) {
  const std::optional<double> value = sought.true_value(best), optimum = sought.optimum();
  const auto add = [&](const char* name, Type type, Cell cell, const char* doc) {
    summary.columns.push_back({name, type, "", doc});
    summary.rows.front().push_back(std::move(cell));
  };
  add("dimension", Type::integer, static_cast<std::int64_t>(best.size()), "Number of inputs.");
  add("true_value", Type::number, cell(value), "Value of the best point, without noise.");
  add("optimum", Type::number, cell(optimum), "Largest value that there is.");
  add("gap", Type::number, value && optimum ? Cell(*optimum - *value) : Cell(), "optimum minus true_value.");
}

Table targets_table(const std::vector<double>& gaps, const Improvements& improvements,
                    std::optional<double> optimum) {
  Table table;
  table.columns = {{"target", Type::number, "", "Gap to the optimum."},
                   {"evaluations", Type::integer, "",
                    "Evaluations until a point as near to it was tried; empty: none was."}};
  for (const double gap : gaps) {
    const auto first = optimum ? improvements.first(*optimum - gap) : std::nullopt;
    table.rows.push_back({gap, first ? Cell(*first) : Cell()});
  }
  return table;
}

}  // namespace coppice
