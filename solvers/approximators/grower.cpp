#include "solvers/approximators/grower.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace coppice {
namespace {

// Redraws of a threshold that leaves too few samples on one side, before the interval is found by sorting.
constexpr int kRedraws = 16;
// Rows whose mean is the centre of sums in single precision.
constexpr std::size_t kCentreRows = 32;
}  // namespace

Grower::Grower(const TrainingColumns& samples, const Growth& growth, const TreeKernels& kernels)
    : samples_(samples),
      growth_(growth),
      kernels_(kernels),
      stream_(0),
      columns_(samples.block_size()),
      scratch_(samples.rows() + kLanes),
      features_(samples.features()),
      candidates_(std::min(growth.candidates, samples.features())),
      whole_(growth.leaf == LeafModel::linear ? samples.inputs() : 0),
      low_(whole_),
      high_(whole_) {
  reset_features();
  if (growth.leaf == LeafModel::constant) return;
  centre_.resize(samples.inputs() + 1);
  work_.resize(product_work(samples.inputs()));
  products_.resize(triangle(samples.inputs() + 2));
  sample_.resize(samples.inputs() + 1);
}

const PackedTree& Grower::grow(std::size_t output, Stream stream) {
  stream_ = stream;
  has_bits_ = false;
  reset_features();
  scale_ = samples_.scales()[output];
  block_ = samples_.block(columns_.data());
  samples_.copy(kernels_, output, block_);
  tree_.nodes.assign(1, {});
  tree_.models.clear();
  tasks_.assign(1, {0, samples_.rows(), 0, 0});
  while (!tasks_.empty()) {
    const Task task = tasks_.back();
    tasks_.pop_back();
    make_node(task);
  }
  return tree_;
}

void Grower::reset_features() {
  for (std::size_t i = 0; i < features_.size(); ++i)
    features_[i] = samples_.column_of(static_cast<std::uint32_t>(i));
}

void Grower::make_node(const Task& task) {
  block_.begin = task.begin;
  block_.end = task.end;
  if (block_.size() <= 2 && growth_.leaf == LeafModel::constant && growth_.min_samples == 1 &&
      growth_.min_variance == 0 && task.depth < kMaxTreeDepth) {
    if (make_pair(task)) return;
  }
  outputs_ = kernels_.sum_outputs(block_);
  const Candidate* split = may_split(task) ? best_split() : nullptr;
  if (split != nullptr) {
    make_split(task, *split);
  } else {
    make_leaf(task);
  }
}

// One or two samples, which half of a deep tree's nodes have, at once. Whatever separates two is as good.
bool Grower::make_pair(const Task& task) {
  const float* y = block_.outputs();
  const std::size_t features = features_.size();
  if (block_.size() == 1) {
    tree_.nodes[task.node] = ForestNode::leaf(features, y[0]);
    return true;
  }
  if (y[0] == y[1]) return false;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    std::swap(features_[i], features_[i + ((bits() * (features - i)) >> 32)]);
    const float* x = block_.column(features_[i]);
    if (x[0] == x[1]) continue;
    const std::size_t low = x[0] < x[1] ? 0 : 1;
    const float threshold = uniform(x[low], x[1 - low]);
    const std::uint32_t feature = samples_.feature_of(features_[i]);
    tree_.nodes[task.node] = ForestNode::split(feature, threshold, ahead(task.node));
    tree_.nodes.push_back(ForestNode::leaf(features, y[low]));
    tree_.nodes.push_back(ForestNode::leaf(features, y[1 - low]));
    return true;
  }
  return false;
}

// From a node to the end of the tree, where its children will be.
std::uint32_t Grower::ahead(std::uint32_t node) const {
  const auto ahead = static_cast<std::uint32_t>(tree_.nodes.size()) - node;
  if (ahead > ForestNode::kMaxAhead)
    throw std::runtime_error("a tree would have more than 2^24 leaves; raise n_min");
  return ahead;
}

bool Grower::may_split(const Task& task) const {
  if (block_.size() < 2 * growth_.min_samples || task.depth == kMaxTreeDepth) return false;
  if (outputs_.least == outputs_.most) return false;
  return growth_.min_variance == 0 || variance() > growth_.min_variance;
}

