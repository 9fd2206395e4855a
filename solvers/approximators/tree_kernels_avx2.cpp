#include "solvers/approximators/tree_kernels.h"

#if defined(__x86_64__)

#include <immintrin.h>

#include <array>
#include <bit>
#include <cstring>
#include <limits>

namespace coppice {
namespace {

constexpr std::size_t kHalf = 8;  // lanes of a register

// For each set of lanes: its lanes in their order, then the others in theirs.
constexpr std::array<std::array<std::uint8_t, kHalf>, 256> set_lanes_first() {
  std::array<std::array<std::uint8_t, kHalf>, 256> table{};
  for (unsigned set = 0; set < 256; ++set) {
    std::size_t next = 0;
    for (const unsigned wanted : {1u, 0u}) {
      for (unsigned lane = 0; lane < kHalf; ++lane) {
        if ((set >> lane & 1u) == wanted) table[set][next++] = static_cast<std::uint8_t>(lane);
      }
    }
  }
  return table;
}
alignas(64) constexpr std::array<std::array<std::uint8_t, kHalf>, 256> kSetLanesFirst = set_lanes_first();

alignas(64) constexpr std::int32_t kOnes[2 * kLanes] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                        -1, -1, -1, -1, -1, -1, -1, -1};

}  // namespace
}  // namespace coppice

// Only what follows is compiled for AVX2, and it calls nothing from outside, so that no other code of the
// program can end up with instructions that a processor lacks.
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,popcnt"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,popcnt")
#endif

