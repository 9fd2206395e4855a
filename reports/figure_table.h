#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/data/table_file.h"
#include "engine/graph/node.h"
#include "reports/cells.h"
#include "reports/metric.h"

namespace coppice {

/// What a figure is about: a group of nodes for each combination of keys.
struct FigureInputs {
  const std::vector<InputNode>& nodes;
  const std::vector<TableCell>& groups;
  const Table& keys;  ///< a row for each group
  std::size_t lines;  ///< of the nodes; those after them are observations
};

/// The course of learning: mean and interval of a measure over x, a column of progress or a time; or of a
/// column of datasets over another. Observations are rows of single values, told apart by a column `drawn`.
Table curve_table(const FigureInputs& inputs, const std::string& x, const std::string& y);

/// A row for each group: mean and interval.
Table interval_table(const FigureInputs& inputs, Metric metric);

/// How many runs, or episodes, lie in each bin; 0 bins: a number that suits the values.
Table histogram_table(const FigureInputs& inputs, Metric metric, std::size_t bins);

/// The share of runs, or episodes, that are better than each of a hundred thresholds.
Table profile_table(const FigureInputs& inputs, Metric metric, Better better);

/// The columns that an x of learning_table cannot have the name of.
const std::vector<std::string>& estimate_column_names();

}  // namespace coppice
