#pragma once

#include <optional>
#include <vector>

#include "engine/data/table_file.h"
#include "engine/graph/nodes/improvements.h"
#include "engine/graph/nodes/search_target.h"
#include "engine/vocabulary/optimizer.h"

namespace coppice {

/// A row for each number that was tuned.
Table optimum_table(const SearchTask& task, const std::vector<double>& best);

/// Adds to the one row about a search what is known of a test function, and of the point that was found.
void add_truth(Table& summary, const SearchTarget& sought, const std::vector<double>& best);

/// When the search first tried a point as near to the optimum as each of these gaps.
Table targets_table(const std::vector<double>& gaps, const Improvements& improvements,
                    std::optional<double> optimum);

}  // namespace coppice
