#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "solvers/approximators/tree_operations.h"
#include "solvers/approximators/tree_region.h"

namespace coppice {
namespace {

// A preleaf and what replacing it by one leaf costs; of equal costs the first node goes first.
struct Candidate {
  double loss;
  std::int32_t node;
  bool operator<(const Candidate& other) const {  // for a heap with the least at its front
    return loss != other.loss ? loss > other.loss : node > other.node;
  }
};

// The mean of |m + sum_i reach[i] u_i| for independent u_i uniform in [-1, 1]: what Eq. 2.9 is for two linear
// models that differ by m at the centre of a box. Exact along the axis with the largest reach (E|m + r u| =
// (m^2 + r^2) / 2r for |m| < r); along the next kQuadrature axes by Gauss-Legendre quadrature with three
// points; the other axes, which matter least, stay at the centre.
class MeanAbsolute {
 public:
  explicit MeanAbsolute(std::vector<double>& reach) : reach_(reach) {
    std::sort(reach.begin(), reach.end(), std::greater<>());
  }

  double of(double m) const { return over(m, 1); }

 private:
  static constexpr std::size_t kQuadrature = 4;

  // Over the first axis and those from `axis` on.
  double over(double m, std::size_t axis) const {
    double rest = reach_.empty() ? 0.0 : reach_[0];
    for (std::size_t i = axis; i < reach_.size(); ++i) rest += reach_[i];
    if (std::fabs(m) >= rest) return std::fabs(m);
    if (axis >= reach_.size() || axis > kQuadrature || reach_[axis] == 0) return along_first(m);
    constexpr double kNode = 0.7745966692414834;  // sqrt(3/5)
    const double step = kNode * reach_[axis];
    return (5 * over(m - step, axis + 1) + 8 * over(m, axis + 1) + 5 * over(m + step, axis + 1)) / 18;
  }

  double along_first(double m) const {
    const double r = reach_.empty() ? 0.0 : reach_[0];
    return std::fabs(m) >= r ? std::fabs(m) : (m * m + r * r) / (2 * r);
  }

  std::vector<double>& reach_;
};

class Pruning {
 public:
  // Volumes, parents, number of leaves and the first candidates, from each split's share of volume. Volumes
  // are parts of the box's, over the axes on which it has any width.
  void start(Tree& tree, const Box& box, std::span<const double> shares) {
    tree_ = &tree;
    box_ = &box;
    const std::size_t size = tree.nodes.size();
    parent_.assign(size, kCutOff);
    volume_.resize(size);
    parent_[0] = kNone;
    volume_[0] = 1;
    heap_.clear();
    leaves_ = 0;
    for (std::size_t i = 0; i < size; ++i) {  // children follow their parents
      if (parent_[i] == kCutOff) continue;    // by pruning before
      const auto at = static_cast<std::int32_t>(i);
      const std::int32_t child = tree.nodes[i].child;
      if (child == at) {
        ++leaves_;
        continue;
      }
      parent_[child] = parent_[child + 1] = at;
      volume_[child] = volume_[i] * shares[i];
      volume_[child + 1] = volume_[i] * (1 - shares[i]);
      if (is_preleaf(at)) heap_.push_back({loss(at), at});
    }
    std::make_heap(heap_.begin(), heap_.end());
  }

  void down_to(std::size_t max_leaves) {
    while (leaves_ > max_leaves && !heap_.empty()) {
      const std::int32_t node = heap_.front().node;
      replace(node);
      --leaves_;
      const std::int32_t above = parent_[node];
      if (above >= 0 && is_preleaf(above)) {
        put_first({loss(above), above});
      } else {
        const Candidate last = heap_.back();
        heap_.pop_back();
        if (!heap_.empty()) put_first(last);
      }
    }
  }

 private:
  static constexpr std::int32_t kNone = -1;
  static constexpr std::int32_t kCutOff = -2;

  bool is_leaf(std::int32_t node) const { return tree_->nodes[node].child == node; }
  bool is_preleaf(std::int32_t node) const {
    const std::int32_t child = tree_->nodes[node].child;
    return is_leaf(child) && is_leaf(child + 1);
  }

  // In place of the heap's first candidate.
  void put_first(const Candidate& candidate) {
    const std::size_t size = heap_.size();
    std::size_t at = 0;
    for (std::size_t child = 1; child < size; child = 2 * at + 1) {
      if (child + 1 < size && heap_[child] < heap_[child + 1]) ++child;
      if (!(candidate < heap_[child])) break;
      heap_[at] = heap_[child];
      at = child;
    }
    heap_[at] = candidate;
  }

  // The weights of the two leaves of a preleaf in their mean; halves where both volumes vanish.
  void weights(std::int32_t preleaf, double& low, double& high) const {
    const std::int32_t child = tree_->nodes[preleaf].child;
    const double sum = volume_[child] + volume_[child + 1];
    low = sum > 0 ? volume_[child] / sum : 0.5;
    high = sum > 0 ? volume_[child + 1] / sum : 0.5;
  }

