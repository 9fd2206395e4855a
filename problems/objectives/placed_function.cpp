#include "problems/objectives/placed_function.h"

#include <cmath>

#include "engine/vocabulary/elementary.h"

namespace coppice {
namespace {

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Rows made orthonormal from normal ones are uniformly distributed (Stewart, SIAM Journal on Numerical
/// Analysis 17(3), 1980). Projecting twice keeps them orthogonal to rounding.
std::vector<double> random_rotation(std::size_t n, Stream stream) {
  std::vector<double> rotation(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::span<double> row{&rotation[i * n], n};
    for (double& x : row) x = stream.normal();
    for (std::size_t k = 0; k < 2 * i; ++k) {
      const std::span<const double> done{&rotation[k % i * n], n};
      const double part = dot(row, done);
      for (std::size_t j = 0; j < n; ++j) row[j] -= part * done[j];
    }
    const double length = std::sqrt(dot(row, row));
    for (double& x : row) x /= length;
  }
  return rotation;
}

}  // namespace

Frame::Frame(std::size_t n, double spread, Axes axes, const Draws& draws) {
  Stream stream = draws.stream("optimum");
  for (std::size_t i = 0; i < n; ++i) optimum_.push_back(stream.uniform(-spread, spread));
  if (axes == Axes::turned) rotation_ = random_rotation(n, draws.stream("rotation"));
}

double Frame::z(std::span<const double> x, std::size_t i) const {
  if (rotation_.empty()) return x[i] - optimum_[i];
  const std::span<const double> turned = row(i);
  double sum = 0;
  for (std::size_t j = 0; j < x.size(); ++j) sum += turned[j] * (x[j] - optimum_[j]);
  return sum;
}

std::vector<double> ellipsoid_weights(std::size_t n, double condition) {
  std::vector<double> weights;
  for (std::size_t i = 0; i < n; ++i) {
    const double share = n == 1 ? 0 : static_cast<double>(i) / static_cast<double>(n - 1);
    weights.push_back(elementary::pow(condition, share));
  }
  return weights;
}

}  // namespace coppice
