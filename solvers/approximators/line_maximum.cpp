#include "solvers/approximators/line_maximum.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "solvers/approximators/forest_descent.h"
#include "solvers/approximators/tree_region.h"

namespace coppice {
namespace {

// A place and a piece in one number; such numbers are in the order of the places.
std::uint64_t break_at(float place, std::size_t piece) {
  return std::uint64_t{ordered(std::bit_cast<std::uint32_t>(place))} << 32 | piece;
}

float place_of(std::uint64_t at_break) {
  const auto key = static_cast<std::uint32_t>(at_break >> 32);
  return std::bit_cast<float>((key >> 31) != 0 ? key ^ 0x80000000U : ~key);
}

std::uint32_t piece_of(std::uint64_t at_break) {
  return static_cast<std::uint32_t>(at_break);
}

std::uint64_t range_of(float begin, float end) {
  return std::uint64_t{std::bit_cast<std::uint32_t>(end)} << 32 | std::bit_cast<std::uint32_t>(begin);
}

}  // namespace

double LineMaximum::over(const Forest& forest, std::span<double> x, std::size_t along, double low,
                         double high) {
  along_ = along;
  low_ = low;
  high_ = high;
  find_parts(forest, x);
  add_pieces(forest, x);
  sort_breaks();
  x[along] = forest.leaf() == LeafModel::constant ? best_place<LeafModel::constant>(forest.trees())
                                                  : best_place<LeafModel::linear>(forest.trees());
  values_.resize(forest.outputs());
  forest.predict(x, values_);
  return values_[0];
}

void LineMaximum::find_parts(const Forest& forest, std::span<const double> x) {
  rounded_.clear();
  for (const double value : x) rounded_.push_back(rounded_up(value));
  rounded_.push_back(0);  // what leaves look at in vain, as splits along the line do
  // A split is in the line where low <= threshold < high.
  const float begin = std::nextafter(rounded_up(low_), -std::numeric_limits<float>::infinity());
  const float end = rounded_up(high_);
  open_.clear();
  leaves_.clear();
  for (std::uint32_t i = 0; i < forest.trees(); ++i) {
    open_.push_back({std::uint64_t{i} << 32 | forest.tree(0, i).root, range_of(begin, end)});
  }
  while (!open_.empty()) descend(forest.tree(0, 0).nodes);
}

// All open parts by one split. Without a branch that depends on the tree, which would be guessed wrongly:
// what does not count is overwritten.
void LineMaximum::descend(const ForestNode* nodes) {
  const std::size_t along = along_;
  const float* x = rounded_.data();
  next_.resize(2 * open_.size());
  const std::size_t found = leaves_.size();
  leaves_.resize(found + open_.size());
  Part* next = next_.data();
  Part* leaf = leaves_.data() + found;
  for (const Part* part = open_.data(); part != open_.data() + open_.size(); ++part) {
    const std::uint64_t place = part->place, range = part->range;
    const float begin = part->begin(), end = part->end();
    const ForestNode node = nodes[part->node()];
    const bool is_leaf = node.ahead() == 0;
    leaf->place = place;
    leaf->range = range;
    leaf += is_leaf ? 1 : 0;
    const bool is_along = node.feature() == along;
    const float at = is_along ? begin : x[node.feature()];
    const bool is_high = (at > node.value) | (is_along & (at == node.value));
    const bool is_both = is_along & !is_high & (node.value < end);
    next[0].place = place + node.ahead() + (is_high ? 1 : 0);
    next[0].range = range_of(begin, is_both ? node.value : end);
    next[1].place = place + node.ahead() + 1;
    next[1].range = range_of(node.value, end);
    next += (is_leaf ? 0 : 1) + (is_both ? 1 : 0);
  }
  leaves_.resize(static_cast<std::size_t>(leaf - leaves_.data()));
  next_.resize(static_cast<std::size_t>(next - next_.data()));
  std::swap(open_, next_);
}

// P(L(A, B), i) = L(A_j, B + A_i i) (thesis, 2.1.4).
void LineMaximum::add_pieces(const Forest& forest, std::span<const double> x) {
  pieces_.clear();
  breaks_.clear();
  const ForestTree any = forest.tree(0, 0);
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    breaks_.push_back(break_at(leaves_[i].begin(), i));
    if (forest.leaf() == LeafModel::constant) {
      pieces_.push_back({any.constant(leaves_[i].node()), 0, 0, 0, leaves_[i].tree()});
      continue;
    }
    const double* model = any.model(leaves_[i].node());
    double bias = model[0];
    for (std::size_t j = 0; j < x.size(); ++j) bias += j == along_ ? 0.0 : model[1 + j] * x[j];
    const double* range = model + 1 + x.size();
    pieces_.push_back({bias, model[1 + along_], range[0], range[1], leaves_[i].tree()});
  }
}

// Into as many buckets of equal width as there are, most of which get few.
void LineMaximum::sort_breaks() {
  const std::size_t count = breaks_.size();
  const double width = high_ - low_;
  const double scale = width > 0 && std::isfinite(width) ? static_cast<double>(count) / width : 0;
  const auto bucket = [&](std::uint64_t at_break) {
    const double number = std::max(0.0, (place_of(at_break) - low_) * scale);
    return static_cast<std::size_t>(std::min(number, static_cast<double>(count - 1)));
  };
  ends_.assign(count + 1, 0);
  for (const std::uint64_t at_break : breaks_) ++ends_[bucket(at_break) + 1];
  for (std::size_t i = 1; i <= count; ++i) ends_[i] += ends_[i - 1];
  kept_.resize(count);
  for (const std::uint64_t at_break : breaks_) kept_[ends_[bucket(at_break)]++] = at_break;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (ends_[i] > begin + 1) std::sort(kept_.begin() + begin, kept_.begin() + ends_[i]);
    begin = ends_[i];
  }
  breaks_.swap(kept_);
}

// Passes the pieces of the sum from low to high. Of equal ones the first is taken; of a level one, its
// middle.
template <LeafModel kLeaf>
double LineMaximum::best_place(std::size_t trees) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  current_.assign(trees, {});
  Piece sum;
  double most = -kInfinity, best = low_;
  for (std::size_t i = 0; i < breaks_.size();) {
    const float begin = place_of(breaks_[i]);
    for (; i < breaks_.size() && place_of(breaks_[i]) == begin; ++i) {
      const Piece& begins = pieces_[piece_of(breaks_[i])];
      Piece& ends = current_[begins.tree];
      sum.bias += begins.bias - ends.bias;
      if constexpr (kLeaf == LeafModel::linear) {
        sum.slope += begins.slope - ends.slope;
        sum.low += begins.low - ends.low;
        sum.high += begins.high - ends.high;
      }
      ends = begins;
    }
    const double end = i < breaks_.size() ? place_of(breaks_[i]) : high_;
    const double least = std::max(low_, static_cast<double>(begin));
    double value = sum.bias;
    if constexpr (kLeaf == LeafModel::linear) {
      value = std::max(sum.low, std::min(sum.high, sum.bias + sum.slope * (sum.slope > 0 ? end : least)));
    }
    if (!(value > most)) continue;
    most = value;
    const double first = std::max(low_, std::nextafter(static_cast<double>(begin), kInfinity));
    best = sum.slope > 0 ? end : sum.slope < 0 ? first : std::max(first, centre(least, end));
  }
  return best;
}

}  // namespace coppice