namespace coppice {
namespace {

#include "solvers/approximators/tree_kernels_x86.h"

constexpr std::size_t kColumnsAtOnce = 4;

struct Floats {
  __m256 low;
  __m256 high;
};
using Mask = Floats;  // all bits of a lane, or none
using Counts = std::size_t;
struct Doubles {
  __m256d part[4];
};

inline __m256 first_half(std::size_t size) {
  return _mm256_loadu_ps(reinterpret_cast<const float*>(kOnes + kLanes - size));
}
inline Mask first(std::size_t size) {
  const auto* from = reinterpret_cast<const float*>(kOnes + kLanes - size);
  return {_mm256_loadu_ps(from), _mm256_loadu_ps(from + kHalf)};
}
inline Mask both(Mask a, Mask b) {
  return {_mm256_and_ps(a.low, b.low), _mm256_and_ps(a.high, b.high)};
}
inline Floats all(float value) {
  return {_mm256_set1_ps(value), _mm256_set1_ps(value)};
}
inline Floats load(const float* from) {
  return {_mm256_loadu_ps(from), _mm256_loadu_ps(from + kHalf)};
}
inline Floats load_part(const float* from, Mask mask, Floats other) {
  const Floats values = load(from);
  return {_mm256_blendv_ps(other.low, values.low, mask.low),
          _mm256_blendv_ps(other.high, values.high, mask.high)};
}
inline void store(float* to, Floats values) {
  _mm256_storeu_ps(to, values.low);
  _mm256_storeu_ps(to + kHalf, values.high);
}
inline Floats add(Floats a, Floats b) {
  return {_mm256_add_ps(a.low, b.low), _mm256_add_ps(a.high, b.high)};
}
inline Floats sub(Floats a, Floats b) {
  return {_mm256_sub_ps(a.low, b.low), _mm256_sub_ps(a.high, b.high)};
}
inline Floats mul(Floats a, Floats b) {
  return {_mm256_mul_ps(a.low, b.low), _mm256_mul_ps(a.high, b.high)};
}
inline Floats min(Floats a, Floats b) {
  return {_mm256_min_ps(a.low, b.low), _mm256_min_ps(a.high, b.high)};
}
inline Floats max(Floats a, Floats b) {
  return {_mm256_max_ps(a.low, b.low), _mm256_max_ps(a.high, b.high)};
}
inline Floats root_of(Floats a) {
  return {_mm256_sqrt_ps(a.low), _mm256_sqrt_ps(a.high)};
}
inline Mask at_most(Floats x, Floats threshold) {
  return {_mm256_cmp_ps(x.low, threshold.low, _CMP_LE_OQ), _mm256_cmp_ps(x.high, threshold.high, _CMP_LE_OQ)};
}
inline Floats keep(Mask mask, Floats a) {
  return both(mask, a);
}
inline Floats add_where(Floats a, Mask mask, Floats b) {
  return add(a, keep(mask, b));  // sums that begin with 0 are never -0, so adding 0 changes none
}
inline unsigned bits(__m256 mask) {
  return static_cast<unsigned>(_mm256_movemask_ps(mask));
}
inline Counts no_counts() {
  return 0;
}
inline Counts add_count(Counts counts, Mask mask) {
  return counts + static_cast<Counts>(__builtin_popcount(bits(mask.low) | bits(mask.high) << kHalf));
}
inline std::size_t counted(Counts counts) {
  return counts;
}
inline float total(Floats a) {
  return total_of_8(_mm256_add_ps(a.low, a.high));
}
inline float least(Floats a) {
  return least_of_8(_mm256_min_ps(a.low, a.high));
}
inline float most(Floats a) {
  return most_of_8(_mm256_max_ps(a.low, a.high));
}
inline Doubles no_doubles() {
  const __m256d zero = _mm256_setzero_pd();
  return {{zero, zero, zero, zero}};
}
inline Doubles widened(Floats a) {
  return {{_mm256_cvtps_pd(_mm256_castps256_ps128(a.low)), _mm256_cvtps_pd(_mm256_extractf128_ps(a.low, 1)),
           _mm256_cvtps_pd(_mm256_castps256_ps128(a.high)),
           _mm256_cvtps_pd(_mm256_extractf128_ps(a.high, 1))}};
}
inline Doubles add(Doubles a, Floats b) {
  const Doubles wide = widened(b);
  for (int i = 0; i < 4; ++i) a.part[i] = _mm256_add_pd(a.part[i], wide.part[i]);
  return a;
}
inline Doubles add_product(Doubles a, Floats b, Floats c) {
  const Doubles x = widened(b);
  const Doubles y = widened(c);
  for (int i = 0; i < 4; ++i) a.part[i] = _mm256_add_pd(a.part[i], _mm256_mul_pd(x.part[i], y.part[i]));
  return a;
}
inline double total(Doubles a) {
  return total_of_4(_mm256_add_pd(_mm256_add_pd(a.part[0], a.part[2]), _mm256_add_pd(a.part[1], a.part[3])));
}

#include "solvers/approximators/tree_kernels_body.h"

// To the nearest, and a step up from those that are below.
inline __m128 rounded_up_4(__m256d x) {
  const __m128 nearest = _mm256_cvtpd_ps(x);
  const __m256 is_below = _mm256_castpd_ps(_mm256_cmp_pd(_mm256_cvtps_pd(nearest), x, _CMP_LT_OQ));
  const __m128 below =
      _mm_shuffle_ps(_mm256_castps256_ps128(is_below), _mm256_extractf128_ps(is_below, 1), 0x88);
  const __m128i bits = _mm_castps_si128(nearest);
  const __m128i next = _mm_or_si128(_mm_srai_epi32(bits, 31), _mm_set1_epi32(1));
  const __m128i up = _mm_add_epi32(bits, _mm_and_si128(_mm_castps_si128(below), next));
  return _mm_add_ps(_mm_castsi128_ps(up), _mm_setzero_ps());  // makes 0 of -0
}

void round_up(const double* from, std::size_t size, float* to) {
  std::size_t i = 0;
  for (; i + 4 <= size; i += 4) _mm_storeu_ps(to + i, rounded_up_4(_mm256_loadu_pd(from + i)));
  if (i == size) return;
  double rest[4] = {};
  float rounded[4];
  std::memcpy(rest, from + i, (size - i) * sizeof(double));
  _mm_storeu_ps(rounded, rounded_up_4(_mm256_loadu_pd(rest)));
  std::memcpy(to + i, rounded, (size - i) * sizeof(float));
}

inline __m256i lanes_first(unsigned set) {
  return _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(kSetLanesFirst[set].data())));
}

