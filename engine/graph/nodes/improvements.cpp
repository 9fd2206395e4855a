#include "engine/graph/nodes/improvements.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace coppice {

void Improvements::add(std::int64_t evaluation, double value) {
  if (!std::isfinite(value) || (!values_.empty() && !(value > values_.back()))) return;
  evaluations_.push_back(evaluation);
  values_.push_back(value);
}

std::optional<double> Improvements::best() const {
  return values_.empty() ? std::nullopt : std::optional(values_.back());
}

std::optional<std::int64_t> Improvements::first(double value) const {
  const auto found = std::lower_bound(values_.begin(), values_.end(), value);
  if (found == values_.end()) return std::nullopt;
  return evaluations_[static_cast<std::size_t>(found - values_.begin())];
}

Table Improvements::table(std::optional<double> optimum) const {
  using Type = ColumnInfo::Type;
  Table table;
  table.columns = {{"evaluations", Type::integer, "", "Evaluations until then, this one included."},
                   {"value", Type::number, "",
                    "Best value of a point tried so far: the true one where it is known, else as observed."}};
  if (optimum) table.columns.push_back({"gap", Type::number, "", "What it misses the optimum by."});
  for (std::size_t i = 0; i < values_.size(); ++i) {
    std::vector<Cell>& row = table.rows.emplace_back();
    row.emplace_back(evaluations_[i]);
    row.emplace_back(values_[i]);
    if (optimum) row.emplace_back(*optimum - values_[i]);
  }
  return table;
}

void Improvements::save(Archive& archive) const {
  archive.put("evaluations", evaluations_);
  archive.put("values", values_);
}

void Improvements::load(Archive& archive) {
  Improvements read;
  read.evaluations_ = archive.get<std::vector<std::int64_t>>("evaluations");
  read.values_ = archive.get<std::vector<double>>("values");
  if (read.values_.size() != read.evaluations_.size()) {
    throw std::runtime_error("not as many values as evaluations that improved");
  }
  *this = std::move(read);
}

}  // namespace coppice
