#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/statistics/comparisons.h"

namespace coppice {

/// A row of a table that is not the same in two runs.
struct RowDifference {
  std::vector<std::string> keys;
  std::optional<Summary> first, second;  ///< none: that run has no such row
};

/// One published table of two runs.
struct TableDifference {
  std::string file;               ///< below the run folders
  std::vector<std::string> keys;  ///< names of the key columns
  std::size_t rows = 0;           ///< of both together
  std::vector<RowDifference> differing;
};

/// What is not the same in two run folders.
struct RunDifference {
  bool other_parameters = false;        ///< resolved.xml differs in more than the name
  std::size_t files = 0;                ///< result files of both together
  std::vector<std::string> differing;   ///< those whose bytes differ, or that one run has not
  std::vector<TableDifference> tables;  ///< those with rows that differ
};

/// Compares the result files of two run folders: everything whose bytes are reproducible, so neither times
/// and what is drawn from them nor the records of the run. Throws ConfigError for a table or config that
/// cannot be read.
RunDifference compare_runs(const std::filesystem::path& first, const std::filesystem::path& second);

}  // namespace coppice
