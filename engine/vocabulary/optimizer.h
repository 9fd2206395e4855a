#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/vocabulary/archive.h"
#include "engine/vocabulary/matrix.h"
#include "engine/vocabulary/random.h"
#include "engine/vocabulary/space.h"
#include "registry/component.h"

namespace coppice {

/// What a search is about: make a function of `box` large by trying points.
struct SearchTask {
  Space box;                  ///< sides may be infinite; no candidate lies outside
  std::vector<double> guess;  ///< where to begin; empty: the box's centre (0 where a side is infinite)
  std::int64_t budget = 0;    ///< evaluations in all, every repeated one counted
  bool noisy = true;          ///< whether two evaluations of one point may differ; false only when known
  Draws draws{0, "", 0};
};

/// Points to evaluate.
struct Candidates {
  Matrix points;  ///< one a row; no row: the search is over
  /// One for each row: the number of the scenario to meet. Evaluations of equal number are to meet the same
  /// randomness (common random numbers), so that their differences owe less to luck; others independent one.
  std::vector<std::uint64_t> scenarios;
};

/// One search for the largest value of a (perhaps noisy) function over a box. Ask and tell: the candidates of
/// one ask may be evaluated in parallel. Deterministic for its task and the values told.
class Search {
 public:
  virtual ~Search() = default;
  /// At most `limit` (at least 1) candidates, all inside the box; none when the search is over. How much is
  /// asked at once changes neither the candidates nor their order.
  virtual Candidates ask(std::int64_t limit) = 0;
  /// Their values, in the order of the last ask. A NaN counts as worse than every number.
  virtual void tell(std::span<const double> values) = 0;
  /// Best point so far as the method judges it (under noise not simply the luckiest sample); inside the box.
  virtual std::vector<double> best() const = 0;
  /// Its value as the method estimates it; NaN while nothing was told.
  virtual double best_value() const = 0;
  /// Why it ended: "budget", "tolerance", ...; empty while it goes on.
  virtual std::string stop_reason() const = 0;
  /// Values for the history ("sigma", "restarts"), in the order of Optimizer::measures.
  virtual std::vector<double> measures() const { return {}; }
  /// Everything that it needs to go on bit-identically in a new process, at any time. Candidates that were
  /// asked for and whose values were not told are asked for again after load.
  virtual void save(Archive& archive) const = 0;
  virtual void load(Archive& archive) = 0;
};

/// Black-box optimizer. Immutable; holds the parameters only.
class Optimizer {
 public:
  static constexpr const char* kInterface = "optimizer";
  virtual ~Optimizer() = default;
  /// Throws std::invalid_argument when the method cannot search such a box (infinite sides, too many axes, a
  /// budget too small to begin).
  virtual std::unique_ptr<Search> start(const SearchTask& task) const = 0;
  /// Names of what Search::measures gives: columns of the history.
  virtual std::vector<std::string> measures() const { return {}; }
};

}  // namespace coppice
