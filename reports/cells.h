#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/data/table_file.h"
#include "engine/graph/node.h"

namespace coppice {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();  ///< an empty cell

/// A node as a table names it.
struct Entry {
  /// Its labels, then "node", its id. A sweep column that has the name of another one, with another value, is
  /// called sweep_<name>, as in evaluations.
  std::vector<PointValue> names;
  std::optional<int> replicate;
  std::map<std::string, std::string> units = {};  ///< of those names whose values are quantities
};
std::vector<Entry> entries_of(const std::vector<InputNode>& nodes);

/// The keys of a table: names of labels, in the order of the columns.
struct TableKeys {
  std::vector<std::string> rows, columns;
  std::string parameters = "rows and columns";           ///< where the user wrote them, for messages
  std::string of_rows = "rows", of_columns = "columns";  ///< the parameters that list them
  std::vector<std::string> all() const;
};

/// What belongs to one combination of keys.
struct TableCell {
  std::vector<std::string> keys;  ///< one for each of TableKeys::all(); empty where entries have no such name
  std::vector<std::size_t> entries;     ///< replicates of one and the same thing
  std::vector<std::string> units = {};  ///< SI units of the keys; empty where they are no quantities

  std::string unit(std::size_t key) const { return key < units.size() ? units[key] : std::string(); }
};

/// Sorts entries into cells; these stand in the order in which their row's keys appear first, then their
/// column's. Throws std::invalid_argument for a key that no entry has (with the nearest), and for entries in
/// one cell that are not replicates of each other (with the name that tells them apart).
std::vector<TableCell> arrange(const std::vector<Entry>& entries, const TableKeys& keys);

/// The key columns of a table with these cells, as numbers where all keys are.
void add_key_columns(Table& table, const TableKeys& keys, const std::vector<TableCell>& cells);

/// Gives a key column that has the name of a column after the keys the name sweep_<name>, as evaluations have
/// it; the first `keys` columns are those of keys.
void rename_taken_keys(Table& table, std::size_t keys);
/// The name that the key's column has in such a table.
std::string key_column(const Table& table, const std::string& key);

/// A table or figure shows all replicates of what it is of; a rule is broken when it is to have some of its
/// own, which would be as many equal ones, or a part of what there is in each.
void refuse_replicates(const NodeOptions& node, Rules& rules);

/// True unless the text is a quantity of another dimension than a key in this SI unit ("": none is known).
bool fits_unit(std::string_view text, std::string_view unit);
/// Whether a text means a key that has this unit: equal texts, or equal numbers; "10 deg" and 0.174... are
/// the same angle.
bool same_key(std::string_view text, std::string_view key, std::string_view unit = {});

}  // namespace coppice
