#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/vocabulary/approximator.h"

namespace coppice {

/// What trees may split by besides the inputs themselves: linear functions of them, the directions of oblique
/// splits. Direction j says offset + w . x, summed from the left in double precision. Trees that share a
/// table of directions know number j of it as input number `inputs + j`.
class Directions {
 public:
  Directions() = default;
  explicit Directions(std::size_t inputs) : inputs_(inputs) {}

  void clear(std::size_t inputs) {
    inputs_ = inputs;
    rows_.clear();
    size_ = 0;
  }
  void reserve(std::size_t size) { rows_.reserve(size * (inputs_ + 1)); }
  /// A row that the caller fills: offset, then a weight for each input; 0 so far.
  double* add() {
    ++size_;
    rows_.resize(rows_.size() + inputs_ + 1);
    return rows_.data() + rows_.size() - inputs_ - 1;
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  double offset(std::size_t j) const { return rows_[j * (inputs_ + 1)]; }
  std::span<const double> weights(std::size_t j) const {
    return std::span(rows_).subspan(j * (inputs_ + 1) + 1, inputs_);
  }
  double value(std::size_t j, const double* x) const {
    const double* row = rows_.data() + j * (inputs_ + 1);
    double value = row[0];
    for (std::size_t i = 0; i < inputs_; ++i) value += row[1 + i] * x[i];
    return value;
  }
  /// Row after row: offset and weights.
  const std::vector<double>& rows() const { return rows_; }

  friend bool operator==(const Directions& a, const Directions& b) { return a.rows_ == b.rows_; }

 private:
  std::size_t inputs_ = 0;
  std::size_t size_ = 0;
  std::vector<double> rows_;
};

/// Directions that are uniform on the sphere of the standardized inputs: each is 0 at the samples' mean and
/// would have deviation 1 if inputs were independent. Inputs that do not vary have no part in them.
Directions draw_directions(const TrainingSet& set, std::size_t size, const Draws& draws);

}  // namespace coppice
