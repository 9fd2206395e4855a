#include "solvers/approximators/tree_kernels.h"

#if defined(__x86_64__)

#include <immintrin.h>

#include <bit>
#include <cstring>
#include <limits>

// Only what follows is compiled for AVX-512, and it calls nothing from outside, so that no other code of the
// program can end up with instructions that a processor lacks.
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx512f,avx512bw,avx512dq,avx512vl,popcnt"))), \
                             apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx512f,avx512bw,avx512dq,avx512vl,popcnt")
#endif

namespace coppice {
namespace {

#include "solvers/approximators/tree_kernels_x86.h"

constexpr std::size_t kColumnsAtOnce = 8;

using Floats = __m512;
using Mask = __mmask16;
using Counts = std::size_t;
struct Doubles {
  __m512d low;
  __m512d high;
};

inline Mask first(std::size_t size) {
  return static_cast<Mask>((1u << size) - 1);
}
inline Mask both(Mask a, Mask b) {
  return static_cast<Mask>(a & b);
}
inline Floats all(float value) {
  return _mm512_set1_ps(value);
}
inline Floats load(const float* from) {
  return _mm512_loadu_ps(from);
}
inline Floats load_part(const float* from, Mask mask, Floats other) {
  return _mm512_mask_loadu_ps(other, mask, from);
}
inline void store(float* to, Floats values) {
  _mm512_storeu_ps(to, values);
}
inline Floats add(Floats a, Floats b) {
  return _mm512_add_ps(a, b);
}
inline Floats sub(Floats a, Floats b) {
  return _mm512_sub_ps(a, b);
}
inline Floats mul(Floats a, Floats b) {
  return _mm512_mul_ps(a, b);
}
inline Floats min(Floats a, Floats b) {
  return _mm512_min_ps(a, b);
}
inline Floats max(Floats a, Floats b) {
  return _mm512_max_ps(a, b);
}
inline Floats root_of(Floats a) {
  return _mm512_sqrt_ps(a);
}
inline Mask at_most(Floats x, Floats threshold) {
  return _mm512_cmp_ps_mask(x, threshold, _CMP_LE_OQ);
}
inline Floats add_where(Floats a, Mask mask, Floats b) {
  return _mm512_mask_add_ps(a, mask, a, b);
}
inline Floats keep(Mask mask, Floats a) {
  return _mm512_maskz_mov_ps(mask, a);
}
inline Counts no_counts() {
  return 0;
}
inline Counts add_count(Counts counts, Mask mask) {
  return counts + static_cast<Counts>(__builtin_popcount(mask));
}
inline std::size_t counted(Counts counts) {
  return counts;
}
inline __m256 low_half(Floats a) {
  return _mm512_castps512_ps256(a);
}
inline __m256 high_half(Floats a) {
  return _mm512_extractf32x8_ps(a, 1);
}
inline float total(Floats a) {
  return total_of_8(_mm256_add_ps(low_half(a), high_half(a)));
}
inline float least(Floats a) {
  return least_of_8(_mm256_min_ps(low_half(a), high_half(a)));
}
inline float most(Floats a) {
  return most_of_8(_mm256_max_ps(low_half(a), high_half(a)));
}
inline Doubles no_doubles() {
  return {_mm512_setzero_pd(), _mm512_setzero_pd()};
}
inline Doubles widened(Floats a) {
  return {_mm512_cvtps_pd(low_half(a)), _mm512_cvtps_pd(high_half(a))};
}
inline Doubles add(Doubles a, Floats b) {
  const Doubles wide = widened(b);
  return {_mm512_add_pd(a.low, wide.low), _mm512_add_pd(a.high, wide.high)};
}
inline Doubles add_product(Doubles a, Floats b, Floats c) {
  const Doubles x = widened(b);
  const Doubles y = widened(c);
  return {_mm512_add_pd(a.low, _mm512_mul_pd(x.low, y.low)),
          _mm512_add_pd(a.high, _mm512_mul_pd(x.high, y.high))};
}
inline double total(Doubles a) {
  const __m512d sum = _mm512_add_pd(a.low, a.high);
  // The variants with a mask, as those without make g++ 12 warn of its own headers.
  return total_of_4(
      _mm256_add_pd(_mm512_maskz_extractf64x4_pd(0xf, sum, 0), _mm512_maskz_extractf64x4_pd(0xf, sum, 1)));
}

#include "solvers/approximators/tree_kernels_body.h"

void round_up(const double* from, std::size_t size, float* to) {
  const __m256 zero = _mm256_setzero_ps();  // makes 0 of -0
  for (std::size_t i = 0; i < size; i += 8) {
    const auto mask = static_cast<__mmask8>(size - i < 8 ? (1u << (size - i)) - 1 : 0xff);
    const __m512d values = _mm512_maskz_loadu_pd(mask, from + i);
    const __m256 rounded = _mm512_cvt_roundpd_ps(values, _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC);
    _mm256_mask_storeu_ps(to + i, mask, _mm256_add_ps(rounded, zero));
  }
}

// One column, by a split along x.
void partition_column(const float* x, float threshold, std::size_t size, float* values, float* scratch) {
  const Floats t = all(threshold);
  std::size_t low = 0;
  std::size_t high = 0;
  std::size_t i = 0;
  for (; i + kLanes <= size; i += kLanes) {
    const Mask mask = at_most(load(x + i), t);
    const Floats v = load(values + i);
    store(values + low, _mm512_maskz_compress_ps(mask, v));
    store(scratch + high, _mm512_maskz_compress_ps(static_cast<Mask>(~mask), v));
    const auto count = static_cast<std::size_t>(__builtin_popcount(mask));
    low += count;
    high += kLanes - count;
  }
  if (i < size) {
    const Mask valid = first(size - i);
    const Mask mask = both(valid, at_most(load(x + i), t));
    const auto rest = static_cast<Mask>(valid & ~mask);
    const Floats v = load(values + i);
    const auto count = static_cast<std::size_t>(__builtin_popcount(mask));
    _mm512_mask_storeu_ps(values + low, first(count), _mm512_maskz_compress_ps(mask, v));
    store(scratch + high, _mm512_maskz_compress_ps(rest, v));
    low += count;
    high += size - i - count;
  }
  std::memcpy(values + low, scratch, high * sizeof(float));
}

// All columns of rows that fit into a vector. What lies behind the rows is written again as it was: so each
// store is whole, and what loads the low side next need not wait until it has reached the cache.
void partition_few(const SampleBlock& block, std::uint32_t feature, float threshold) {
  const Mask valid = first(block.size());
  const Mask low = both(valid, at_most(load(block.column(feature)), all(threshold)));
  const auto high = static_cast<Mask>(valid & ~low);
  const auto places = static_cast<Mask>(valid & ~first(add_count(no_counts(), low)));
  const std::size_t width = block.width();
  for (std::size_t c = 0; c < width; ++c) {
    const Floats values = load(block.column(c));
    const Floats sorted = _mm512_mask_compress_ps(values, low, values);
    store(block.column(c), _mm512_mask_expand_ps(sorted, places, _mm512_maskz_compress_ps(high, values)));
  }
}

void partition(const SampleBlock& block, std::uint32_t feature, float threshold, float* scratch,
               std::size_t) {
  if (block.size() <= kLanes) return partition_few(block, feature, threshold);
  partition_by_column(block, feature, threshold, scratch, partition_column);
}

}  // namespace

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

const TreeKernels* avx512_tree_kernels() {
  static constexpr TreeKernels kKernels = table("avx512");
  const bool runs = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                    __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
                    __builtin_cpu_supports("popcnt");
  return runs ? &kKernels : nullptr;
}

}  // namespace coppice

#else

namespace coppice {

const TreeKernels* avx512_tree_kernels() {
  return nullptr;
}

}  // namespace coppice

#endif
