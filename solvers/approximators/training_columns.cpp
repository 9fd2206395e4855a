#include "solvers/approximators/training_columns.h"

#include <algorithm>
#include <cmath>

namespace coppice {
namespace {

template <class Work>
void for_each_row(std::size_t rows, const std::vector<std::size_t>& kept, Work work) {
  if (kept.empty()) {
    for (std::size_t i = 0; i < rows; ++i) work(i, i);
  } else {
    for (std::size_t i = 0; i < rows; ++i) work(i, kept[i]);
  }
}

}  // namespace

TrainingColumns::TrainingColumns(const TrainingSet& set, const Directions& directions)
    : set_(set), rows_(set.x.rows()), directions_(directions.size()) {
  if (weighted()) {
    const double most = *std::max_element(set.weights.begin(), set.weights.end());
    weight_scale_ = std::ldexp(1.0, -std::max(std::ilogb(most), -1000));
    const auto counts = [&](double weight) { return static_cast<float>(weight * weight_scale_) > 0; };
    if (!std::all_of(set.weights.begin(), set.weights.end(), counts)) {
      for (std::size_t i = 0; i < rows_; ++i) {
        if (counts(set.weights[i])) kept_.push_back(i);
      }
      rows_ = kept_.size();
    }
  }
  for (std::size_t output = 0; output < set.y.columns(); ++output) scales_.push_back(scale_of(output));
  compute(directions);
}

// In double precision from the samples themselves, as predictions do it.
void TrainingColumns::compute(const Directions& directions) {
  oblique_.reserve(directions.size() * rows_);
  std::vector<double> value(directions.empty() ? 0 : rows_);
  for (std::size_t j = 0; j < directions.size(); ++j) {
    std::fill(value.begin(), value.end(), directions.offset(j));
    for (std::size_t c = 0; c < inputs(); ++c) {
      const double weight = directions.weights(j)[c];
      const auto x = set_.x.column(c);
      for_each_row(rows_, kept_, [&](std::size_t i, std::size_t row) { value[i] += weight * x[row]; });
    }
    std::transform(value.begin(), value.end(), std::back_inserter(oblique_), rounded_up);
  }
}

OutputScale TrainingColumns::scale_of(std::size_t output) const {
  const auto y = set_.y.column(output);
  ValueRange range;
  for_each_row(rows_, kept_, [&](std::size_t, std::size_t row) { range.include(y[row]); });
  return range.scale();
}

SampleBlock TrainingColumns::block(float* columns) const {
  SampleBlock block;
  block.columns = columns;
  block.inputs = inputs();
  block.directions = directions_;
  block.weighted = weighted();
  block.end = rows_;
  block.stride = (rows_ + 2 * kLanes - 1) / kLanes * kLanes;
  if (block.stride % 512 == 0)
    block.stride += kLanes;  // else columns compete for the same places of the cache
  return block;
}

std::size_t TrainingColumns::block_size() const {
  const SampleBlock block = this->block(nullptr);
  return block.stride * block.width();
}

void TrainingColumns::copy(const TreeKernels& kernels, std::size_t output, const SampleBlock& block) const {
  for (std::size_t c = 0; c < inputs(); ++c) {
    const auto from = set_.x.column(c);
    float* to = block.column(c);
    if (kept_.empty()) {
      kernels.round_up(from.data(), rows_, to);
    } else {
      for_each_row(rows_, kept_, [&](std::size_t i, std::size_t row) { to[i] = rounded_up(from[row]); });
    }
  }
  for (std::size_t j = 0; j < directions_; ++j)
    std::copy_n(oblique_.data() + j * rows_, rows_, block.column(block.first_direction() + j));
  const auto y = set_.y.column(output);
  const OutputScale scale = scales_[output];
  float* outputs = block.column(inputs());
  for_each_row(rows_, kept_, [&](std::size_t i, std::size_t row) { outputs[i] = scale.packed(y[row]); });
  if (!weighted()) return;
  float* weights = block.column(inputs() + 1);
  for_each_row(rows_, kept_, [&](std::size_t i, std::size_t row) {
    weights[i] = static_cast<float>(set_.weights[row] * weight_scale_);
  });
}

}  // namespace coppice
