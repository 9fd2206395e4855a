#pragma once

#include <string>
#include <vector>

#include "engine/data/table_file.h"
#include "engine/graph/plan.h"

namespace coppice {

/// How tables name the node.
NodeLabels labels_of(const PlannedNode& node);

/// Hash of the names that a node's labelled tables and input table show; "" when it has no such tables.
std::string labels_hash(const PlannedNode& node);

/// Puts the node's sweep columns, problem, policy and replicate before the columns of a table. A sweep column
/// that has the name of another column is called sweep_<name>.
Table labelled(const Table& table, const PlannedNode& node);

/// Puts the same columns of the node that each row stands for before the row.
Table labelled_rows(const Table& table, const std::vector<NodeLabels>& rows);

/// Rows one after the other; columns that a table lacks stay empty.
Table join_rows(const std::vector<Table>& tables);

}  // namespace coppice
