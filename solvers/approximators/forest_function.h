#pragma once

#include "engine/vocabulary/approximator.h"
#include "solvers/approximators/forest.h"

namespace coppice {

/// A regression forest as a function; the component `forest`. A tree is a forest of one.
class ForestFunction : public Function {
 public:
  static constexpr const char* kName = "forest";

  ForestFunction() = default;
  explicit ForestFunction(Forest forest) : forest_(std::move(forest)) {}

  std::size_t inputs() const override { return forest_.inputs(); }
  std::size_t outputs() const override { return forest_.outputs(); }
  void predict(std::span<const double> x, std::span<double> y) const override { forest_.predict(x, y); }
  void predict_batch(const Matrix& x, Matrix& y) const override;
  Maximum maximize(std::span<const double> prefix, const Space& box, const Maximization& how) const override;

  void save(Archive& archive) const override { forest_.save(archive); }
  void load(Archive& archive) override { forest_ = Forest::load(archive); }
  std::vector<std::pair<std::string, double>> facts() const override;

  FunctionModel exported() const override;

  const Forest& forest() const { return forest_; }
  static Parameters<ForestFunction> parameters() { return {}; }

 private:
  Forest forest_;
};

}  // namespace coppice
