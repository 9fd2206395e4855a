#include "engine/graph/nodes/search_tables.h"

namespace coppice {
namespace {

Cell cell(const std::optional<double>& value) {
  return value ? Cell(*value) : Cell();
}

}  // namespace

Table optimum_table(const SearchTask& task, const std::vector<double>& best) {
  Table table;
  table.columns = {
      {"parameter", ColumnInfo::Type::text, "", "Number that was tuned; those of a list are counted from 0."},
      {"unit", ColumnInfo::Type::text, "", "Its SI unit."},
      {"low", ColumnInfo::Type::number, "", "Lower limit."},
      {"high", ColumnInfo::Type::number, "", "Upper limit."},
      {"start", ColumnInfo::Type::number, "", "Where the search began; empty: where the optimizer does."},
      {"value", ColumnInfo::Type::number, "", "What was found best."}};
  for (std::size_t i = 0; i < best.size(); ++i) {
    const Axis& axis = task.box[i];
    table.rows.push_back({axis.name, axis.unit, axis.low, axis.high,
                          task.guess.empty() ? Cell() : Cell(task.guess[i]), best[i]});
  }
  return table;
}

void add_truth(Table& summary, const SearchTarget& sought, const std::vector<double>& best) {
  const std::optional<double> value = sought.true_value(best), optimum = sought.optimum();
  const auto add = [&](const char* name, ColumnInfo::Type type, Cell cell, const char* doc) {
    summary.columns.push_back({name, type, "", doc});
    summary.rows.front().push_back(std::move(cell));
  };
  add("dimension", ColumnInfo::Type::integer, static_cast<std::int64_t>(best.size()), "Number of inputs.");
  add("true_value", ColumnInfo::Type::number, cell(value), "Value of the best point, without noise.");
  add("optimum", ColumnInfo::Type::number, cell(optimum), "Largest value that there is.");
  add("gap", ColumnInfo::Type::number, value && optimum ? Cell(*optimum - *value) : Cell(),
      "optimum minus true_value.");
}

Table targets_table(const std::vector<double>& gaps, const Improvements& improvements,
                    std::optional<double> optimum) {
  Table table;
  table.columns = {{"target", ColumnInfo::Type::number, "", "Gap to the optimum."},
                   {"evaluations", ColumnInfo::Type::integer, "",
                    "Evaluations until a point as near to it was tried; empty: none was."}};
  for (const double gap : gaps) {
    const auto first = optimum ? improvements.first(*optimum - gap) : std::nullopt;
    table.rows.push_back({gap, first ? Cell(*first) : Cell()});
  }
  return table;
}

}  // namespace coppice
