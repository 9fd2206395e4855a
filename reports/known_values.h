#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/data/table_file.h"
#include "reports/cells.h"

namespace coppice {

/// Values known from elsewhere, for cells of a table: a CSV file with the column "value" and some of the
/// table's key columns (a key that it leaves out does not matter); columns "source" and "note" may say more.
/// A key that has one of these three names is called sweep_<name>.
class KnownValues {
 public:
  KnownValues() = default;  ///< knows nothing
  /// Throws ConfigError naming the file: for other columns (with the nearest), for a value that is no number,
  /// for a key of another dimension, for several rows without a key, when there are no rows, when none is
  /// about any of the cells, and when two are about the same.
  KnownValues(const std::string& file, const TableKeys& keys, const std::vector<TableCell>& cells);

  /// The value for a cell; NaN when there is none.
  double find(const TableCell& cell) const;

 private:
  void check_units(const std::string& file, const TableKeys& keys, const std::vector<TableCell>& cells) const;
  bool matches(std::size_t row, const TableCell& cell) const;

  Table table_;
  std::vector<std::optional<std::size_t>> columns_;  ///< of the file, by key; none: does not matter
};

}  // namespace coppice
