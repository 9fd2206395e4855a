#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "engine/vocabulary/matrix.h"
#include "engine/vocabulary/space.h"

namespace coppice {

/// Transitions, one per row.
struct Dataset {
  Spaces spaces;
  std::vector<std::int64_t> episode;
  std::vector<std::int64_t> step;
  Matrix states;  ///< rows x state_size
  std::vector<std::int32_t> action_id;
  Matrix actions;  ///< rows x widest_action; NaN where an action has fewer axes
  std::vector<double> reward;
  Matrix next;                         ///< rows x state_size
  std::vector<std::uint8_t> terminal;  ///< 1: `next` is terminal, nothing follows

  Dataset() = default;
  Dataset(Spaces axes, std::size_t rows);  ///< rows of zeros

  std::size_t rows() const { return reward.size(); }
  Action action(std::size_t row) const;
  void set_action(std::size_t row, const Action& action);
  /// Throws std::logic_error when the columns differ in length.
  void check() const;
};

/// Rows of `parts` one after the other, episodes renumbered so that those of different parts differ. Throws
/// std::invalid_argument when the parts have different spaces.
Dataset join(const std::vector<Dataset>& parts);

/// Columns: episode, step, s_<axis>, action_id, a_<axis>, reward, n_<axis>, terminal (docs: "Datasets").
void write_dataset(const std::filesystem::path& file, const Dataset& dataset);

/// Reads what write_dataset wrote, or any CSV with these columns; `spaces` says which axes are expected.
/// Throws ConfigError with file, line and column of every bad cell, and the nearest name for a wrong column.
Dataset read_dataset(const std::filesystem::path& file, const Spaces& spaces);

}  // namespace coppice
