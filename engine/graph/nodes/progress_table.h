#pragma once

#include <string>
#include <vector>

#include "engine/data/table_file.h"
#include "engine/vocabulary/archive.h"
#include "engine/vocabulary/solver.h"

namespace coppice {

/// The rows of progress.csv: one for each unit of work of a training, with its measures. A measure that a
/// unit does not have is missing in its row.
class ProgressTable {
 public:
  void add(const TrainingProgress& progress);
  Table table() const;
  /// The names of its columns, when these are the measures.
  static std::vector<std::string> column_names(const std::vector<std::string>& measures);

  void save(Archive& archive) const;
  void load(Archive& archive);  ///< throws std::runtime_error for arrays that save did not write

 private:
  std::size_t column(const std::string& measure);

  std::vector<std::string> measures_;  ///< in order of appearance
  std::vector<std::int64_t> done_;
  std::vector<std::vector<double>> values_;  ///< by measure, then by row; NaN: missing
};

}  // namespace coppice
