#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

#include "solvers/approximators/forest_descent.h"

namespace coppice {
namespace {

constexpr std::size_t kAbreast = 8;
constexpr std::size_t kMaxPoints = 2048;
constexpr std::size_t kNumbers = 16384;     // of the points that are looked at together
constexpr std::size_t kAllNumbers = 16384;  // of their predictions by all trees
static_assert(kAbreast * (kMaxTreeInputs + 1) <= kNumbers);

/// Points that each tree is applied to while it is in the cache.
struct Points {
  std::size_t first;
  std::size_t size;
  std::size_t width;                      // features and one more
  std::array<float, kNumbers> rounded{};  // see place(); the input after the last is NaN
  std::array<double, kMaxPoints> sum;     // over trees
  std::array<double, kMaxPoints> low;     // for linear leaves
  std::array<double, kMaxPoints> high;
  std::vector<double> all;  // for trimmed means: each point's predictions of all trees
};

// Where input c of a point is: kAbreast points' after each other, then the next input.
std::size_t place(const Points& points, std::size_t point, std::size_t c) {
  return point / kAbreast * kAbreast * points.width + c * kAbreast + point % kAbreast;
}

void take(const Matrix& x, const Directions& directions, Points& points) {
  const auto round = [&points](std::size_t c, const double* column) {
    for (std::size_t i = 0; i < points.size; ++i) points.rounded[place(points, i, c)] = rounded_up(column[i]);
  };
  const std::size_t inputs = x.columns();
  for (std::size_t c = 0; c < inputs; ++c) round(c, x.column(c).data() + points.first);
  for (std::size_t j = 0; j < directions.size(); ++j) {
    double* value = points.sum.data();  // not in use yet
    std::fill(value, value + points.size, directions.offset(j));
    for (std::size_t c = 0; c < inputs; ++c) {
      const double weight = directions.weights(j)[c];
      const double* column = x.column(c).data() + points.first;
      for (std::size_t i = 0; i < points.size; ++i) value[i] += weight * column[i];
    }
    round(inputs + j, value);
  }
  const std::size_t whole = (points.size + kAbreast - 1) / kAbreast * kAbreast;
  for (std::size_t i = 0; i < whole; ++i) {
    points.rounded[place(points, i, points.width - 1)] = std::numeric_limits<float>::quiet_NaN();
  }
}

// Calls visit(point, leaf) for all points in a tree. What is behind the last point descends with it.
template <class Visit>
void for_each_leaf(const ForestTree& tree, const Points& points, const Visit& visit) {
  for (std::size_t i = 0; i < points.size; i += kAbreast) {
    std::array<std::uint64_t, kAbreast> at;
    at.fill(tree.root);
    const float* x = points.rounded.data() + i * points.width;
    descend(tree.nodes, at, [x](std::size_t p, std::uint32_t feature) { return x[feature * kAbreast + p]; });
    const std::size_t size = std::min(kAbreast, points.size - i);
    for (std::size_t p = 0; p < size; ++p) visit(i + p, static_cast<std::uint32_t>(at[p]));
  }
}

void add_constants(const ForestTree& tree, Points& points) {
  for_each_leaf(tree, points, [&](std::size_t point, std::uint32_t leaf) {
    points.sum[point] += static_cast<double>(tree.nodes[leaf].value);
  });
}

double linear_value(const ForestTree& tree, const double* model, const Matrix& x, std::size_t row) {
  double value = model[0];
  for (std::size_t c = 0; c < tree.inputs; ++c) value += model[1 + c] * x(row, c);
  return value;
}

// Held in its range.
double held_value(const ForestTree& tree, const double* model, const Matrix& x, std::size_t row) {
  return std::clamp(linear_value(tree, model, x, row), model[tree.inputs + 1], model[tree.inputs + 2]);
}

void add_linear(const ForestTree& tree, const Matrix& x, Points& points) {
  for_each_leaf(tree, points, [&](std::size_t point, std::uint32_t leaf) {
    const double* model = tree.model(leaf);
    points.sum[point] += linear_value(tree, model, x, points.first + point);
    points.low[point] += model[tree.inputs + 1];
    points.high[point] += model[tree.inputs + 2];
  });
}

// Sums run over the trees in their order, as in predict: the results are the same.
void average(const Forest& forest, std::size_t output, const Matrix& x, Points& points,
             std::span<double> means) {
  const bool constant = forest.leaf() == LeafModel::constant;
  points.sum.fill(0);
  points.low.fill(0);
  points.high.fill(0);
  for (std::size_t t = 0; t < forest.trees(); ++t) {
    if (constant) {
      add_constants(forest.tree(output, t), points);
    } else {
      add_linear(forest.tree(output, t), x, points);
    }
  }
  const auto count = static_cast<double>(forest.trees());
  const OutputScale scale = forest.tree(output, 0).scale;
  for (std::size_t i = 0; i < points.size; ++i) {
    means[i] = constant ? scale.offset + scale.scale * (points.sum[i] / count)
                        : std::clamp(points.sum[i], points.low[i], points.high[i]) / count;
  }
}

void trim(const Forest& forest, std::size_t output, const Matrix& x, Points& points,
          std::span<double> means) {
  const bool constant = forest.leaf() == LeafModel::constant;
  const std::size_t count = forest.trees();
  points.all.resize(points.size * count);
  for (std::size_t t = 0; t < count; ++t) {
    const ForestTree tree = forest.tree(output, t);
    for_each_leaf(tree, points, [&](std::size_t point, std::uint32_t leaf) {
      points.all[point * count + t] = constant ? static_cast<double>(tree.nodes[leaf].value)
                                               : held_value(tree, tree.model(leaf), x, points.first + point);
    });
  }
  const OutputScale scale = forest.tree(output, 0).scale;
  for (std::size_t i = 0; i < points.size; ++i) {
    const double mean = trimmed_mean(std::span(points.all).subspan(i * count, count));
    means[i] = constant ? scale.offset + scale.scale * mean : mean;
  }
}

}  // namespace

void Forest::predict_batch(const Matrix& x, Matrix& y) const {
  assert(x.columns() == inputs_ && y.columns() == outputs() && x.rows() == y.rows());
  thread_local Points points;
  points.width = features() + 1;
  const bool trims = aggregation_ == Aggregation::trimmed_mean;
  const std::size_t wanted =
      trims ? std::min(kNumbers / points.width, kAllNumbers / trees()) : kNumbers / points.width;
  const std::size_t at_once = std::clamp(wanted / kAbreast * kAbreast, kAbreast, kMaxPoints);
  for (points.first = 0; points.first < x.rows(); points.first += at_once) {
    points.size = std::min(at_once, x.rows() - points.first);
    take(x, directions_, points);
    for (std::size_t output = 0; output < outputs(); ++output) {
      const std::span<double> means = y.column(output).subspan(points.first, points.size);
      if (trims) {
        trim(*this, output, x, points, means);
      } else {
        average(*this, output, x, points, means);
      }
    }
  }
}

}  // namespace coppice
