#pragma once

#include <string>

#include "engine/graph/compare.h"

namespace coppice::cli {

/// What differs between two runs of the experiment `name`, for people: rows of tables with intervals, then a
/// line that counts. With `all_files`, every result file that differs is named.
std::string difference_text(const std::string& name, const RunDifference& difference, bool all_files);

}  // namespace coppice::cli
