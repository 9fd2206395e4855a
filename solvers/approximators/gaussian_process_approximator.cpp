#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "solvers/approximators/gaussian_function.h"
#include "solvers/approximators/gaussian_process.h"
#include "solvers/approximators/least_squares.h"

namespace coppice {
namespace {

using Rows = std::vector<std::size_t>;

/// `count` of the rows, each choice equally likely, in their order.
Rows drawn(Rows rows, std::size_t count, Stream stream) {
  if (rows.size() <= count) return rows;
  for (std::size_t i = 0; i < count; ++i) std::swap(rows[i], rows[i + stream.below(rows.size() - i)]);
  rows.resize(count);
  std::sort(rows.begin(), rows.end());
  return rows;
}

/// Gaussian process regression, each output on its own.
class GaussianProcessApproximator : public Approximator {
 public:
  enum class Mean { constant, linear };
  enum class Beyond { error, draw };
  Mean mean = Mean::constant;
  int max_samples = 1000;
  Beyond beyond = Beyond::error;
  int tuning_samples = 300;
  int starts = 3;

  MadeFunction fit(const TrainingSet& set, const Draws& draws, Parallel& parallel) const override {
    const std::size_t inputs = set.x.columns(), outputs = set.y.columns();
    if (inputs < 1 || inputs > GaussianFunction::kMaxInputs) {
      throw std::invalid_argument("a Gaussian process takes 1 to " +
                                  std::to_string(GaussianFunction::kMaxInputs) + " inputs, not " +
                                  std::to_string(inputs));
    }
    const Rows rows = used_rows(set, draws);
    std::vector<double> places(rows.size() * inputs);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      set.x.row(rows[i], std::span(places).subspan(i * inputs, inputs));
    }
    std::vector<GaussianMean> means(outputs);
    parallel.for_each(outputs, [&](std::size_t o) { means[o] = fit_output(set, rows, o, draws); });
    return made<Function>(GaussianFunction(std::move(places), std::move(means)), GaussianFunction::kName);
  }

  static Parameters<GaussianProcessApproximator> parameters() {
    using T = GaussianProcessApproximator;
    return Parameters<T>()
        .choice("mean", &T::mean, {"constant", "linear"},
                "What the process is about: a constant, or the linear least squares fit.")
        .add("max_samples", &T::max_samples, "",
             "Samples at most: time grows with their cube (1000 take about a second), memory with their "
             "square, and a prediction with their number.",
             between(1, 10000))
        .choice("beyond", &T::beyond, {"error", "draw"},
                "What becomes of more samples than max_samples: an error, or max_samples of them are drawn.")
        .add("tuning_samples", &T::tuning_samples, "",
             "Samples at most, drawn, for the search for the most likely lengths and noise.",
             between(1, 10000))
        .add("starts", &T::starts, "", "Starts of that search.", between(1, 100));
  }

 private:
  Rows used_rows(const TrainingSet& set, const Draws& draws) const {
    Rows rows;
    for (std::size_t i = 0; i < set.x.rows(); ++i) {
      if (set.weights.empty() || set.weights[i] > 0) rows.push_back(i);
    }
    const auto limit = static_cast<std::size_t>(max_samples);
    if (rows.size() > limit && beyond == Beyond::error) {
      throw std::invalid_argument("<gaussian_process> was given " + std::to_string(rows.size()) +
                                  " samples, more than max_samples=\"" + std::to_string(max_samples) +
                                  "\"; raise it (time grows with the cube), or set beyond=\"draw\" to use a "
                                  "random part of them");
    }
    return drawn(std::move(rows), limit, draws.stream("gaussian_samples"));
  }

  static double weight(const TrainingSet& set, std::size_t row) {
    return set.weights.empty() ? 1 : set.weights[row];
  }

  /// The process of the given rows, with values set.
  static GaussianProcess process(const TrainingSet& set, const Rows& rows, std::span<const double> residuals,
                                 GaussianKernel kernel) {
    GaussianProcess process(std::move(kernel));
    std::vector<double> x(set.x.columns()), values;
    for (const std::size_t row : rows) {
      set.x.row(row, x);
      process.append(x, weight(set, row));
      values.push_back(residuals[row]);
    }
    process.set_values(values);
    return process;
  }

  GaussianMean fit_output(const TrainingSet& set, const Rows& rows, std::size_t output,
                          const Draws& draws) const {
    GaussianMean result;
    const std::vector<double> residuals = remove_mean(set, rows, output, result);
    const GaussianTuning limits = tuning(set, rows);
    GaussianKernel kernel;
    for (const double longest : limits.longest) kernel.lengths.push_back(longest / 40);
    kernel.noise = 1e-2;
    GaussianProcess part = process(
        set, drawn(rows, static_cast<std::size_t>(tuning_samples), draws.stream("gaussian_tuning", output)),
        residuals, kernel);
    // Residuals of rounding's size: the mean explains all.
    double size = 0;
    for (const std::size_t row : rows) size = std::max(size, std::abs(set.y(row, output)));
    if (std::sqrt(part.scale()) > 1e-13 * size) tune(part, limits, starts);

    const GaussianProcess whole = process(set, rows, residuals, part.kernel());
    result.constant += whole.constant();
    result.lengths = whole.kernel().lengths;
    result.weights.assign(whole.weights().begin(), whole.weights().end());
    result.deviation = std::sqrt(whole.scale());
    result.noise = std::sqrt(whole.scale() * whole.kernel().noise);
    return result;
  }

  /// Fits the linear mean, if there is one; what it leaves, by row of the set.
  std::vector<double> remove_mean(const TrainingSet& set, const Rows& rows, std::size_t output,
                                  GaussianMean& result) const {
    const std::size_t inputs = set.x.columns();
    result.slopes.assign(inputs, 0.0);
    std::vector<double> residuals(set.y.column(output).begin(), set.y.column(output).end());
    if (mean == Mean::constant) return residuals;
    Moments moments(inputs);
    std::vector<double> sample(inputs + 1);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      set.x.row(rows[i], std::span(sample).first(inputs));
      sample[inputs] = set.y(rows[i], output);
      if (i == 0) moments.reset(sample);
      moments.add(sample.data(), weight(set, rows[i]));
    }
    moments.fit(result.constant, result.slopes);
    for (std::size_t row = 0; row < residuals.size(); ++row) {
      residuals[row] -= result.constant;
      for (std::size_t k = 0; k < inputs; ++k) residuals[row] -= result.slopes[k] * set.x(row, k);
    }
    return residuals;
  }

  /// Lengths from 1/100 to 20 times the range of the samples; an input that does not vary is as good as
  /// absent.
  static GaussianTuning tuning(const TrainingSet& set, const Rows& rows) {
    GaussianTuning tuning;
    for (std::size_t k = 0; k < set.x.columns(); ++k) {
      double low = set.x(rows.front(), k), high = low;
      for (const std::size_t row : rows) {
        low = std::min(low, set.x(row, k));
        high = std::max(high, set.x(row, k));
      }
      const double range = high > low ? high - low : 1;
      tuning.shortest.push_back(0.01 * range);
      tuning.longest.push_back(20 * range);
    }
    return tuning;
  }
};

const Component<Approximator, GaussianProcessApproximator> kGaussianProcessApproximator(
    "gaussian_process",
    "Gaussian process: squared exponential with a length per input, and noise, the most likely ones.",
    "Rasmussen and Williams, Gaussian Processes for Machine Learning (2006), 2.2, 5.4");

}  // namespace
}  // namespace coppice
