#include "solvers/approximators/forest_tops.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <algorithm>
#include <limits>
#include <string_view>

#include "solvers/approximators/forest.h"
#include "solvers/approximators/tree_kernels.h"

namespace coppice {
namespace {

constexpr std::size_t kSplits = 7;  // of a block

/// Fills a block from a node on; the nodes that its exits lead to.
std::array<std::uint32_t, TreeTop::kExits> fill(const ForestNode* nodes, std::uint32_t root,
                                                std::array<float, 8>& thresholds,
                                                std::array<std::uint8_t, 8>& features) {
  thresholds.fill(std::numeric_limits<float>::infinity());
  features.fill(0);
  std::array<std::uint32_t, kSplits + TreeTop::kExits> heap{root};
  for (std::size_t i = 0; i < kSplits; ++i) {
    const ForestNode& node = nodes[heap[i]];
    const bool is_split = node.ahead() != 0;
    if (is_split) {
      thresholds[i] = node.value;
      features[i] = static_cast<std::uint8_t>(node.feature());
    }
    heap[2 * i + 1] = heap[i] + node.ahead();
    heap[2 * i + 2] = heap[2 * i + 1] + (is_split ? 1 : 0);
  }
  std::array<std::uint32_t, TreeTop::kExits> exits;
  std::copy(heap.begin() + kSplits, heap.end(), exits.begin());
  return exits;
}

std::size_t exit_of(const TreeTop& top, std::size_t block, const float* x) {
  std::size_t at = 0;
  while (at < kSplits) at = 2 * at + 1 + (x[top.features[block][at]] > top.thresholds[block][at] ? 1 : 0);
  return at - kSplits;
}

void descend_portable(const TreeTop* tops, std::size_t size, const float* x, std::uint64_t* places) {
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t first = exit_of(tops[i], 0, x);
    places[i] = tops[i].exits[TreeTop::kExits * first + exit_of(tops[i], 1 + first, x)];
  }
}

#if defined(__x86_64__)

/// The exit for each outcome of the seven comparisons, bit i for split i.
constexpr std::array<std::uint8_t, 1 << kSplits> make_outcomes() {
  std::array<std::uint8_t, 1 << kSplits> exits{};
  for (std::size_t outcome = 0; outcome < exits.size(); ++outcome) {
    std::size_t at = 0;
    while (at < kSplits) at = 2 * at + 1 + (outcome >> at & 1);
    exits[outcome] = static_cast<std::uint8_t>(at - kSplits);
  }
  return exits;
}
constexpr std::array<std::uint8_t, 1 << kSplits> kOutcomes = make_outcomes();

/// Of at most 8 features, or 16 where kWide.
template <bool kWide>
__attribute__((target("avx2"))) inline std::size_t exit_avx2(const TreeTop& top, std::size_t block,
                                                             __m256 low_x, __m256 high_x) {
  const __m256i features =
      _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(top.features[block].data())));
  __m256 x = _mm256_permutevar8x32_ps(low_x, features);
  if constexpr (kWide) {
    const __m256 is_high = _mm256_castsi256_ps(_mm256_slli_epi32(features, 28));  // by the sign bit
    x = _mm256_blendv_ps(x, _mm256_permutevar8x32_ps(high_x, features), is_high);
  }
  const __m256 above = _mm256_cmp_ps(x, _mm256_load_ps(top.thresholds[block].data()), _CMP_GT_OQ);
  return kOutcomes[static_cast<std::size_t>(_mm256_movemask_ps(above)) % kOutcomes.size()];
}

template <bool kWide>
__attribute__((target("avx2"))) void descend_avx2(const TreeTop* tops, std::size_t size, const float* x,
                                                  std::uint64_t* places) {
  const __m256 low_x = _mm256_loadu_ps(x);
  const __m256 high_x = kWide ? _mm256_loadu_ps(x + 8) : low_x;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t first = exit_avx2<kWide>(tops[i], 0, low_x, high_x);
    const std::size_t second = exit_avx2<kWide>(tops[i], 1 + first, low_x, high_x);
    places[i] = tops[i].exits[TreeTop::kExits * first + second];
  }
}

DescendTops fastest(std::size_t features) {
  if (avx2_tree_kernels() == nullptr || features > 16) return descend_portable;
  return features > 8 ? descend_avx2<true> : descend_avx2<false>;
}

#else

DescendTops fastest(std::size_t) {
  return descend_portable;
}

#endif

}  // namespace

TreeTop make_top(const ForestNode* nodes, std::uint32_t root) {
  TreeTop top;
  const auto middle = fill(nodes, root, top.thresholds[0], top.features[0]);
  for (std::size_t i = 0; i < TreeTop::kExits; ++i) {
    const auto exits = fill(nodes, middle[i], top.thresholds[1 + i], top.features[1 + i]);
    std::copy(exits.begin(), exits.end(), top.exits.begin() + static_cast<std::ptrdiff_t>(exits.size() * i));
  }
  return top;
}

DescendTops top_descent(std::size_t features) {
  static const bool kIsPortable = std::string_view(tree_kernels().name) == "portable";
  return kIsPortable ? descend_portable : fastest(features);
}

std::vector<DescendTops> usable_top_descents(std::size_t features) {
  std::vector<DescendTops> usable = {descend_portable};
  if (fastest(features) != descend_portable) usable.push_back(fastest(features));
  return usable;
}

}  // namespace coppice
