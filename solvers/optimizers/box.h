#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "engine/vocabulary/optimizer.h"

namespace coppice {

/// Throws std::invalid_argument, in the name of `method`, when the task is none: no axis, limits that are NaN
/// or in the wrong order, a guess of another size or not finite, a budget below `least`.
void check_task(const SearchTask& task, std::string_view method, std::int64_t least = 1);
/// As well when a side of the box is infinite.
void check_boxed_task(const SearchTask& task, std::string_view method, std::int64_t least = 1);

/// Moves each coordinate into its side; a NaN becomes its lower end (0 where that is infinite).
void clip(const Space& box, std::span<double> x);

/// The guess, moved into the box; without one the centre, and 0, or the nearest to it, where a side is
/// infinite.
std::vector<double> first_point(const SearchTask& task);

/// A point drawn uniformly in a finite box.
std::vector<double> uniform_point(const Space& box, Stream& stream);

/// A value as methods compare it: NaN is worse than every number.
double comparable(double value);

}  // namespace coppice
