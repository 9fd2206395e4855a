#pragma once

#include <vector>

#include "engine/vocabulary/approximator.h"
#include "solvers/approximators/forest.h"
#include "solvers/approximators/tree_kernels.h"

namespace coppice {

/// How a training set becomes columns in single precision: inputs rounded up, outputs relative to their
/// scale, weights times a power of 2; directions as inputs. Samples whose weight is 0 then are left out.
class TrainingColumns {
 public:
  explicit TrainingColumns(const TrainingSet& set, const Directions& directions = {});

  std::size_t rows() const { return rows_; }
  std::size_t inputs() const { return set_.x.columns(); }
  /// Inputs and directions.
  std::size_t features() const { return inputs() + directions_; }
  /// The column of a block that holds a feature, and back.
  std::uint32_t column_of(std::uint32_t feature) const {
    return feature < inputs() ? feature : feature + (weighted() ? 2 : 1);
  }
  std::uint32_t feature_of(std::uint32_t column) const {
    return column < inputs() ? column : column - (weighted() ? 2 : 1);
  }
  bool weighted() const { return !set_.weights.empty(); }
  const std::vector<OutputScale>& scales() const { return scales_; }

  /// A block of all samples for one output, whose columns have to be allocated: block_size() numbers.
  SampleBlock block(float* columns) const;
  std::size_t block_size() const;
  void copy(const TreeKernels& kernels, std::size_t output, const SampleBlock& block) const;

 private:
  OutputScale scale_of(std::size_t output) const;
  void compute(const Directions& directions);

  const TrainingSet& set_;
  std::vector<std::size_t> kept_;  ///< rows, when some are left out
  std::size_t rows_ = 0;
  double weight_scale_ = 1;
  std::vector<OutputScale> scales_;
  std::size_t directions_ = 0;
  std::vector<float> oblique_;  ///< directions at the samples, column after column
};

}  // namespace coppice
