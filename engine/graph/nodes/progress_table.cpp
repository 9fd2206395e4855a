#include "engine/graph/nodes/progress_table.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace coppice {
namespace {

constexpr const char* kIteration = "iteration";
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::size_t ProgressTable::column(const std::string& measure) {
  const auto found = std::find(measures_.begin(), measures_.end(), measure);
  if (found != measures_.end()) return static_cast<std::size_t>(found - measures_.begin());
  measures_.push_back(measure);
  values_.emplace_back(done_.size(), kMissing);
  return measures_.size() - 1;
}

void ProgressTable::add(const TrainingProgress& progress) {
  done_.push_back(progress.done);
  for (std::vector<double>& values : values_) values.push_back(kMissing);
  for (const auto& [measure, value] : progress.measures) values_[column(measure)].back() = value;
}

Table ProgressTable::table() const {
  Table table;
  table.columns.push_back({kIteration, ColumnInfo::Type::integer, "", "Units of work done."});
  for (const std::string& measure : measures_) {
    table.columns.push_back(
        {measure, ColumnInfo::Type::number, "", "As the solver measured it in this unit."});
  }
  for (std::size_t row = 0; row < done_.size(); ++row) {
    std::vector<Cell>& cells = table.rows.emplace_back();
    cells.emplace_back(done_[row]);
    for (const std::vector<double>& values : values_) cells.emplace_back(values[row]);
  }
  return table;
}

std::vector<std::string> ProgressTable::column_names(const std::vector<std::string>& measures) {
  std::vector<std::string> names = {kIteration};
  names.insert(names.end(), measures.begin(), measures.end());
  return names;
}

void ProgressTable::save(Archive& archive) const {
  archive.put("iteration", done_);
  for (std::size_t i = 0; i < measures_.size(); ++i) {
    const Archive::Scope measure(archive, std::to_string(i));
    archive.put("name", measures_[i]);
    archive.put("values", values_[i]);
  }
}

void ProgressTable::load(Archive& archive) {
  ProgressTable read;
  read.done_ = archive.get<std::vector<std::int64_t>>("iteration");
  while (archive.has(std::to_string(read.measures_.size()) + "/name")) {
    const Archive::Scope measure(archive, std::to_string(read.measures_.size()));
    read.measures_.push_back(archive.get<std::string>("name"));
    read.values_.push_back(archive.get<std::vector<double>>("values"));
    if (read.values_.back().size() != read.done_.size()) {
      throw std::runtime_error("a measure has another number of values than there are iterations");
    }
  }
  *this = std::move(read);
}

}  // namespace coppice
