#include "solvers/optimizers/cma_es_box.h"

#include <algorithm>
#include <cmath>

namespace coppice {
namespace {

bool has_width(const Axis& axis) {
  return std::isfinite(axis.low) && std::isfinite(axis.high);
}

/// Into [0, 1] by mirroring at both ends.
double mirrored(double u) {
  if (u >= 0 && u <= 1) return u;
  u = std::fabs(std::fmod(u, 2.0));  // exact
  return u > 1 ? 2 - u : u;
}

}  // namespace

std::vector<double> BoxMap::inside_out(std::span<const double> point) const {
  std::vector<double> coordinates(point.begin(), point.end());
  for (std::size_t i = 0; i < box_.size(); ++i) {
    const Axis& axis = box_[i];
    if (!has_width(axis)) continue;
    const double width = axis.high - axis.low;
    coordinates[i] = width > 0 ? (point[i] - axis.low) / width : 0.5;
  }
  return coordinates;
}

void BoxMap::into(std::span<const double> coordinates, std::span<double> point) const {
  for (std::size_t i = 0; i < box_.size(); ++i) {
    const Axis& axis = box_[i];
    double x = coordinates[i];
    if (has_width(axis)) {
      x = axis.low + (axis.high - axis.low) * mirrored(x);
    } else if (x < axis.low) {
      x = axis.low + (axis.low - x);
    } else if (x > axis.high) {
      x = axis.high - (x - axis.high);
    }
    point[i] = std::clamp(std::isfinite(x) ? x : centre(axis), axis.low, axis.high);
  }
}

bool BoxMap::contains(std::span<const double> coordinates) const {
  for (std::size_t i = 0; i < box_.size(); ++i) {
    const bool scaled = has_width(box_[i]);
    const double low = scaled ? 0 : box_[i].low, high = scaled ? 1 : box_[i].high;
    if (coordinates[i] < low || coordinates[i] > high) return false;
  }
  return true;
}

std::vector<double> BoxMap::start(std::span<const double> guess) const {
  std::vector<double> point(box_.size());
  for (std::size_t i = 0; i < box_.size(); ++i) {
    const bool given = i < guess.size() && std::isfinite(guess[i]);
    point[i] = given ? std::clamp(guess[i], box_[i].low, box_[i].high) : centre(box_[i]);
  }
  return point;
}

}  // namespace coppice