  // Eq. 2.9 with f' the mean by volume: on each side f' differs from f by the other side's weight times the
  // difference of the two leaves.
  double loss(std::int32_t preleaf) {
    double low = 0;
    double high = 0;
    weights(preleaf, low, high);
    const std::int32_t child = tree_->nodes[preleaf].child;
    double loss = 0;
    if (tree_->leaf == LeafModel::constant) {
      const double difference = std::fabs(tree_->nodes[child].value - tree_->nodes[child + 1].value);
      loss = difference * (high * volume_[child] + low * volume_[child + 1]);
    } else {
      loss = high * volume_[child] * mean_difference(preleaf, 0) +
             low * volume_[child + 1] * mean_difference(preleaf, 1);
    }
    return loss >= 0 ? loss : std::numeric_limits<double>::infinity();
  }

  // Mean absolute difference of the two linear leaves over the low (0) or high (1) side of the preleaf.
  double mean_difference(std::int32_t preleaf, std::int32_t side) {
    const Tree& tree = *tree_;
    const std::int32_t child = tree_->nodes[preleaf].child;
    const double* a = tree.model(child);
    const double* b = tree.model(child + 1);
    bounds(child + side);
    reach_.assign(tree.inputs, 0.0);
    double centre = a[0] - b[0];
    for (std::size_t i = 0; i < tree.inputs; ++i) {
      const double slope = a[1 + i] - b[1 + i];
      const double half = std::max(0.0, 0.5 * (high_[i] - low_[i]));
      centre += slope * (low_[i] + half);
      reach_[i] = std::fabs(slope) * half;
    }
    return MeanAbsolute(reach_).of(centre);
  }

  // The box of a node, from the splits above it.
  void bounds(std::int32_t node) {
    low_ = box_->low;
    high_ = box_->high;
    for (std::int32_t above = parent_[node]; above >= 0; node = above, above = parent_[node]) {
      const TreeNode& split = tree_->nodes[above];
      const auto axis = static_cast<std::size_t>(split.feature);
      if (node == split.child) {
        high_[axis] = std::min(high_[axis], split.value);
      } else {
        low_[axis] = std::max(low_[axis], split.value);
      }
    }
  }

  // Makes a leaf of a preleaf: wAvg of its children by their volumes.
  void replace(std::int32_t preleaf) {
    double low = 0;
    double high = 0;
    weights(preleaf, low, high);
    TreeNode& node = tree_->nodes[preleaf];
    const TreeNode& a = tree_->nodes[node.child];
    const TreeNode& b = tree_->nodes[node.child + 1];
    double value = low * a.value + high * b.value;
    if (tree_->leaf == LeafModel::linear) {
      const std::size_t width = model_width(tree_->inputs);
      double* kept = tree_->models.data() + static_cast<std::size_t>(a.value) * width;
      const double* other = tree_->models.data() + static_cast<std::size_t>(b.value) * width;
      for (std::size_t i = 0; i < width; ++i) kept[i] = low * kept[i] + high * other[i];
      value = a.value;
    }
    node = {value, static_cast<std::int32_t>(tree_->features()), preleaf};
  }

  Tree* tree_ = nullptr;
  const Box* box_ = nullptr;
  std::vector<std::int32_t> parent_;
  std::vector<double> volume_;
  std::vector<Candidate> heap_;
  std::size_t leaves_ = 0;
  std::vector<double> low_;
  std::vector<double> high_;
  std::vector<double> reach_;
};

// Each split's share of its volume, by a walk through the tree.
class Shares {
 public:
  const std::vector<double>& of(const Tree& tree, const Box& box) {
    tree_ = &tree;
    box_ = &box;
    shares_.assign(tree.nodes.size(), 0.0);
    region_.reset(box, tree.directions);
    walk(0);
    return shares_;
  }

 private:
  void walk(std::int32_t at) {
    if (tree_->is_leaf(at)) return;
    const TreeNode& split = tree_->nodes[at];
    const auto axis = static_cast<std::size_t>(split.feature);
    shares_[at] = low_share(region_.low(axis), region_.high(axis), *box_, axis, split.value);
    region_.in_low(axis, split.value, [&] { walk(split.child); });
    region_.in_high(axis, split.value, [&] { walk(split.child + 1); });
  }

  const Tree* tree_ = nullptr;
  const Box* box_ = nullptr;
  Region region_;
  std::vector<double> shares_;
};

}  // namespace

void prune(Tree& tree, const Box& box, std::size_t max_leaves, std::span<const double> shares) {
  assert(max_leaves >= 1 && box.low.size() == tree.inputs && shares.size() == tree.nodes.size());
  if ((tree.nodes.size() + 1) / 2 <= max_leaves) return;
  check_boxes(tree);
  thread_local Pruning pruning;
  pruning.start(tree, box, shares);
  pruning.down_to(max_leaves);
}

void prune(Tree& tree, const Box& box, std::size_t max_leaves) {
  if ((tree.nodes.size() + 1) / 2 <= max_leaves) return;
  thread_local Shares shares;
  prune(tree, box, max_leaves, shares.of(tree, box));
}

}  // namespace coppice
