#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

#include "solvers/approximators/forest_descent.h"

namespace coppice {
namespace {

constexpr std::size_t kAbreast = 8;
constexpr std::size_t kMaxPoints = 256;
constexpr std::size_t kNumbers = 4096;  // of the points that are looked at together
static_assert(kAbreast * (kMaxTreeInputs + 1) <= kNumbers);

/// Points that each tree is applied to while it is in the cache.
struct Points {
  std::size_t first;
  std::size_t size;
  std::size_t width;                    // of a row below
  std::array<float, kNumbers> rounded;  // rows, with a NaN in the end
  std::array<double, kMaxPoints> sum;   // over trees
  std::array<double, kMaxPoints> low;   // for linear leaves
  std::array<double, kMaxPoints> high;
};

void take(const Matrix& x, Points& points) {
  for (std::size_t c = 0; c + 1 < points.width; ++c) {
    const double* column = x.column(c).data() + points.first;
    for (std::size_t i = 0; i < points.size; ++i)
      points.rounded[i * points.width + c] = rounded_up(column[i]);
  }
  for (std::size_t i = 0; i < points.size; ++i) {
    points.rounded[(i + 1) * points.width - 1] = std::numeric_limits<float>::quiet_NaN();
  }
}

// Calls visit(point, leaf) for all points in a tree.
template <class Visit>
void for_each_leaf(const ForestTree& tree, const Points& points, const Visit& visit) {
  for (std::size_t i = 0; i < points.size; i += kAbreast) {
    const std::size_t size = std::min(kAbreast, points.size - i);
    std::array<std::uint32_t, kAbreast> at;
    at.fill(tree.root);
    const float* row = points.rounded.data() + i * points.width;
    if (size == kAbreast) {
      descend(tree.nodes, at, [&](std::size_t p) { return row + p * points.width; });
    } else {
      descend(tree.nodes, at, [&](std::size_t p) { return row + (p < size ? p : 0) * points.width; });
    }
    for (std::size_t p = 0; p < size; ++p) visit(i + p, at[p]);
  }
}

void add_constants(const ForestTree& tree, Points& points) {
  for_each_leaf(tree, points, [&](std::size_t point, std::uint32_t leaf) {
    points.sum[point] += static_cast<double>(tree.nodes[leaf].value);
  });
}

void add_linear(const ForestTree& tree, const Matrix& x, Points& points) {
  for_each_leaf(tree, points, [&](std::size_t point, std::uint32_t leaf) {
    const double* model = tree.model(leaf);
    double value = model[0];
    for (std::size_t c = 0; c < tree.inputs; ++c) value += model[1 + c] * x(points.first + point, c);
    points.sum[point] += value;
    points.low[point] += model[tree.inputs + 1];
    points.high[point] += model[tree.inputs + 2];
  });
}

}  // namespace

// Sums run over the trees in their order, as in predict: the results are the same.
void Forest::predict_batch(const Matrix& x, Matrix& y) const {
  assert(x.columns() == inputs_ && y.columns() == outputs() && x.rows() == y.rows());
  Points points;
  points.width = inputs_ + 1;
  const std::size_t at_once = std::min(kMaxPoints, kNumbers / points.width / kAbreast * kAbreast);
  const auto count = static_cast<double>(trees());
  for (points.first = 0; points.first < x.rows(); points.first += at_once) {
    points.size = std::min(at_once, x.rows() - points.first);
    take(x, points);
    for (std::size_t output = 0; output < outputs(); ++output) {
      points.sum.fill(0);
      points.low.fill(0);
      points.high.fill(0);
      for (std::size_t t = 0; t < trees(); ++t) {
        if (leaf_ == LeafModel::constant) {
          add_constants(tree(output, t), points);
        } else {
          add_linear(tree(output, t), x, points);
        }
      }
      const OutputScale scale = scales_[output];
      for (std::size_t i = 0; i < points.size; ++i) {
        y(points.first + i, output) = leaf_ == LeafModel::constant
                                          ? scale.offset + scale.scale * (points.sum[i] / count)
                                          : std::clamp(points.sum[i], points.low[i], points.high[i]) / count;
      }
    }
  }
}

}  // namespace coppice
