#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "engine/vocabulary/optimizer.h"

namespace coppice::benchmark {

/// A function of the tables in docs/optimizers.md, to be made small: optimum uniform in [-2, 2]^n, start
/// uniform in
/// [-4, 4]^n, rotation uniform, all drawn from the seed; N(0, noise) is added to each evaluation
/// independently of its scenario.
class TestFunction {
 public:
  TestFunction(const std::string& name, std::size_t n, std::uint64_t seed, double noise = 0)
      : noise_(noise), stream_(Draws(seed, "test_function", 0).stream("noise")) {
    Stream stream = Draws(seed, "test_function", 0).stream("setting");
    for (std::size_t i = 0; i < n; ++i) guess_.push_back(stream.uniform(-4, 4));
    for (std::size_t i = 0; i < n; ++i) optimum_.push_back(stream.uniform(-2, 2));
    kind_ = name.starts_with("ellipsoid")    ? 'e'
            : name.starts_with("rosenbrock") ? 'b'
            : name.starts_with("rastrigin")  ? 'r'
                                             : 's';
    if (name.ends_with("_rot")) rotate(stream, n);
    for (std::size_t i = 0; i < n; ++i) {
      scales_.push_back(std::pow(1e6, static_cast<double>(i) / static_cast<double>(n - 1)));
    }
    z_.resize(n);
    shifted_.resize(n);
  }

  const std::vector<double>& guess() const { return guess_; }
  const std::vector<double>& optimum() const { return optimum_; }
  double noisy(const double* x, std::size_t stride) {
    const double value = exact(x, stride);
    return noise_ > 0 ? value + noise_ * stream_.normal() : value;
  }
  double exact(const double* x, std::size_t stride) {
    const std::size_t n = guess_.size();
    for (std::size_t i = 0; i < n; ++i) shifted_[i] = x[i * stride] - optimum_[i];
    if (rotation_.empty()) {
      z_ = shifted_;
    } else {
      for (std::size_t i = 0; i < n; ++i) {
        z_[i] = 0;
        for (std::size_t j = 0; j < n; ++j) z_[i] += rotation_[i][j] * shifted_[j];
      }
    }
    double sum = 0;
    if (kind_ == 's') {
      for (const double z : z_) sum += z * z;
    } else if (kind_ == 'e') {
      for (std::size_t i = 0; i < n; ++i) sum += scales_[i] * z_[i] * z_[i];
    } else if (kind_ == 'r') {
      for (const double z : z_) sum += 10 + z * z - 10 * std::cos(2 * std::numbers::pi * z);
    } else {
      for (std::size_t i = 0; i + 1 < n; ++i) {
        const double a = z_[i] + 1, b = z_[i + 1] + 1;
        sum += 100 * (b - a * a) * (b - a * a) + (1 - a) * (1 - a);
      }
    }
    return sum;
  }

 private:
  void rotate(Stream& stream, std::size_t n) {  // Gram-Schmidt of normal vectors
    rotation_.assign(n, std::vector<double>(n));
    for (std::size_t i = 0; i < n; ++i) {
      std::vector<double>& row = rotation_[i];
      for (double& x : row) x = stream.normal();
      for (std::size_t k = 0; k < i; ++k) {
        double product = 0;
        for (std::size_t j = 0; j < n; ++j) product += row[j] * rotation_[k][j];
        for (std::size_t j = 0; j < n; ++j) row[j] -= product * rotation_[k][j];
      }
      double square = 0;
      for (const double x : row) square += x * x;
      for (double& x : row) x /= std::sqrt(square);
    }
  }

  char kind_ = 's';
  double noise_;
  Stream stream_;
  std::vector<double> guess_, optimum_, scales_, z_, shifted_;
  std::vector<std::vector<double>> rotation_;
};

}  // namespace coppice::benchmark
