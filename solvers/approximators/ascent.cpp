#include "solvers/approximators/ascent.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/vocabulary/elementary.h"

namespace coppice {
namespace {

// Chosen by what the best of them misses and costs (docs/architecture.md).
constexpr std::size_t kProbesPerAxis = 16;
constexpr std::size_t kStarts = 3;
constexpr int kMostRounds = 20;

}  // namespace

Maximum Ascent::over(const Forest& forest, std::span<const double> prefix, const Space& box) {
  first_ = prefix.size();
  x_.assign(prefix.begin(), prefix.end());
  x_.resize(forest.inputs());
  values_.resize(forest.outputs());
  if (steps_.size() != box.size()) spread(box.size());
  choose_starts(forest, box);
  Maximum best;
  best.at.resize(box.size());
  for (std::size_t i = 0; i < std::min(kStarts, starts_.size()); ++i) {
    place(starts_[i].number, box);
    const double value = climb(forest, box);
    if (i > 0 && !(value > best.value)) continue;
    best.value = value;
    std::copy(x_.begin() + static_cast<std::ptrdiff_t>(first_), x_.end(), best.at.begin());
  }
  return best;
}

// Powers of 1 / g, where g > 1 and g^(n + 1) = g + 1: the golden ratio for n = 1 (M. Roberts 2018, "The
// unreasonable effectiveness of quasirandom sequences").
void Ascent::spread(std::size_t n) {
  double g = 1.5;
  for (int i = 0; i < 60; ++i) g = elementary::pow(1 + g, 1 / static_cast<double>(n + 1));
  steps_.clear();
  for (double step = 1 / g; steps_.size() < n; step /= g) steps_.push_back(step);
}

void Ascent::place(std::size_t number, const Space& box) {
  for (std::size_t i = 0; i < box.size(); ++i) {
    const double part = 0.5 + static_cast<double>(number) * steps_[i];
    const double width = box[i].high - box[i].low;
    x_[first_ + i] = std::isfinite(width) ? box[i].low + (part - std::floor(part)) * width
                                          : std::clamp(0.0, box[i].low, box[i].high);
  }
}

void Ascent::choose_starts(const Forest& forest, const Space& box) {
  starts_.assign(1, {});
  if (box.size() == 1) return;  // all lead to the same place
  starts_.clear();
  for (std::size_t i = 0; i < kProbesPerAxis * box.size(); ++i) {
    place(i, box);
    forest.predict(x_, values_);
    starts_.push_back({values_[0], i});
  }
  std::partial_sort(starts_.begin(), starts_.begin() + kStarts, starts_.end(),
                    [](const Start& a, const Start& b) {
                      return a.value != b.value ? a.value > b.value : a.number < b.number;
                    });
}

double Ascent::climb(const Forest& forest, const Space& box) {
  const std::size_t n = box.size();
  double value = -std::numeric_limits<double>::infinity();
  std::size_t level = 0;  // axes since it last rose
  for (std::size_t i = 0; i < kMostRounds * n && level < n; ++i) {
    const std::size_t axis = i % n;
    const double before = x_[first_ + axis];
    const double next = line_.over(forest, x_, first_ + axis, box[axis].low, box[axis].high);
    if (next > value) {
      value = next;
      level = 1;
    } else {
      x_[first_ + axis] = before;  // a step along a plateau would change the other axes' lines
      ++level;
    }
  }
  return value;
}

}  // namespace coppice
