#pragma once

#include <vector>

#include "engine/vocabulary/archive.h"
#include "solvers/optimizers/cma_es_distribution.h"

namespace coppice {

/// Learning rates of the mean and of sigma^2 C that follow the signal-to-noise ratio of their updates:
/// LRA-CMA-ES (Nomura, Akimoto and Ono, GECCO 2023, arXiv 2304.03473, Algorithm 1, with the authors'
/// constants). Under noise the updates get so small that they average it out. Full covariance only.
class CmaLearningRates {
 public:
  explicit CmaLearningRates(std::size_t dimension);

  /// `after` is `before` updated as usual: makes its step shorter. False when it cannot be factorized.
  bool shorten(const CmaDistribution& before, CmaDistribution& after);
  double mean_rate() const { return mean_.rate; }
  double covariance_rate() const { return covariance_.rate; }

  void save(Archive& archive) const;
  void load(Archive& archive);

 private:
  /// Moving averages of an update and of its squared length, in the coordinates in which the distribution is
  /// standard (Eqs. 9 to 12), and the rate that follows from them.
  struct Follower {
    double decay;  ///< beta
    std::vector<double> average;
    double square = 0;
    double rate = 1;
    void follow(const std::vector<double>& update);
  };
  Follower mean_, covariance_;
  std::vector<double> update_;
};

}  // namespace coppice
