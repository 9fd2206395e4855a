#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace coppice {

/// Sums of weighted samples (x, y) about a fixed centre, and the least squares fits that follow from them.
/// Sums run in the order of the samples, so that equal samples give equal bits. Memory is allocated by the
/// constructor only.
class Moments {
 public:
  explicit Moments(std::size_t inputs);

  /// Forgets all samples; `centre` is about where the samples lie: x, then y (inputs + 1 numbers).
  void reset(std::span<const double> centre);
  /// Adds a sample: x, then y.
  void add(const double* xy, double weight);
  /// The samples whose weighted sums of products of 1, the inputs and the output, the latter two about
  /// `centre`, are these: a lower triangle, row after row.
  void set(std::span<const float> centre, std::span<const double> products);
  /// The samples of `whole` that are not in `part`; all three have the same centre.
  void set_difference(const Moments& whole, const Moments& part);

  double weight() const { return weight_; }
  /// Fits y = bias + slopes . x and returns the weighted sum of squared residuals. Inputs that do not vary
  /// get slope 0; when inputs depend on each other linearly, a ridge of kRidge times their variance picks
  /// small slopes.
  double fit(double& bias, std::span<double> slopes);
  /// The same sum of squares of a fit to sums in single precision, without the fit itself.
  double residual() { return solve(kDependentSingle); }

  static constexpr double kRidge = 1e-6;

 private:
  // A direction with less than this part of its variance left, given the inputs before it, counts as
  // dependent.
  static constexpr double kDependent = 1e-10;
  static constexpr double kDependentSingle = 1e-5;

  double central(std::size_t i, std::size_t j) const;
  double solve(double dependent);
  bool factor(double ridge, double dependent);

  std::size_t size_;  // inputs + 1
  double weight_ = 0;
  std::vector<double> centre_;
  std::vector<double> sum_;
  std::vector<double> product_;  // lower triangle, row after row
  std::vector<double> scale_;
  std::vector<double> correlation_;
  std::vector<double> cholesky_;
  std::vector<double> solution_;
};

}  // namespace coppice