// Of the outputs (thesis, Eq. 2.4).
double Grower::variance() const {
  constexpr std::size_t kSums = 8;  // independent ones, which a processor adds to at once
  const double mean = outputs_.sum / outputs_.weight;
  const float* y = block_.outputs();
  std::array<double, kSums> sums{};
  for (std::size_t i = 0; i < block_.size(); ++i) {
    const double difference = y[i] - mean;
    sums[i % kSums] += (block_.weighted ? block_.weights()[i] : 1.0) * difference * difference;
  }
  return std::accumulate(sums.begin(), sums.end(), 0.0) / outputs_.weight * scale_.scale * scale_.scale;
}

// The child with fewer samples is made first: the other one's children are not further ahead than it has
// nodes.
void Grower::make_split(const Task& task, const Candidate& split) {
  kernels_.partition(block_, split.feature, split.threshold, scratch_.data(), scratch_.size());
  const auto child = static_cast<std::uint32_t>(tree_.nodes.size());
  const std::uint32_t feature = samples_.feature_of(split.feature);
  tree_.nodes[task.node] = ForestNode::split(feature, split.threshold, ahead(task.node));
  tree_.nodes.resize(tree_.nodes.size() + 2);
  const std::size_t middle = task.begin + split.count;
  const Task low{task.begin, middle, child, task.depth + 1};
  const Task high{middle, task.end, child + 1, task.depth + 1};
  const bool low_first = split.count <= block_.size() - split.count;
  tasks_.push_back(low_first ? high : low);
  tasks_.push_back(low_first ? low : high);
}

void Grower::make_leaf(const Task& task) {
  const double mean = outputs_.sum / outputs_.weight;
  const std::size_t inputs = samples_.inputs();
  if (growth_.leaf == LeafModel::constant) {
    tree_.nodes[task.node] = ForestNode::leaf(features_.size(), static_cast<float>(mean));
    return;
  }
  const std::size_t width = model_width(inputs);
  const std::size_t first = tree_.models.size();
  tree_.nodes[task.node] =
      ForestNode::linear_leaf(features_.size(), static_cast<std::uint32_t>(first / width));
  std::vector<double>& sample = sample_;
  const auto gather = [&](std::size_t row) {
    for (std::size_t c = 0; c <= inputs; ++c) sample[c] = static_cast<double>(block_.column(c)[row]);
  };
  gather(0);
  sample[inputs] = mean;
  whole_.reset(sample);
  for (std::size_t i = 0; i < block_.size(); ++i) {
    gather(i);
    whole_.add(sample.data(), block_.weighted ? static_cast<double>(block_.weights()[i]) : 1.0);
  }
  tree_.models.resize(first + width);
  double* model = tree_.models.data() + first;
  whole_.fit(model[0], {model + 1, inputs});
  const double margin = growth_.leaf_margin * (static_cast<double>(outputs_.most) - outputs_.least);
  model[inputs + 1] = outputs_.least - margin;
  model[inputs + 2] = outputs_.most + margin;
  for (std::size_t i = 0; i < width; ++i) model[i] *= scale_.scale;
  for (const std::size_t i : {std::size_t{0}, inputs + 1, inputs + 2}) model[i] += scale_.offset;
}

// The best of k random splits along distinct dimensions, null when none is possible. Equal ones have equal
// chances.
const Candidate* Grower::best_split() {
  const std::size_t size = draw_thresholds(choose_features());
  if (size > 0 && growth_.leaf == LeafModel::linear) prepare_linear_gains();
  const Candidate* best = nullptr;
  double best_gain = 0;
  std::uint32_t equal = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const Candidate& candidate = candidates_[i];
    double gain = growth_.leaf == LeafModel::constant ? constant_gain(candidate) : linear_gain(candidate);
    if (!std::isfinite(gain)) gain = std::numeric_limits<double>::lowest();
    if (best == nullptr || gain > best_gain) {
      best = &candidate;
      best_gain = gain;
      equal = 1;
    } else if (gain == best_gain) {
      ++equal;
      if ((std::uint64_t{bits()} * equal) >> 32 == 0) best = &candidate;
    }
  }
  return best;
}

// 32 random bits.
std::uint32_t Grower::bits() {
  has_bits_ = !has_bits_;
  bits_ = has_bits_ ? stream_.next() : bits_ >> 32;
  return static_cast<std::uint32_t>(bits_);
}

