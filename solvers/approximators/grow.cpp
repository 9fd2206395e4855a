#include "solvers/approximators/grow.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "solvers/approximators/least_squares.h"

namespace coppice {
namespace {

// Redraws of a threshold that leaves too few samples on one side, before the interval is found by sorting.
constexpr int kRedraws = 16;

struct Split {
  std::size_t feature = 0;
  double threshold = 0;
  std::size_t low_count = 0;
  double score = std::numeric_limits<double>::infinity();
};

// One node that is still to be made: its samples, rows [begin, end) of the grower's columns.
struct Task {
  std::size_t begin;
  std::size_t end;
  std::int32_t node;
  int depth;
};

// Grows a tree on its own copy of the samples, column after column. A split partitions the rows of a node in
// place, so that every node's samples are contiguous; nothing is allocated per node.
class Grower {
 public:
  Grower(const TrainingSet& set, std::size_t output, const Growth& growth, Stream stream);
  Tree grow();

 private:
  double* column(std::size_t c) { return columns_.data() + c * rows_; }
  double* y() { return column(inputs_); }
  double* weight() { return column(inputs_ + 1); }

  void look_at(const Task& task);
  Split best_split(const Task& task);
  bool draw_threshold(const Task& task, Split& split);
  bool allowed_interval(const Task& task, const double* x, double& low, double& high);
  double score(const Task& task, const Split& split);
  double constant_score(const Task& task, const Split& split);
  double linear_score(const Task& task, const Split& split);
  void partition(const Task& task, const Split& split);
  void make_leaf(const Task& task);
  void gather(std::size_t row, double* xy);

  const Growth growth_;
  const std::size_t inputs_;
  Stream stream_;
  std::size_t rows_ = 0;
  std::vector<double> columns_;  // inputs, output, weights
  std::vector<double> scratch_;
  std::vector<std::uint8_t> low_side_;
  std::vector<std::size_t> dimensions_;
  std::vector<double> sample_;
  Moments whole_;
  Moments low_;
  Moments high_;
  // Of the node at hand:
  double mean_ = 0;
  double variance_ = 0;
  double weight_sum_ = 0;
  Tree tree_;
};

Grower::Grower(const TrainingSet& set, std::size_t output, const Growth& growth, Stream stream)
    : growth_(growth),
      inputs_(set.x.columns()),
      stream_(stream),
      dimensions_(inputs_),
      sample_(inputs_ + 1),
      whole_(growth.leaf == LeafModel::linear ? inputs_ : 0),
      low_(whole_),
      high_(whole_) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < set.x.rows(); ++i) {
    if (set.weights.empty() || set.weights[i] > 0) kept.push_back(i);
  }
  rows_ = kept.size();
  columns_.resize(rows_ * (inputs_ + 2));
  for (std::size_t c = 0; c < inputs_; ++c) {
    for (std::size_t i = 0; i < rows_; ++i) column(c)[i] = set.x(kept[i], c);
  }
  for (std::size_t i = 0; i < rows_; ++i) y()[i] = set.y(kept[i], output);
  for (std::size_t i = 0; i < rows_; ++i) weight()[i] = set.weights.empty() ? 1.0 : set.weights[kept[i]];
  scratch_.resize(rows_);
  low_side_.resize(rows_);
  std::iota(dimensions_.begin(), dimensions_.end(), std::size_t{0});
  tree_.inputs = inputs_;
  tree_.leaf = growth.leaf;
}

Tree Grower::grow() {
  tree_.nodes.push_back({});
  std::vector<Task> tasks{{0, rows_, 0, 0}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    look_at(task);
    Split split;
    if (task.end - task.begin >= 2 * growth_.min_samples && variance_ > growth_.min_variance &&
        task.depth < kMaxTreeDepth) {
      split = best_split(task);
    }
    if (split.score == std::numeric_limits<double>::infinity()) {
      make_leaf(task);
      continue;
    }
    partition(task, split);
    const auto child = static_cast<std::int32_t>(tree_.nodes.size());
    tree_.nodes[task.node] = {split.threshold, static_cast<std::int32_t>(split.feature), child};
    tree_.nodes.resize(tree_.nodes.size() + 2);
    const std::size_t middle = task.begin + split.low_count;
    tasks.push_back({middle, task.end, child + 1, task.depth + 1});
    tasks.push_back({task.begin, middle, child, task.depth + 1});
  }
  return std::move(tree_);
}

// Mean and variance of the outputs (thesis, Eqs. 2.3 and 2.4); for linear leaves also all other moments.
void Grower::look_at(const Task& task) {
  double sum = 0;
  weight_sum_ = 0;
  for (std::size_t i = task.begin; i < task.end; ++i) {
    sum += weight()[i] * y()[i];
    weight_sum_ += weight()[i];
  }
  mean_ = sum / weight_sum_;
  double squares = 0;
  for (std::size_t i = task.begin; i < task.end; ++i) {
    squares += weight()[i] * (y()[i] - mean_) * (y()[i] - mean_);
  }
  variance_ = squares / weight_sum_;
  if (growth_.leaf == LeafModel::constant) return;
  gather(task.begin, sample_.data());
  sample_[inputs_] = mean_;
  whole_.reset(sample_);
  for (std::size_t i = task.begin; i < task.end; ++i) {
    gather(i, sample_.data());
    whole_.add(sample_.data(), weight()[i]);
  }
}

void Grower::gather(std::size_t row, double* xy) {
  for (std::size_t c = 0; c <= inputs_; ++c) xy[c] = column(c)[row];
}

