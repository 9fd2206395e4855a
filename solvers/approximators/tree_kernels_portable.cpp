#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "solvers/approximators/forest.h"
#include "solvers/approximators/tree_kernels.h"

namespace coppice {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kColumnsAtOnce = 2;
constexpr std::size_t kParts = kLanes / 4;

// Four numbers: what every processor with vectors has; both compilers know the type.
using Four = float __attribute__((vector_size(16)));
using FourInts = std::int32_t __attribute__((vector_size(16)));
using TwoDoubles = double __attribute__((vector_size(16)));

struct Floats {
  Four part[kParts];
};
struct Mask {
  FourInts part[kParts];  // -1 or 0
};
using Counts = Mask;  // lane by lane, negative
struct Doubles {
  TwoDoubles part[kLanes / 2];
};

template <class Result, class Work>
inline Result each(Work work) {
  Result result;
#pragma GCC unroll 4
  for (std::size_t i = 0; i < kParts; ++i) result.part[i] = work(i);
  return result;
}

inline FourInts as_ints(Four a) {
  return reinterpret_cast<FourInts>(a);
}
inline Four as_floats(FourInts a) {
  return reinterpret_cast<Four>(a);
}

inline Mask first(std::size_t size) {
  static constexpr std::int32_t kBits[2 * kLanes] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                     -1, -1, -1, -1, -1, -1, -1, -1};
  Mask mask;
  std::memcpy(&mask, kBits + kLanes - size, sizeof mask);
  return mask;
}
inline Mask both(Mask a, Mask b) {
  return each<Mask>([&](std::size_t i) { return a.part[i] & b.part[i]; });
}
inline Floats all(float value) {
  return each<Floats>([&](std::size_t) { return Four{value, value, value, value}; });
}
inline Floats load(const float* from) {
  Floats values;
  std::memcpy(&values, from, sizeof values);
  return values;
}
inline Floats load_part(const float* from, Mask mask, Floats other) {
  const Floats values = load(from);
  return each<Floats>([&](std::size_t i) {
    return as_floats((as_ints(values.part[i]) & mask.part[i]) | (as_ints(other.part[i]) & ~mask.part[i]));
  });
}
inline void store(float* to, Floats values) {
  std::memcpy(to, &values, sizeof values);
}
inline Floats add(Floats a, Floats b) {
  return each<Floats>([&](std::size_t i) { return a.part[i] + b.part[i]; });
}
inline Floats sub(Floats a, Floats b) {
  return each<Floats>([&](std::size_t i) { return a.part[i] - b.part[i]; });
}
inline Floats mul(Floats a, Floats b) {
  return each<Floats>([&](std::size_t i) { return a.part[i] * b.part[i]; });
}
inline Floats min(Floats a, Floats b) {
  return each<Floats>([&](std::size_t i) { return a.part[i] < b.part[i] ? a.part[i] : b.part[i]; });
}
inline Floats max(Floats a, Floats b) {
  return each<Floats>([&](std::size_t i) { return a.part[i] > b.part[i] ? a.part[i] : b.part[i]; });
}
inline Floats root_of(Floats a) {
  for (Four& part : a.part) {
    for (int i = 0; i < 4; ++i) part[i] = std::sqrt(part[i]);
  }
  return a;
}
inline Mask at_most(Floats x, Floats threshold) {
  return each<Mask>([&](std::size_t i) { return x.part[i] <= threshold.part[i]; });
}
inline Floats keep(Mask mask, Floats a) {
  return each<Floats>([&](std::size_t i) { return as_floats(as_ints(a.part[i]) & mask.part[i]); });
}
inline Floats add_where(Floats a, Mask mask, Floats b) {
  return add(a, keep(mask, b));  // sums that begin with 0 are never -0, so adding 0 changes none
}
inline Counts no_counts() {
  return each<Counts>([](std::size_t) { return FourInts{}; });
}
inline Counts add_count(Counts counts, Mask mask) {
  return each<Counts>([&](std::size_t i) { return counts.part[i] + mask.part[i]; });
}
inline std::size_t counted(Counts counts) {
  std::int64_t sum = 0;
  for (const FourInts& part : counts.part) {
    for (int i = 0; i < 4; ++i) sum -= part[i];
  }
  return static_cast<std::size_t>(sum);
}
inline float total(Floats a) {
  const Four sum = (a.part[0] + a.part[2]) + (a.part[1] + a.part[3]);
  return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}
inline float least(Floats a) {
  const Floats b = a;
  float result = kInfinity;
  for (const Four& part : b.part) {
    for (int i = 0; i < 4; ++i) result = std::min(result, part[i]);
  }
  return result;
}
inline float most(Floats a) {
  float result = -kInfinity;
  for (const Four& part : a.part) {
    for (int i = 0; i < 4; ++i) result = std::max(result, part[i]);
  }
  return result;
}
inline Doubles no_doubles() {
  return {};
}
inline TwoDoubles widened(Floats a, std::size_t pair) {
  const Four& part = a.part[pair / 2];
  const std::size_t i = pair % 2 * 2;
  return TwoDoubles{static_cast<double>(part[i]), static_cast<double>(part[i + 1])};
}
inline Doubles add(Doubles a, Floats b) {
  for (std::size_t i = 0; i < kLanes / 2; ++i) a.part[i] += widened(b, i);
  return a;
}
inline Doubles add_product(Doubles a, Floats b, Floats c) {
  for (std::size_t i = 0; i < kLanes / 2; ++i) a.part[i] += widened(b, i) * widened(c, i);
  return a;
}
inline double total(Doubles a) {
  for (std::size_t half = kLanes / 4; half > 0; half /= 2) {
    for (std::size_t i = 0; i < half; ++i) a.part[i] += a.part[i + half];
  }
  return a.part[0][0] + a.part[0][1];
}
inline float* aligned(float* work) {
  return work;
}

#include "solvers/approximators/tree_kernels_body.h"

void round_up(const double* from, std::size_t size, float* to) {
  for (std::size_t i = 0; i < size; ++i) to[i] = rounded_up(from[i]);
}

// One column, by a split along x.
void partition_column(const float* x, float threshold, std::size_t size, float* values, float* scratch) {
  std::size_t low = 0;
  std::size_t high = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t is_low = x[i] <= threshold ? 1 : 0;
    const float value = values[i];
    values[low] = value;
    scratch[high] = value;
    low += is_low;
    high += 1 - is_low;
  }
  std::copy(scratch, scratch + high, values + low);
}

void partition(const SampleBlock& block, std::uint32_t feature, float threshold, float* scratch,
               std::size_t) {
  partition_by_column(block, feature, threshold, scratch, partition_column);
}

}  // namespace

const TreeKernels& portable_tree_kernels() {
  static constexpr TreeKernels kKernels = table("portable");
  return kKernels;
}

std::vector<const TreeKernels*> usable_tree_kernels() {
  std::vector<const TreeKernels*> usable;
  for (const TreeKernels* kernels : {avx512_tree_kernels(), avx2_tree_kernels(), &portable_tree_kernels()}) {
    if (kernels != nullptr) usable.push_back(kernels);
  }
  return usable;
}

const TreeKernels& tree_kernels() {
  static const TreeKernels* const kChosen = [] {
    const std::vector<const TreeKernels*> usable = usable_tree_kernels();
    const char* wanted = std::getenv("COPPICE_KERNELS");
    for (const TreeKernels* kernels : usable) {
      if (wanted != nullptr && std::strcmp(wanted, kernels->name) == 0) return kernels;
    }
    return usable.front();
  }();
  return *kChosen;
}

}  // namespace coppice
