#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/vocabulary/matrix.h"
#include "engine/vocabulary/space.h"
#include "registry/error.h"

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

/// Names of the columns of a dataset, in the order in which write_dataset writes them.
std::vector<std::string> dataset_column_names(const Spaces& spaces);

/// Columns: episode, step, s_<axis>, action_id, a_<axis> (of the widest action), reward, n_<axis>, terminal;
/// one transition per row. Throws std::runtime_error with the file and the system's reason when it cannot be
/// written.
void write_dataset(const std::filesystem::path& file, const Dataset& dataset);

/// Reads what write_dataset wrote, or any CSV with these columns, in any order; `spaces` says which axes are
/// expected. Other columns are skipped, unless their names begin as an axis's (s_, a_, n_). Throws
/// ConfigError with file, line and column of the bad cells, and the nearest name for a column that is
/// missing; also for actions outside their boxes, for rows that do not stand in the order of episodes and
/// steps or follow a terminal step, and when there are none.
Dataset read_dataset(const std::filesystem::path& file, const Spaces& spaces);

/// Throws as read_dataset for what is wrong with the header of a CSV text.
void check_dataset_header(std::shared_ptr<const SourceFile> source, const Spaces& spaces);

/// Reads the columns s_<axis> of a CSV text (rows x axes). Throws as read_dataset.
Matrix read_states(std::shared_ptr<const SourceFile> source, const Space& states);

}  // namespace coppice
