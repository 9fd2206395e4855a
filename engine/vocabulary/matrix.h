#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace coppice {

/// A table of doubles, column-major: each column (a feature over all samples) is contiguous.
class Matrix {
 public:
  Matrix() = default;
  Matrix(std::size_t rows, std::size_t columns) : rows_(rows), columns_(columns), values_(rows * columns) {}

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  double& operator()(std::size_t row, std::size_t column) { return values_[column * rows_ + row]; }
  double operator()(std::size_t row, std::size_t column) const { return values_[column * rows_ + row]; }
  std::span<double> column(std::size_t c) { return {values_.data() + c * rows_, rows_}; }
  std::span<const double> column(std::size_t c) const { return {values_.data() + c * rows_, rows_}; }
  std::span<const double> values() const { return values_; }
  std::span<double> values() { return values_; }
  /// Copies row `row` to `out`, which has columns() items.
  void row(std::size_t row, std::span<double> out) const {
    for (std::size_t c = 0; c < columns_; ++c) out[c] = (*this)(row, c);
  }
  void set_row(std::size_t row, std::span<const double> in) {
    for (std::size_t c = 0; c < columns_; ++c) (*this)(row, c) = in[c];
  }
  friend bool operator==(const Matrix&, const Matrix&) = default;

 private:
  std::size_t rows_ = 0;
  std::size_t columns_ = 0;
  std::vector<double> values_;
};

}  // namespace coppice
