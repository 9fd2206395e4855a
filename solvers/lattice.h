#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace coppice {

/// Evenly spread points in [0, 1)^n: multiples of the powers of 1/phi_n, modulo 1, where phi_n is the
/// positive root of x^(n+1) = x + 1 (M. Roberts, The unreasonable effectiveness of quasirandom sequences,
/// 2018). The first point is the centre.
class Lattice {
 public:
  explicit Lattice(std::size_t dimensions) {
    double phi = 1.5;  // Newton's method; converges to the last bit
    for (int round = 0; round < 30; ++round) {
      double power = 1;
      for (std::size_t i = 0; i < dimensions; ++i) power *= phi;
      phi -= (power * phi - phi - 1) / (static_cast<double>(dimensions + 1) * power - 1);
    }
    double step = 1;
    for (std::size_t i = 0; i < dimensions; ++i) steps_.push_back(step /= phi);
  }
  double operator()(std::size_t point, std::size_t axis) const {
    const double at = 0.5 + static_cast<double>(point) * steps_[axis];
    return at - std::floor(at);
  }

 private:
  std::vector<double> steps_;
};

}  // namespace coppice
