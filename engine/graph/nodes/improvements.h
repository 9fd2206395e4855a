#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/data/table_file.h"
#include "engine/vocabulary/archive.h"

namespace coppice {

/// At which evaluations a search tried something better than ever before, and how good that was.
class Improvements {
 public:
  /// Evaluations are numbered from 1, in ascending order. What is not a finite number improves nothing.
  void add(std::int64_t evaluation, double value);
  std::optional<double> best() const;
  /// The first evaluation with at least this value.
  std::optional<std::int64_t> first(double value) const;
  /// With the distance to the optimum, where it is known.
  Table table(std::optional<double> optimum) const;

  void save(Archive& archive) const;
  void load(Archive& archive);  ///< throws std::runtime_error for arrays that save did not write

 private:
  std::vector<std::int64_t> evaluations_;
  std::vector<double> values_;  ///< ascending
};

}  // namespace coppice