// The best of k random splits along distinct dimensions, no split when none is possible.
Split Grower::best_split(const Task& task) {
  Split best;
  const std::size_t tries = std::min(growth_.candidates, inputs_);
  for (std::size_t i = 0; i < tries; ++i) {
    std::swap(dimensions_[i], dimensions_[i + stream_.below(inputs_ - i)]);
    Split split;
    split.feature = dimensions_[i];
    if (!draw_threshold(task, split)) continue;
    split.score = score(task, split);
    if (split.score < best.score) best = split;
  }
  return best;
}

// A threshold that is uniform between the n_min-th smallest and the n_min-th largest value (the latter
// excluded, since equal values go low); false when there is none. Drawing again from what a failed draw
// leaves of the interval gives the same distribution as finding these two values first, and is faster.
bool Grower::draw_threshold(const Task& task, Split& split) {
  const double* x = column(split.feature);
  const auto [least, most] = std::minmax_element(x + task.begin, x + task.end);
  double low = *least;
  double high = *most;
  const std::size_t size = task.end - task.begin;
  for (int attempt = 0; low < high; ++attempt) {
    if (attempt == kRedraws && !allowed_interval(task, x, low, high)) return false;
    const double u = stream_.uniform();
    double threshold = low * (1 - u) + high * u;
    if (!(threshold >= low && threshold < high)) threshold = low;
    // A threshold in single precision, wherever the values allow, can later be stored in half the space.
    const auto rounded = static_cast<double>(static_cast<float>(threshold));
    if (rounded >= low && rounded < high) threshold = rounded;
    split.threshold = threshold;
    split.low_count = 0;
    for (std::size_t i = task.begin; i < task.end; ++i) split.low_count += x[i] <= threshold ? 1 : 0;
    if (split.low_count < growth_.min_samples) {
      low = threshold;
    } else if (size - split.low_count < growth_.min_samples) {
      high = threshold;
    } else {
      return true;
    }
  }
  return false;
}

// The n_min-th smallest and largest value; false when they leave no room for a threshold.
bool Grower::allowed_interval(const Task& task, const double* x, double& low, double& high) {
  const auto begin = scratch_.begin();
  const auto end = std::copy(x + task.begin, x + task.end, begin);
  const auto rank = static_cast<std::ptrdiff_t>(growth_.min_samples);
  std::nth_element(begin, begin + rank - 1, end);
  low = *(begin + rank - 1);
  std::nth_element(begin, end - rank, end);
  high = *(end - rank);
  return low < high;
}

// Sum of squared residuals of the two leaf models (thesis, Algorithm 5).
double Grower::score(const Task& task, const Split& split) {
  const double score =
      growth_.leaf == LeafModel::constant ? constant_score(task, split) : linear_score(task, split);
  return std::isfinite(score) ? score : std::numeric_limits<double>::max();
}

double Grower::constant_score(const Task& task, const Split& split) {
  const double* x = column(split.feature);
  double low_sum = 0;
  double low_weight = 0;
  for (std::size_t i = task.begin; i < task.end; ++i) {
    const double weight_low = x[i] <= split.threshold ? weight()[i] : 0.0;
    low_sum += weight_low * (y()[i] - mean_);
    low_weight += weight_low;
  }
  // About the node's mean, the high side's sum is minus the low side's.
  const double high_weight = weight_sum_ - low_weight;
  return variance_ * weight_sum_ - low_sum * low_sum / low_weight - low_sum * low_sum / high_weight;
}

double Grower::linear_score(const Task& task, const Split& split) {
  const double* x = column(split.feature);
  low_.reset_like(whole_);
  for (std::size_t i = task.begin; i < task.end; ++i) {
    if (x[i] > split.threshold) continue;
    gather(i, sample_.data());
    low_.add(sample_.data(), weight()[i]);
  }
  high_.set_difference(whole_, low_);
  double bias = 0;
  const std::span<double> slopes(sample_.data(), inputs_);
  return low_.fit(bias, slopes) + high_.fit(bias, slopes);
}

// Moves the samples of the low side before those of the high side, both in their order (thesis, Algorithm 4).
void Grower::partition(const Task& task, const Split& split) {
  const double* x = column(split.feature);
  for (std::size_t i = task.begin; i < task.end; ++i) low_side_[i] = x[i] <= split.threshold ? 1 : 0;
  for (std::size_t c = 0; c < inputs_ + 2; ++c) {
    double* values = column(c);
    std::size_t low = task.begin;
    std::size_t high = 0;
    for (std::size_t i = task.begin; i < task.end; ++i) {
      const double value = values[i];
      values[low] = value;
      scratch_[high] = value;
      low += low_side_[i];
      high += 1 - low_side_[i];
    }
    std::copy(scratch_.begin(), scratch_.begin() + static_cast<std::ptrdiff_t>(high), values + low);
  }
}

void Grower::make_leaf(const Task& task) {
  TreeNode& node = tree_.nodes[task.node];
  node = {mean_, static_cast<std::int32_t>(inputs_), task.node};
  if (growth_.leaf == LeafModel::constant) return;
  const std::size_t width = model_width(inputs_);
  const std::size_t first = tree_.models.size(), number = first / width;
  node.value = static_cast<double>(number);
  tree_.models.resize(first + width);
  double* model = tree_.models.data() + first;
  whole_.fit(model[0], {model + 1, inputs_});
  const auto [least, most] = std::minmax_element(y() + task.begin, y() + task.end);
  const double margin = growth_.leaf_margin * (*most - *least);
  model[inputs_ + 1] = *least - margin;
  model[inputs_ + 2] = *most + margin;
}

}  // namespace

Tree grow_tree(const TrainingSet& set, std::size_t output, const Growth& growth, Stream stream) {
  return Grower(set, output, growth, stream).grow();
}

}  // namespace coppice
