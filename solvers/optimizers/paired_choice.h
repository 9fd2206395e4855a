#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/vocabulary/optimizer.h"

namespace coppice {

/// Chooses the best of several points of a noisy function: sequential halving (Karnin, Koren and Somekh, ICML
/// 2013), where all points still in question are evaluated on the same fresh scenarios, so that no point wins
/// by meeting easier ones, nor by the sample that made it a finalist.
class PairedChoice {
 public:
  PairedChoice() = default;
  /// Spends `budget` evaluations in full, on scenarios from `first_scenario` on.
  PairedChoice(Matrix points, std::int64_t budget, std::uint64_t first_scenario);

  /// Evaluations of the next round; none when the choice is made.
  Candidates next_round();
  /// Their values.
  void learn(std::span<const double> values);
  bool done() const { return left_ <= 0; }
  std::size_t best() const;  ///< row; the first while nothing was learned
  std::vector<double> best_point() const;
  double best_value() const;  ///< mean of its evaluations; NaN without any
  std::size_t finalists() const { return points_.rows(); }

  void save(Archive& archive) const;
  void load(Archive& archive, std::size_t columns);

 private:
  double mean(std::size_t row) const;
  void halve();

  Matrix points_;
  std::vector<double> sums_, counts_;    ///< of the evaluations of each point
  std::vector<std::int64_t> survivors_;  ///< rows still in question
  std::vector<std::int64_t> round_;      ///< rows of the round that is evaluated
  std::int64_t left_ = 0;
  std::uint64_t scenario_ = 0;  ///< the next fresh one
};

}  // namespace coppice
