#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace coppice {

/// Rows [begin, end) of training samples in single precision, column after column: the inputs, the output,
/// the weights unless all are 1, and the directions of oblique splits. Each column is followed by kLanes
/// numbers that may be read, and written again as they are; so may rows of the columns behind the block.
struct SampleBlock {
  float* columns = nullptr;
  std::size_t stride = 0;  ///< from one column to the next
  std::size_t inputs = 0;
  std::size_t directions = 0;
  bool weighted = false;
  std::size_t begin = 0;
  std::size_t end = 0;

  std::size_t size() const { return end - begin; }
  std::size_t width() const { return first_direction() + directions; }
  std::size_t first_direction() const { return inputs + (weighted ? 2 : 1); }
  /// Where the block begins in a column.
  float* column(std::size_t c) const { return columns + c * stride + begin; }
  const float* outputs() const { return column(inputs); }
  const float* weights() const { return column(inputs + 1); }
};

/// A split that is tried: where its threshold may lie, and what it sends to the low side, x <= threshold.
struct Candidate {
  std::uint32_t feature = 0;  ///< a column of the block
  float low = 0;              ///< thresholds are in [low, high)
  float high = 0;
  float threshold = 0;
  std::size_t count = 0;
  double weight = 0;
  double sum = 0;  ///< of weighted outputs
};

/// The outputs of a block.
struct OutputSums {
  double weight = 0;
  double sum = 0;
  float least = 0;
  float most = 0;
};

/// The loops of training over samples, once for processors with AVX-512, once for those with AVX2 and once
/// for all others. All give the same bits: sums run in kLanes lanes that are added up pairwise in the end.
struct TreeKernels {
  const char* name;

  /// Rounds up to single precision (see rounded_up in forest.h).
  void (*round_up)(const double* from, std::size_t size, float* to);
  OutputSums (*sum_outputs)(const SampleBlock& block);
  /// Sets low and high of each candidate to its input's least and largest value.
  void (*find_ranges)(const SampleBlock& block, Candidate* candidates, std::size_t size);
  /// Sets count, weight and sum of each candidate. Sums are rounded to single precision on the way.
  void (*find_low_sides)(const SampleBlock& block, Candidate* candidates, std::size_t size);
  /// Moves the low side before the high one, both in their order. `scratch` has room for `scratch_size`
  /// numbers, the rows of the block and kLanes more at least; more room is used.
  void (*partition)(const SampleBlock& block, std::uint32_t feature, float threshold, float* scratch,
                    std::size_t scratch_size);
  /// Sums of products w u v over the low side of a split for each pair of u and v among 1, the inputs and the
  /// output, the latter two about `centre` (inputs + 1 numbers): a lower triangle, row after row, in single
  /// precision on the way. `work` has room for product_work(inputs) numbers.
  void (*low_products)(const SampleBlock& block, std::uint32_t feature, float threshold, const float* centre,
                       float* work, double* products);
};

inline constexpr std::size_t kLanes = 16;
/// low_products looks at so many rows at a time: their columns stay in the first cache.
inline constexpr std::size_t kProductRows = 512;
constexpr std::size_t triangle(std::size_t row) {
  return row * (row + 1) / 2;
}
constexpr std::size_t product_work(std::size_t inputs) {
  return kLanes + (inputs + 2) * kProductRows + triangle(inputs + 2) * kLanes;
}

/// The fastest for this processor; the environment variable COPPICE_KERNELS asks for others by their name
/// ("avx512", "avx2", "portable"), and gets the fastest when this processor has none of that name.
const TreeKernels& tree_kernels();
const TreeKernels& portable_tree_kernels();
/// Null where the processor cannot run them.
const TreeKernels* avx2_tree_kernels();
const TreeKernels* avx512_tree_kernels();
/// All that this processor can run, the fastest first.
std::vector<const TreeKernels*> usable_tree_kernels();

}  // namespace coppice