// A number in [low, high).
float Grower::uniform(float low, float high) {
  const double first = low;
  const auto value = static_cast<float>(first + (high - first) * (bits() * 0x1p-32));
  return value < high ? value : std::nextafter(high, -std::numeric_limits<float>::infinity());
}

// k distinct inputs or directions, of those only the ones that vary; their ranges. Returns how many.
std::size_t Grower::choose_features() {
  const std::size_t tries = candidates_.size();
  for (std::size_t i = 0; i < tries; ++i) {
    if (tries < features_.size()) std::swap(features_[i], features_[i + stream_.below(features_.size() - i)]);
    candidates_[i].feature = features_[i];
  }
  kernels_.find_ranges(block_, candidates_.data(), tries);
  const auto end = candidates_.begin() + static_cast<std::ptrdiff_t>(tries);
  const auto kept =
      std::remove_if(candidates_.begin(), end, [](const Candidate& c) { return !(c.low < c.high); });
  return static_cast<std::size_t>(kept - candidates_.begin());
}

// A threshold for each candidate that is uniform between the n_min-th smallest and the n_min-th largest value
// (the latter excluded, since equal values go low). Drawing again from what a failed draw leaves of the
// interval gives the same distribution as finding these two values first, and is faster. Candidates that have
// no such threshold are dropped; returns how many are left.
std::size_t Grower::draw_thresholds(std::size_t size) {
  std::size_t done = 0;
  for (int attempt = 0; done < size; ++attempt) {
    for (std::size_t i = done; i < size; ++i) {
      Candidate& c = candidates_[i];
      c.threshold = uniform(c.low, c.high);
    }
    kernels_.find_low_sides(block_, candidates_.data() + done, size - done);
    for (std::size_t i = done; i < size;) {
      Candidate& c = candidates_[i];
      const bool low_short = c.count < growth_.min_samples;
      if (!low_short && block_.size() - c.count >= growth_.min_samples) {
        std::swap(c, candidates_[done++]);
        ++i;
        continue;
      }
      (low_short ? c.low : c.high) = c.threshold;
      const bool dropped = growth_.too_few == Growth::Short::reject || !(c.low < c.high) ||
                           (attempt == kRedraws && !narrow(c));
      if (dropped) {
        c = candidates_[--size];
      } else {
        ++i;
      }
    }
  }
  return size;
}

// The n_min-th smallest and largest value; false when they leave no room for a threshold.
bool Grower::narrow(Candidate& candidate) {
  const float* x = block_.column(candidate.feature);
  const auto begin = scratch_.begin();
  const auto end = std::copy(x, x + block_.size(), begin);
  const auto rank = static_cast<std::ptrdiff_t>(growth_.min_samples);
  std::nth_element(begin, begin + rank - 1, end);
  candidate.low = *(begin + rank - 1);
  std::nth_element(begin, end - rank, end);
  candidate.high = *(end - rank);
  return candidate.low < candidate.high;
}

// What the split explains of the sum of squares (thesis, Algorithm 5).
double Grower::constant_gain(const Candidate& split) const {
  const double weight = outputs_.weight - split.weight;
  const double difference = split.sum / split.weight - (outputs_.sum - split.sum) / weight;
  return difference * difference * split.weight * weight;
}

// Sums over all samples of the node, about a centre that is near them.
void Grower::prepare_linear_gains() {
  const std::size_t step = (block_.size() + kCentreRows - 1) / kCentreRows;
  for (std::size_t c = 0; c <= block_.inputs; ++c) {
    double sum = 0;
    double count = 0;
    for (std::size_t i = 0; i < block_.size(); i += step, ++count) sum += block_.column(c)[i];
    centre_[c] = static_cast<float>(sum / count);
  }
  kernels_.low_products(block_, 0, std::numeric_limits<float>::infinity(), centre_.data(), work_.data(),
                        products_.data());
  whole_.set(centre_, products_);
}

double Grower::linear_gain(const Candidate& split) {
  kernels_.low_products(block_, split.feature, split.threshold, centre_.data(), work_.data(),
                        products_.data());
  low_.set(centre_, products_);
  high_.set_difference(whole_, low_);
  return -low_.residual() - high_.residual();
}

}  // namespace coppice
