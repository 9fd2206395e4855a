#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/vocabulary/archive.h"
#include "engine/vocabulary/random.h"
#include "solvers/optimizers/cma_es_box.h"
#include "solvers/optimizers/cma_es_rates.h"

namespace coppice {

/// The normal distribution of CMA-ES and its update after one generation. Samples are m + sigma L z with the
/// Cholesky factor L of the covariance C, in place of the tutorial's symmetric root: the path of the step
/// size needs no more than the mean of the z, and a factorization costs a thirtieth of an eigendecomposition,
/// so that every generation has its own (as Krause, Arbones and Igel, NIPS 2016). Sums have a fixed order.
class CmaDistribution {
 public:
  /// Standard covariance. `separable`: a diagonal one, with costs linear in the dimension.
  CmaDistribution(std::vector<double> mean, double sigma, bool separable);

  std::size_t dimension() const { return mean_.size(); }
  const std::vector<double>& mean() const { return mean_; }
  double sigma() const { return sigma_; }
  /// The largest deviation along an axis, and the ratio of the extreme variances of the factor: a lower bound
  /// of the condition number.
  double largest_deviation() const;
  double condition() const;

  /// Draws `count` samples, each again up to `attempts` times until it lies in the box: `steps` gets the z
  /// (one row of dimension() after the other), `points` the points.
  void sample(Stream& stream, const BoxMap& box, int attempts, std::size_t count, std::vector<double>& steps,
              std::vector<double>& points) const;
  /// The z of a point.
  void standardize(std::span<const double> point, std::span<double> step) const;

  /// One generation (tutorial, Eqs. 38 to 47). `steps`: the z of the candidates; `order`: their ranks, best
  /// first. False when the covariance is no longer positive definite, or the step size no positive number.
  bool update(const CmaRates& rates, std::span<const double> steps, std::span<const std::uint32_t> order);

  void save(Archive& archive) const;
  void load(Archive& archive);

 private:
  friend class CmaLearningRates;
  void apply_factor(std::span<const double> step, std::span<double> out) const;
  void update_paths(const CmaRates& rates, std::span<const double> steps,
                    std::span<const std::uint32_t> order);
  void update_full(const CmaRates& rates, std::span<const double> steps,
                   std::span<const std::uint32_t> order);
  void update_diagonal(const CmaRates& rates, std::span<const double> steps,
                       std::span<const std::uint32_t> order);
  bool factorize();

  bool separable_;
  std::vector<double> mean_;
  double sigma_;
  std::vector<double> covariance_;  ///< column-major lower triangle; separable: the diagonal
  std::vector<double> factor_;      ///< of the same form
  std::vector<double> path_sigma_, path_c_;
  std::int64_t generation_ = 0;
  bool long_step_ =
      false;  ///< the path of the step size is so long that the rank-one update waits (h_sigma = 0)
  std::vector<double> scratch_;
};

}  // namespace coppice
