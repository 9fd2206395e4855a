#pragma once

#include <vector>

#include "solvers/approximators/grow.h"
#include "solvers/approximators/least_squares.h"
#include "solvers/approximators/training_columns.h"

namespace coppice {

/// Grows one tree after the other on a copy of the samples. A split partitions the rows of a node in place,
/// so that every node's samples are contiguous; nothing is allocated per node.
class Grower {
 public:
  Grower(const TrainingColumns& samples, const Growth& growth, const TreeKernels& kernels);

  /// Valid until the next call.
  const PackedTree& grow(std::size_t output, Stream stream);

 private:
  // One node that is still to be made: its samples, rows [begin, end) of the columns.
  struct Task {
    std::size_t begin;
    std::size_t end;
    std::uint32_t node;
    int depth;
  };

  void make_node(const Task& task);
  bool make_pair(const Task& task);
  std::uint32_t ahead(std::uint32_t node) const;
  void reset_features();
  bool may_split(const Task& task) const;
  double variance() const;
  void make_split(const Task& task, const Candidate& split);
  void make_leaf(const Task& task);

  const Candidate* best_split();
  std::size_t choose_features();
  std::size_t draw_thresholds(std::size_t size);
  bool narrow(Candidate& candidate);
  double constant_gain(const Candidate& split) const;
  void prepare_linear_gains();
  double linear_gain(const Candidate& split);
  std::uint32_t bits();
  float uniform(float low, float high);

  const TrainingColumns& samples_;
  const Growth growth_;
  const TreeKernels& kernels_;
  Stream stream_;
  std::uint64_t bits_ = 0;
  bool has_bits_ = false;
  std::vector<float> columns_;
  std::vector<float> scratch_;
  std::vector<std::uint32_t> features_;  // columns of the block
  std::vector<Candidate> candidates_;
  std::vector<Task> tasks_;
  PackedTree tree_;
  OutputScale scale_;
  // Of the node at hand:
  SampleBlock block_;
  OutputSums outputs_;
  // For linear leaves:
  Moments whole_;
  Moments low_;
  Moments high_;
  std::vector<float> centre_;
  std::vector<float> work_;
  std::vector<double> products_;
  std::vector<double> sample_;
};

}  // namespace coppice
