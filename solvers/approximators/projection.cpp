#include <algorithm>
#include <bit>
#include <cassert>

#include "solvers/approximators/tree_building.h"

namespace coppice {
namespace {

// Whole numbers in the order of doubles.
std::uint64_t ordered(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  return bits ^ ((0U - (bits >> 63)) | 1ULL << 63);
}
double number(std::uint64_t order) {
  return std::bit_cast<double>(order >> 63 != 0 ? order ^ 1ULL << 63 : ~order);
}

// The last x in [low, high) that `is_before` says true of: it does of low, not of high, and changes once,
// near `guess`. Steps from there are doubled until they pass it, then halved.
template <class IsBefore>
double last_before(double low, double high, double guess, const IsBefore& is_before) {
  std::uint64_t before = ordered(low);
  std::uint64_t behind = ordered(high);
  std::uint64_t probe = std::clamp(ordered(guess), before, behind - 1);
  const bool first = is_before(number(probe));
  (first ? before : behind) = probe;
  bool passed = false;
  for (std::uint64_t step = 1; behind - before > 1; step = std::max(step, 2 * step)) {  // not beyond 2^63
    const std::uint64_t half = (behind - before) / 2;
    const std::uint64_t ahead = passed ? half : std::min(step, half);
    probe = first ? before + ahead : behind - ahead;
    const bool is = is_before(number(probe));
    (is ? before : behind) = probe;
    passed = passed || is != first;
  }
  return number(before);
}

// What directions are as functions of the last inputs.
class ProjectedDirections {
 public:
  // On how many of the last inputs a direction depends; of one which, else kNone or kSeveral.
  static constexpr std::int32_t kNone = -1;
  static constexpr std::int32_t kSeveral = -2;

  // The offset takes the first inputs' part in the order of a prediction's sum, so that it keeps its bits.
  void make(const Directions& from, std::span<const double> prefix, std::size_t inputs) {
    rows_.clear(inputs);
    axis_.clear();
    is_oblique_ = false;
    for (std::size_t j = 0; j < from.size(); ++j) {
      const std::span<const double> weights = from.weights(j);
      double* row = rows_.add();
      row[0] = from.offset(j);
      for (std::size_t i = 0; i < prefix.size(); ++i) row[0] += weights[i] * prefix[i];
      std::copy(weights.begin() + static_cast<std::ptrdiff_t>(prefix.size()), weights.end(), row + 1);
      axis_.push_back(kNone);
      for (std::size_t i = 0; i < inputs; ++i) {
        if (row[1 + i] != 0) axis_[j] = axis_[j] == kNone ? static_cast<std::int32_t>(i) : kSeveral;
      }
      is_oblique_ = is_oblique_ || axis_[j] == kSeveral;
    }
  }
  const Directions& rows() const { return rows_; }
  std::int32_t axis(std::size_t j) const { return axis_[j]; }
  bool is_oblique() const { return is_oblique_; }

 private:
  Directions rows_;
  std::vector<std::int32_t> axis_;
  bool is_oblique_ = false;
};

class Projection {
 public:
  Projection(const ForestTree& tree, std::span<const double> prefix, const Box& box, Region& region,
             Tree& out)
      : tree_(tree), prefix_(prefix), box_(box), region_(region), out_(out) {
    begin_tree(out, tree.inputs - prefix.size(), tree.leaf);
    thread_local ProjectedDirections directions;
    directions_ = &directions;
    directions.make(*tree.directions, prefix, out.inputs);
    if (directions.is_oblique()) out.directions = directions.rows();
    region.reset(box, out.directions);
    visit(tree.root, 0);
  }

 private:
  // x[feature] <= threshold goes to node `low` of the forest, the rest to `high`.
  struct Split {
    std::size_t feature;
    double threshold;
    std::uint32_t low;
    std::uint32_t high;
  };
  void visit(std::uint32_t from, std::int32_t to) {
    while (!tree_.is_leaf(from)) {
      const ForestNode& node = tree_.nodes[from];
      const std::uint32_t below = from + node.ahead();
      const std::size_t feature = node.feature();
      const double threshold = node.value;
      if (feature < prefix_.size()) {
        from = below + (prefix_[feature] > threshold ? 1 : 0);
        continue;
      }
      Split split{feature - prefix_.size(), threshold, below, below + 1};
      if (feature >= tree_.inputs && !split_by_direction(feature - tree_.inputs, split)) {
        from = split.low;
        continue;
      }
      const bool low = region_.reaches_low(split.feature, split.threshold);
      const bool high = region_.reaches_high(split.feature, split.threshold);
      if (low && high) {
        const auto axis = static_cast<std::int32_t>(split.feature);
        const std::int32_t child = add_split(out_, to, axis, split.threshold);
        region_.in_low(split.feature, split.threshold, [&] { visit(split.low, child); });
        region_.in_high(split.feature, split.threshold, [&] { visit(split.high, child + 1); });
        return;
      }
      from = low ? split.low : split.high;
    }
    leaf(from, to);
  }

  // What becomes of a split by direction j; false when all of the region goes to split.low. One of a single
  // input has its threshold where the rounded sum of a prediction passes the direction's.
  bool split_by_direction(std::size_t j, Split& split) const {
    const std::int32_t axis = directions_->axis(j);
    if (axis == ProjectedDirections::kSeveral) return true;
    const double offset = directions_->rows().offset(j);
    const double threshold = split.threshold;
    if (axis == ProjectedDirections::kNone) {
      if (offset > threshold) split.low = split.high;
      return false;
    }
    split.feature = static_cast<std::size_t>(axis);
    const double weight = directions_->rows().weights(j)[split.feature];
    if (weight < 0) std::swap(split.low, split.high);
    const auto is_low = [&](double x) { return (offset + weight * x > threshold) == (weight < 0); };
    const double least = region_.least(split.feature, box_);
    const double most = region_.high(split.feature);
    if (!is_low(least)) split.low = split.high;
    if (!is_low(least) || is_low(most)) return false;
    split.threshold = last_before(least, most, (threshold - offset) / weight, is_low);
    return true;
  }

  // P(L(A, B), i) = L(A_j, B + A_i i), summed in the order of a prediction.
  void leaf(std::uint32_t from, std::int32_t to) {
    double* model = add_leaf(out_, to, tree_.leaf == LeafModel::constant ? tree_.constant(from) : 0);
    if (model == nullptr) return;
    const double* whole = tree_.model(from);
    model[0] = whole[0];
    for (std::size_t i = 0; i < prefix_.size(); ++i) model[0] += whole[1 + i] * prefix_[i];
    std::copy(whole + 1 + prefix_.size(), whole + model_width(tree_.inputs), model + 1);
  }

  const ForestTree tree_;
  const std::span<const double> prefix_;
  const Box& box_;
  Region& region_;
  Tree& out_;
  const ProjectedDirections* directions_ = nullptr;
};

}  // namespace

void project(const ForestTree& tree, std::span<const double> prefix, const Box& box, Tree& out) {
  assert(prefix.size() + box.low.size() == tree.inputs);
  Projection(tree, prefix, box, scratch_region(), out);
}

}  // namespace coppice
