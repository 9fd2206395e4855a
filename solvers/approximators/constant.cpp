#include <cmath>
#include <stdexcept>

#include "engine/vocabulary/approximator.h"

namespace coppice {
namespace {

/// C(y): the same outputs everywhere (thesis, 2.1.2).
class ConstantFunction : public Function {
 public:
  ConstantFunction() = default;
  ConstantFunction(std::size_t inputs, std::vector<double> value)
      : inputs_(inputs), value_(std::move(value)) {}

  std::size_t inputs() const override { return inputs_; }
  std::size_t outputs() const override { return value_.size(); }
  void predict(std::span<const double>, std::span<double> y) const override {
    std::copy(value_.begin(), value_.end(), y.begin());
  }
  /// All places are equally good; takes the centre, as of a constant leaf (Algorithm 14).
  Maximum maximize(std::span<const double>, const Space& box, const Maximization&) const override {
    Maximum best;
    best.at.resize(box.size());
    for (std::size_t i = 0; i < box.size(); ++i) best.at[i] = 0.5 * (box[i].low + box[i].high);
    best.value = value_.front();
    return best;
  }
  FunctionModel exported() const override { return ConstantModel{value_}; }
  void save(Archive& archive) const override {
    archive.put("inputs", std::vector<std::int64_t>{static_cast<std::int64_t>(inputs_)});
    archive.put("value", value_);
  }
  void load(Archive& archive) override {
    const auto& inputs = archive.get<std::vector<std::int64_t>>("inputs");
    value_ = archive.get<std::vector<double>>("value");
    bool valid = inputs.size() == 1 && inputs.front() >= 0 && !value_.empty();
    for (const double v : value_) valid = valid && std::isfinite(v);
    if (!valid) throw std::runtime_error("not a valid constant function");
    inputs_ = static_cast<std::size_t>(inputs.front());
  }
  static Parameters<ConstantFunction> parameters() { return {}; }

 private:
  std::size_t inputs_ = 0;
  std::vector<double> value_;
};

/// The weighted mean of the outputs, which is the least squares fit.
class ConstantApproximator : public Approximator {
 public:
  MadeFunction fit(const TrainingSet& set, const Draws&, Parallel&) const override {
    std::vector<double> mean;
    for (std::size_t c = 0; c < set.y.columns(); ++c) {
      double sum = 0, weight = 0;
      for (std::size_t i = 0; i < set.y.rows(); ++i) {
        const double w = set.weights.empty() ? 1 : set.weights[i];
        sum += w * set.y(i, c);
        weight += w;
      }
      mean.push_back(sum / weight);
    }
    return made<Function>(ConstantFunction(set.x.columns(), std::move(mean)), "constant");
  }
  static Parameters<ConstantApproximator> parameters() { return {}; }
};

const Component<Function, ConstantFunction> kConstantFunction("constant", "The same value everywhere.",
                                                              "L. Hofer's thesis (2017), 2.1.2");
const Component<Approximator, ConstantApproximator> kConstantApproximator("constant",
                                                                          "The mean of the samples' outputs.",
                                                                          "L. Hofer's thesis (2017), 2.1.2");

}  // namespace
}  // namespace coppice
