#include <cmath>
#include <stdexcept>

#include "engine/vocabulary/approximator.h"
#include "solvers/approximators/least_squares.h"

namespace coppice {
namespace {

/// L(A, B): x -> A x + B (thesis, 2.1.2).
class LinearFunction : public Function {
 public:
  LinearFunction() = default;
  LinearFunction(std::vector<double> slopes, std::vector<double> bias)
      : slopes_(std::move(slopes)), bias_(std::move(bias)) {}

  std::size_t inputs() const override { return bias_.empty() ? 0 : slopes_.size() / bias_.size(); }
  std::size_t outputs() const override { return bias_.size(); }
  void predict(std::span<const double> x, std::span<double> y) const override {
    for (std::size_t o = 0; o < bias_.size(); ++o) {
      double sum = bias_[o];
      for (std::size_t i = 0; i < x.size(); ++i) sum += slopes_[o * x.size() + i] * x[i];
      y[o] = sum;
    }
  }
  /// The corner of the box that the slopes point to; the centre where a slope is 0.
  Maximum maximize(std::span<const double> prefix, const Space& box, const Maximization&) const override {
    Maximum best;
    best.at.resize(box.size());
    best.value = bias_.front();
    for (std::size_t i = 0; i < prefix.size(); ++i) best.value += slopes_[i] * prefix[i];
    for (std::size_t i = 0; i < box.size(); ++i) {
      const double slope = slopes_[prefix.size() + i];
      best.at[i] = slope > 0 ? box[i].high : slope < 0 ? box[i].low : 0.5 * (box[i].low + box[i].high);
      best.value += slope * best.at[i];
    }
    return best;
  }
  FunctionModel exported() const override { return LinearModel{.slopes = slopes_, .bias = bias_}; }
  void save(Archive& archive) const override {
    archive.put("slopes", slopes_);
    archive.put("bias", bias_);
  }
  void load(Archive& archive) override {
    slopes_ = archive.get<std::vector<double>>("slopes");
    bias_ = archive.get<std::vector<double>>("bias");
    bool valid = !bias_.empty() && slopes_.size() % bias_.size() == 0;
    for (const double v : slopes_) valid = valid && std::isfinite(v);
    for (const double v : bias_) valid = valid && std::isfinite(v);
    if (!valid) throw std::runtime_error("not a valid linear function");
  }
  static Parameters<LinearFunction> parameters() { return {}; }

 private:
  std::vector<double> slopes_;  ///< outputs x inputs, row after row
  std::vector<double> bias_;
};

/// Least squares; inputs that do not vary or depend on others get small slopes (see Moments).
class LinearApproximator : public Approximator {
 public:
  MadeFunction fit(const TrainingSet& set, const Draws&, Parallel&) const override {
    const std::size_t inputs = set.x.columns(), outputs = set.y.columns();
    std::vector<double> slopes(inputs * outputs), bias(outputs), sample(inputs + 1);
    Moments moments(inputs);
    for (std::size_t o = 0; o < outputs; ++o) {
      const auto load = [&](std::size_t row) {
        set.x.row(row, std::span(sample).first(inputs));
        sample[inputs] = set.y(row, o);
      };
      load(0);
      moments.reset(sample);
      for (std::size_t i = 0; i < set.x.rows(); ++i) {
        load(i);
        moments.add(sample.data(), set.weights.empty() ? 1 : set.weights[i]);
      }
      moments.fit(bias[o], std::span(slopes).subspan(o * inputs, inputs));
    }
    return made<Function>(LinearFunction(std::move(slopes), std::move(bias)), "linear");
  }
  static Parameters<LinearApproximator> parameters() { return {}; }
};

const Component<Function, LinearFunction> kLinearFunction("linear", "A linear function.",
                                                          "L. Hofer's thesis (2017), 2.1.2");
const Component<Approximator, LinearApproximator> kLinearApproximator("linear", "Linear least squares.",
                                                                      "L. Hofer's thesis (2017), 2.1.2");

}  // namespace
}  // namespace coppice
