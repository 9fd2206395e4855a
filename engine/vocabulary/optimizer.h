#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/vocabulary/archive.h"
#include "engine/vocabulary/matrix.h"
#include "engine/vocabulary/random.h"
#include "engine/vocabulary/space.h"
#include "registry/component.h"

namespace coppice {

/// One search for the largest value of a (perhaps noisy) function over a box. Ask and tell: the candidates of
/// one ask may be evaluated in parallel. Deterministic for its draws and the values told.
class Search {
 public:
  virtual ~Search() = default;
  /// Candidates to evaluate (rows; inside the box), at most `limit` of them; none when the search is over.
  virtual Matrix ask(std::int64_t limit) = 0;
  /// Their values, in the order of the last ask. A NaN counts as worse than every number.
  virtual void tell(std::span<const double> values) = 0;
  /// Best point so far as the method judges it (under noise not simply the luckiest sample).
  virtual std::vector<double> best() const = 0;
  virtual double best_value() const = 0;
  /// Why it ended: "budget", "tolerance", ...; empty while it goes on.
  virtual std::string stop_reason() const = 0;
  virtual void save(Archive& archive) const = 0;
  virtual void load(Archive& archive) = 0;
};

/// Black-box optimizer. Immutable; holds the parameters only.
class Optimizer {
 public:
  static constexpr const char* kInterface = "optimizer";
  virtual ~Optimizer() = default;
  /// `guess` is where to begin (empty: the box's centre); `budget` counts evaluations.
  virtual std::unique_ptr<Search> start(const Space& box, std::span<const double> guess, std::int64_t budget,
                                        const Draws& draws) const = 0;
};

}  // namespace coppice
