#pragma once

#include <string>
#include <vector>

#include "engine/data/table_file.h"
#include "engine/graph/plan.h"

namespace coppice {

/// Hash of the names that a node's labelled tables show; "" when it has no such tables.
std::string labels_hash(const PlannedNode& node);

/// Puts the node's sweep columns, problem, policy and replicate before the columns of a table. A sweep column
/// that has the name of another column is called sweep_<name>.
Table labelled(const Table& table, const PlannedNode& node);

/// Rows one after the other; columns that a table lacks stay empty.
Table join_rows(const std::vector<Table>& tables);

}  // namespace coppice
