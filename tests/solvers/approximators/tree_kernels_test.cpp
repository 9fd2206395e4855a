#include "solvers/approximators/tree_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/vocabulary/random.h"
#include "solvers/approximators/forest.h"

namespace coppice {
namespace {

const Draws kKernelDraws(2017, "kernels", 0);

/// Columns of random numbers, a block of which is looked at; NaNs around what may be read.
struct Block {
  std::vector<float> columns;
  SampleBlock block;

  Block(Stream& stream, std::size_t inputs, bool weighted, std::size_t begin, std::size_t size) {
    block.inputs = inputs;
    block.weighted = weighted;
    block.begin = begin;
    block.end = begin + size;
    block.stride = block.end + 2 * kLanes;
    columns.assign(block.stride * block.width(), std::numeric_limits<float>::quiet_NaN());
    const bool ties = stream.below(2) == 0;
    for (std::size_t c = 0; c < block.width(); ++c) {
      for (std::size_t i = 0; i < block.stride; ++i) {
        const auto value = static_cast<float>(ties ? std::round(3 * stream.normal()) : stream.normal());
        columns[c * block.stride + i] = c > inputs ? std::fabs(value) + 0.25F : value + 0.0F;
      }
    }
    block.columns = columns.data();
  }
  Block(const Block& other) : columns(other.columns), block(other.block) { block.columns = columns.data(); }
};

constexpr std::size_t kSizes[] = {1,  2,  3,   8,   15,  16,   17,   31,   32,
                                  33, 48, 100, 512, 513, 4095, 4096, 4097, 10000};

template <class Test>
void for_random_blocks(Test test) {
  std::uint64_t trial = 0;
  for (const std::size_t size : kSizes) {
    for (const std::size_t inputs : {1, 2, 3, 6, 9, 20}) {
      for (const bool weighted : {false, true}) {
        Stream stream = kKernelDraws.stream("block", trial++);
        const Block block(stream, inputs, weighted, stream.below(40), size);
        test(block, stream);
      }
    }
  }
}

template <class Number>
auto bits_of(Number number) {
  if constexpr (sizeof(Number) == 8) {
    return std::bit_cast<std::uint64_t>(number);
  } else {
    return std::bit_cast<std::uint32_t>(number);
  }
}

TEST(TreeKernels, RoundUp) {
  Stream stream = kKernelDraws.stream("round");
  for (std::size_t size = 0; size < 60; ++size) {
    std::vector<double> from(size);
    for (double& x : from) x = stream.normal() * std::exp2(stream.uniform(-160, 130));
    if (size > 3) from[3] = -1e-60;
    for (const TreeKernels* kernels : usable_tree_kernels()) {
      std::vector<float> to(size + 1, -7);
      kernels->round_up(from.data(), size, to.data());
      for (std::size_t i = 0; i < size; ++i)
        ASSERT_EQ(bits_of(to[i]), bits_of(rounded_up(from[i]))) << from[i];
      ASSERT_EQ(to[size], -7) << "nothing is written behind the end";
    }
  }
}

TEST(TreeKernels, SumOutputs) {
  for_random_blocks([](const Block& block, Stream&) {
    const SampleBlock& b = block.block;
    double weight = 0, sum = 0;
    for (std::size_t i = 0; i < b.size(); ++i) {
      const double w = b.weighted ? b.weights()[i] : 1;
      weight += w;
      sum += w * b.outputs()[i];
    }
    const OutputSums expected = portable_tree_kernels().sum_outputs(b);
    EXPECT_NEAR(expected.weight, weight, 1e-12 * weight);
    EXPECT_NEAR(expected.sum, sum, 1e-12 * weight);
    EXPECT_EQ(expected.least, *std::min_element(b.outputs(), b.outputs() + b.size()));
    EXPECT_EQ(expected.most, *std::max_element(b.outputs(), b.outputs() + b.size()));
    for (const TreeKernels* kernels : usable_tree_kernels()) {
      const OutputSums sums = kernels->sum_outputs(b);
      ASSERT_EQ(bits_of(sums.weight), bits_of(expected.weight)) << kernels->name;
      ASSERT_EQ(bits_of(sums.sum), bits_of(expected.sum)) << kernels->name;
      ASSERT_EQ(bits_of(sums.least), bits_of(expected.least)) << kernels->name;
      ASSERT_EQ(bits_of(sums.most), bits_of(expected.most)) << kernels->name;
    }
  });
}

std::vector<Candidate> candidates_for(const SampleBlock& block, Stream& stream) {
  std::vector<Candidate> candidates(1 + stream.below(block.inputs));
  for (Candidate& candidate : candidates) {
    candidate.feature = static_cast<std::uint32_t>(stream.below(block.inputs));
    candidate.threshold = block.column(candidate.feature)[stream.below(block.size())];
  }
  return candidates;
}

TEST(TreeKernels, FindRanges) {
  for_random_blocks([](const Block& block, Stream& stream) {
    for (const TreeKernels* kernels : usable_tree_kernels()) {
      std::vector<Candidate> candidates = candidates_for(block.block, stream);
      kernels->find_ranges(block.block, candidates.data(), candidates.size());
      for (const Candidate& c : candidates) {
        const float* x = block.block.column(c.feature);
        ASSERT_EQ(c.low, *std::min_element(x, x + block.block.size())) << kernels->name;
        ASSERT_EQ(c.high, *std::max_element(x, x + block.block.size())) << kernels->name;
      }
    }
  });
}

TEST(TreeKernels, FindLowSides) {
  for_random_blocks([](const Block& block, Stream& stream) {
    const SampleBlock& b = block.block;
    std::vector<Candidate> expected = candidates_for(b, stream);
    portable_tree_kernels().find_low_sides(b, expected.data(), expected.size());
    for (const Candidate& c : expected) {
      std::size_t count = 0;
      double weight = 0, sum = 0;
      for (std::size_t i = 0; i < b.size(); ++i) {
        if (b.column(c.feature)[i] > c.threshold) continue;
        const double w = b.weighted ? b.weights()[i] : 1;
        ++count;
        weight += w;
        sum += w * b.outputs()[i];
      }
      EXPECT_EQ(c.count, count);
      EXPECT_NEAR(c.weight, weight, 1e-5 * weight);
      EXPECT_NEAR(c.sum, sum, 3e-5 * weight);
    }
    for (const TreeKernels* kernels : usable_tree_kernels()) {
      std::vector<Candidate> candidates = expected;
      for (Candidate& c : candidates) c.sum = c.weight = -1;
      kernels->find_low_sides(b, candidates.data(), candidates.size());
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        ASSERT_EQ(candidates[i].count, expected[i].count) << kernels->name;
        ASSERT_EQ(bits_of(candidates[i].sum), bits_of(expected[i].sum)) << kernels->name;
        ASSERT_EQ(bits_of(candidates[i].weight), bits_of(expected[i].weight)) << kernels->name;
      }
    }
  });
}

TEST(TreeKernels, Partition) {
  for_random_blocks([](const Block& given, Stream& stream) {
    const Candidate split = candidates_for(given.block, stream)[0];
    const std::size_t columns = 1 + stream.below(given.block.width());  // that fit into the scratch
    std::vector<float> scratch(columns * (given.block.size() + kLanes));
    for (const TreeKernels* kernels : usable_tree_kernels()) {
      Block block = given;
      kernels->partition(block.block, split.feature, split.threshold, scratch.data(), scratch.size());
      std::vector<float> expected = given.columns;
      for (std::size_t c = 0; c < given.block.width(); ++c) {
        float* next = expected.data() + c * given.block.stride + given.block.begin;
        for (const bool low : {true, false}) {
          for (std::size_t i = 0; i < given.block.size(); ++i) {
            const bool is_low = given.block.column(split.feature)[i] <= split.threshold;
            if (is_low == low) *next++ = given.block.column(c)[i];
          }
        }
      }
      ASSERT_EQ(block.columns, expected) << kernels->name << ": rows outside the block stay as well";
    }
  });
}

TEST(TreeKernels, LowProducts) {
  for_random_blocks([](const Block& block, Stream& stream) {
    const SampleBlock& b = block.block;
    Candidate split = candidates_for(b, stream)[0];
    if (stream.below(4) == 0) split.threshold = std::numeric_limits<float>::infinity();
    std::vector<float> centre(b.inputs + 1), work(product_work(b.inputs));
    for (float& c : centre) c = static_cast<float>(stream.normal());
    std::vector<double> expected(triangle(b.inputs + 2));
    portable_tree_kernels().low_products(b, split.feature, split.threshold, centre.data(), work.data(),
                                         expected.data());
    std::vector<double> sums(expected.size()), row(b.inputs + 2);
    double weights = 0;
    for (std::size_t i = 0; i < b.size(); ++i) {
      if (b.column(split.feature)[i] > split.threshold) continue;
      row[0] = 1;
      for (std::size_t c = 0; c <= b.inputs; ++c)
        row[c + 1] = static_cast<double>(b.column(c)[i]) - centre[c];
      const double w = b.weighted ? b.weights()[i] : 1;
      weights += w;
      for (std::size_t u = 0; u < row.size(); ++u) {
        for (std::size_t v = 0; v <= u; ++v) sums[triangle(u) + v] += w * row[u] * row[v];
      }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) ASSERT_NEAR(expected[i], sums[i], 1e-4 * weights);
    for (const TreeKernels* kernels : usable_tree_kernels()) {
      kernels->low_products(b, split.feature, split.threshold, centre.data(), work.data(), sums.data());
      for (std::size_t i = 0; i < sums.size(); ++i) {
        ASSERT_EQ(bits_of(sums[i]), bits_of(expected[i])) << kernels->name;
      }
    }
  });
}

}  // namespace
}  // namespace coppice
