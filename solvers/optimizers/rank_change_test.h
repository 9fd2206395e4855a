#pragma once

#include <cstdint>
#include <span>

#include "engine/vocabulary/archive.h"

namespace coppice {

/// Tells whether noise disturbs the ranks of a search's candidates: a few of a generation are evaluated
/// again, all in one other scenario, and the pairs that have changed their order are counted (after the
/// uncertainty measure of Hansen, Niederberger, Guzzella and Koumoutsakos, IEEE TEC 13(1), 2009). While
/// values come out the same to the bit, it asks more and more rarely.
class RankChangeTest {
 public:
  /// Candidates of this generation to evaluate again.
  std::size_t repetitions(std::int64_t generation) const { return generation >= next_ ? kRepeated : 0; }
  /// The values of the same candidates in their first and in their second scenario.
  void learn(std::int64_t generation, std::span<const double> first, std::span<const double> second);
  bool values_differ() const { return differ_; }
  /// Whether ranks change so often that the noise is to be treated.
  bool disturbed() const { return changes_ > kThreshold; }
  /// Part of pairs that change their order, smoothed; 0.5: ranks are all luck.
  double changes() const { return changes_; }

  void save(Archive& archive) const;
  void load(const Archive& archive);

 private:
  static constexpr std::size_t kRepeated = 3;
  static constexpr std::int64_t kRarest = 16;  // generations
  static constexpr double kSmoothing = 0.2;
  static constexpr double kThreshold = 0.15;

  double changes_ = 0;
  bool differ_ = false;
  std::int64_t interval_ = 1;
  std::int64_t next_ = 0;
};

}  // namespace coppice
