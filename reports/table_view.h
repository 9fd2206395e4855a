#pragma once

#include <string>

#include "engine/data/table_file.h"
#include "reports/cells.h"

namespace coppice {

/// A number as people read it: five digits.
std::string short_number(const Cell& cell);

/// A table as HTML. With keys of columns it is spread out: a line for each combination of row keys, a column
/// for each of column keys, and in the cells mean, interval, number of replicates, published and reference
/// value. Otherwise line by line as it is.
std::string table_view(const Table& table, const TableKeys& keys);

}  // namespace coppice
