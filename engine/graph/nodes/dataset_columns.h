#pragma once

#include <string>
#include <vector>

#include "engine/graph/node.h"
#include "engine/vocabulary/matrix.h"

namespace coppice {

/// The named columns of the datasets, their rows one after the other. Throws ConfigError with file, line and
/// column for a cell that is no number, and when there are no rows.
Matrix read_columns(const std::vector<InputNode>& datasets, const std::vector<std::string>& names);

/// A rule is broken by each column that a dataset has not, as far as its columns are known. `parameter` is
/// where the user named them.
void check_columns(const std::vector<InputNode>& datasets, const std::string& parameter,
                   const std::vector<std::string>& names, Rules& rules);

}  // namespace coppice
