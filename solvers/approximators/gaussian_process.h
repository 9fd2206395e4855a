#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/vocabulary/matrix.h"

namespace coppice {

/// The correlation of two samples: exp(-1/2 sum_k ((x_k - x'_k) / length_k)^2), and on the diagonal
/// 1 + noise / weight. `noise` is the variance of the noise in units of the process's own.
struct GaussianKernel {
  std::vector<double> lengths;
  double noise = 1e-6;
};

/// Limits of the search for a kernel.
struct GaussianTuning {
  std::vector<double> shortest, longest;  ///< lengths, one an input
  double noise_low = 1e-8, noise_high = 10;
  int evaluations = 60;  ///< of the likelihood, from each start
};

/// Mean and variance of the process at a place; the noise of a sample not included.
struct GaussianPosterior {
  double mean = 0;
  double variance = 0;
};

/// Gaussian process with an unknown constant mean and an unknown scale, both at their most likely values
/// given the kernel (Rasmussen and Williams 2006, 2.2 to 2.7, 5.4; Jones, Schonlau and Welch 1998, eqs. 5 and
/// 6). Samples are appended one by one at O(n^2) each; the bits do not depend on how they came.
class GaussianProcess {
 public:
  explicit GaussianProcess(GaussianKernel kernel) : kernel_(std::move(kernel)) {}

  std::size_t inputs() const { return kernel_.lengths.size(); }
  std::size_t size() const { return noise_.size(); }
  const GaussianKernel& kernel() const { return kernel_; }

  /// Adds a place; the weight divides the variance of its noise.
  void append(std::span<const double> x, double weight = 1);
  /// The values at all places so far; to be called before anything below.
  void set_values(std::span<const double> values);
  /// Forgets the factorization and makes it anew with another kernel; the values are to be set again.
  void set_kernel(GaussianKernel kernel);

  /// Log marginal likelihood at the most likely mean and scale. With a gradient (inputs() + 1 items): its
  /// derivatives by the logarithms of the lengths and of the noise; O(n^3).
  double log_likelihood(std::span<double> gradient = {}) const;

  GaussianPosterior posterior(std::span<const double> x) const;
  /// With the derivatives by x.
  GaussianPosterior posterior(std::span<const double> x, std::span<double> mean_gradient,
                              std::span<double> variance_gradient) const;

  std::span<const double> values() const { return values_; }
  double constant() const { return constant_; }  ///< the process's mean
  double scale() const { return scale_; }        ///< its variance
  std::span<const double> weights() const {
    return alpha_;
  }  ///< mean(x) = constant + sum weights_i corr(x, x_i)
  std::span<const double> place(std::size_t i) const { return {places_.data() + i * inputs(), inputs()}; }

 private:
  void correlations(std::span<const double> x, std::span<double> out) const;
  void factor_last();
  void solve_lower(std::vector<double>& b) const;  // b := L^-1 b
  void solve_upper(std::vector<double>& b) const;  // b := L^-T b
  std::vector<double> inverse() const;             // lower triangle of (L L^T)^-1, n x n by columns

  GaussianKernel kernel_;
  std::vector<double> places_;               // row after row
  std::vector<double> noise_;                // 1 / weight
  std::vector<std::vector<double>> factor_;  // L by columns: factor_[j][i - j]
  std::vector<double> values_, alpha_;
  double constant_ = 0, scale_ = 0;
};

/// Makes the kernel the most likely one within the limits: from the current one and `starts - 1` others
/// between the limits, always the same; the values must be set, and are after it.
void tune(GaussianProcess& process, const GaussianTuning& tuning, int starts);

}  // namespace coppice
