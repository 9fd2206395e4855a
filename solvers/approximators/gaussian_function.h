#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/vocabulary/approximator.h"

namespace coppice {

/// What remains of one output's Gaussian process for predictions: a weighted sum of correlations with the
/// samples, on top of a linear function.
struct GaussianMean {
  double constant = 0;
  std::vector<double> slopes;   ///< of the mean, one an input
  std::vector<double> lengths;  ///< one an input
  std::vector<double> weights;  ///< one a sample
  double deviation = 0;         ///< of the process, in the output's unit
  double noise = 0;             ///< deviation of the noise, in the output's unit
};

/// The mean of Gaussian processes, one an output, over common samples; the component `gaussian_process`.
class GaussianFunction : public Function {
 public:
  static constexpr const char* kName = "gaussian_process";
  static constexpr std::size_t kMaxInputs = 64;

  GaussianFunction() = default;
  /// `places`: inputs of the samples, row after row.
  GaussianFunction(std::vector<double> places, std::vector<GaussianMean> means)
      : places_(std::move(places)), means_(std::move(means)) {}

  std::size_t inputs() const override { return means_.empty() ? 0 : means_.front().lengths.size(); }
  std::size_t outputs() const override { return means_.size(); }
  std::size_t samples() const { return means_.empty() ? 0 : means_.front().weights.size(); }
  void predict(std::span<const double> x, std::span<double> y) const override;
  /// Local searches (climb) from the three best of 16 + 16 box.size() places on a lattice, whatever `how`
  /// says: a local maximum of the function, as a rule the largest.
  Maximum maximize(std::span<const double> prefix, const Space& box, const Maximization& how) const override;
  void save(Archive& archive) const override;
  void load(Archive& archive) override;
  std::vector<std::pair<std::string, double>> facts() const override;
  static Parameters<GaussianFunction> parameters() { return {}; }

 private:
  /// Output `mean` at x, and, unless empty, its derivatives by the last gradient.size() inputs.
  double value(const GaussianMean& mean, std::span<const double> x, std::span<double> gradient) const;

  std::vector<double> places_;
  std::vector<GaussianMean> means_;
};

}  // namespace coppice
