#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/graph/node.h"
#include "engine/vocabulary/parallel.h"
#include "engine/vocabulary/space.h"

namespace coppice {

/// What an optimize node makes large. Immutable; evaluations may run at once.
class SearchTarget {
 public:
  virtual ~SearchTarget() = default;
  virtual const Space& box() const = 0;                ///< as declared; sides may be infinite
  virtual std::vector<double> guess() const = 0;       ///< where a search begins; empty: where it likes
  virtual bool noisy() const = 0;                      ///< as far as is known
  virtual bool has_scenarios() const { return true; }  ///< whether equal scenarios make comparisons fair
  /// Value at a point. Evaluations of equal scenario meet the same randomness.
  virtual double value(std::span<const double> x, std::uint64_t scenario, Parallel& parallel) const = 0;
  /// The value without noise, where it is known.
  virtual std::optional<double> true_value(std::span<const double>) const { return std::nullopt; }
  /// The largest of these, where it is known.
  virtual std::optional<double> optimum() const { return std::nullopt; }
  /// Keeps what was found, besides the tables of the node.
  virtual void write(std::span<const double>, std::int64_t /*evaluations*/, NodeContext&) const {}
};

/// "gains_0 = 0.5, gains_1 = 1"; of many numbers the first.
std::string point_text(const Space& box, std::span<const double> x);

/// The box with other limits: one for each axis, or one for all, or none. Throws std::invalid_argument for
/// limits that are not in order or not within the box.
Space limited(Space box, const std::vector<double>& low, const std::vector<double>& high);

/// Where a search in the box begins: uniformly between limits given likewise, or at `guess` where there are
/// none. Throws std::invalid_argument for a place outside of the box.
std::vector<double> search_start(const Space& box, std::vector<double> guess, const std::vector<double>& low,
                                 const std::vector<double>& high, const Draws& draws);

}  // namespace coppice