// Writes the first `count` lanes, at most kHalf, and the others as they are.
inline void store_first(float* to, std::size_t count, __m256 values) {
  _mm256_storeu_ps(to, _mm256_blendv_ps(_mm256_loadu_ps(to), values, first_half(count)));
}

// A few columns at once, by a split along x: what separates a group of rows is looked up once. The low side
// stays in place; the high one goes through `scratch`, where each column has room for its rows and a
// register.
void partition_columns(float* const* columns, std::size_t width, const float* x, float threshold,
                       std::size_t size, float* scratch) {
  const __m256 t = _mm256_set1_ps(threshold);
  const std::size_t room = size + kHalf;
  std::size_t low = 0;
  std::size_t i = 0;
  for (; i + kHalf <= size; i += kHalf) {
    const unsigned set = bits(_mm256_cmp_ps(_mm256_loadu_ps(x + i), t, _CMP_LE_OQ));
    const __m256i lows = lanes_first(set);
    const __m256i highs = lanes_first(set ^ 0xffu);
    for (std::size_t c = 0; c < width; ++c) {
      const __m256 values = _mm256_loadu_ps(columns[c] + i);
      _mm256_storeu_ps(columns[c] + low, _mm256_permutevar8x32_ps(values, lows));
      _mm256_storeu_ps(scratch + c * room + i - low, _mm256_permutevar8x32_ps(values, highs));
    }
    low += static_cast<std::size_t>(__builtin_popcount(set));
  }
  const unsigned valid = (1u << (size - i)) - 1;
  const unsigned set = valid & bits(_mm256_cmp_ps(_mm256_loadu_ps(x + i), t, _CMP_LE_OQ));
  const __m256i lows = lanes_first(set);
  const __m256i highs = lanes_first(set ^ valid);
  const auto count = static_cast<std::size_t>(__builtin_popcount(set));
  for (std::size_t c = 0; c < width; ++c) {
    const __m256 values = _mm256_loadu_ps(columns[c] + i);
    store_first(columns[c] + low, count, _mm256_permutevar8x32_ps(values, lows));
    const float* from = scratch + c * room;
    _mm256_storeu_ps(scratch + c * room + i - low, _mm256_permutevar8x32_ps(values, highs));
    float* to = columns[c] + low + count;
    const std::size_t above = size - low - count;
    std::size_t j = 0;
    for (; j + kHalf <= above; j += kHalf) _mm256_storeu_ps(to + j, _mm256_loadu_ps(from + j));
    if (j < above) store_first(to + j, above - j, _mm256_loadu_ps(from + j));
  }
}

// As many columns at once as there is room for, the one that splits among the last.
void partition(const SampleBlock& block, std::uint32_t feature, float threshold, float* scratch,
               std::size_t scratch_size) {
  constexpr std::size_t kMost = 16;
  const std::size_t fit = scratch_size / (block.size() + kHalf);
  const std::size_t at_once = fit < kMost ? fit : kMost;
  float* columns[kMost];
  std::size_t taken = 0;
  std::size_t c = feature;
  for (std::size_t left = block.width(); left > 0; --left) {
    c = c + 1 < block.width() ? c + 1 : 0;
    columns[taken++] = block.column(c);
    if (taken < at_once && left > 1) continue;
    partition_columns(columns, taken, block.column(feature), threshold, block.size(), scratch);
    taken = 0;
  }
}

}  // namespace

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

const TreeKernels* avx2_tree_kernels() {
  static constexpr TreeKernels kKernels = table("avx2");
  const bool runs = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt");
  return runs ? &kKernels : nullptr;
}

}  // namespace coppice

#else

namespace coppice {

const TreeKernels* avx2_tree_kernels() {
  return nullptr;
}

}  // namespace coppice

#endif
