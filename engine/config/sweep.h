#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/config/value.h"
#include "registry/source.h"

namespace coppice::config {

/// Points of a sweep, or of a part of one: a value for each column in each row.
struct SweepRows {
  std::vector<std::string> columns;
  std::vector<std::vector<Value>> rows;
  bool drawn = false;  ///< by chance, so that a point may come twice without a mistake
};

inline constexpr std::size_t kMostPoints = 1'000'000;  ///< of one sweep; and nodes of an experiment

/// The points of a <sweep> whose attributes are worked out already, without its <exclude>. Nothing after a
/// mistake. A point that comes again from another part of the union, or by chance, is left out; one that is
/// given twice within one part is a mistake. `seed` is the root of the draws of <random>.
std::optional<SweepRows> build_sweep(const Element& sweep, std::uint64_t seed, Diagnostics& diagnostics);

/// What tells the points of a sweep apart: their values, numbers by value and not by spelling.
std::string point_key(const std::vector<Value>& row);

// The parts.

/// <random> and <sobol>; `part` is the number of the <random> within its sweep.
std::optional<SweepRows> draw_rows(const Element& element, std::uint64_t seed, std::string_view label,
                                   std::uint64_t part, Diagnostics& diagnostics);
/// The values of a `values` attribute.
std::optional<std::vector<Value>> read_values(const Attribute& attribute, Diagnostics& diagnostics);
/// The attribute that names a column, if it can.
std::optional<std::string> read_column(const Element& element, Diagnostics& diagnostics);

}  // namespace coppice::config
