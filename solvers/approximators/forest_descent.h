#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "solvers/approximators/forest.h"

namespace coppice {

/// Leads kSize descents to their leaves, number i by its inputs input(i, feature). Their loads overlap, where
/// one descent after the other would wait for each; in a leaf a descent stays.
template <std::size_t kSize, class Input>
inline void descend(const ForestNode* nodes, std::array<std::uint64_t, kSize>& places, const Input& input) {
  std::array<std::uint64_t, kSize> at = places;  // in registers, or nearly
  std::uint32_t moved;
  do {
    moved = 0;
#pragma GCC unroll 32
    for (std::size_t i = 0; i < kSize; ++i) {
      const ForestNode& node = nodes[at[i]];
      const std::uint32_t step = node.ahead() + (input(i, node.feature()) > node.value ? 1 : 0);
      at[i] += step;
      moved |= step;
    }
  } while (moved != 0);
  places = at;
}

/// True when single precision has normal numbers of x's exponent.
inline bool is_normal(double x) {
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(x) >> 52 & 0x7FF;
  return exponent - 897 < 254;
}
/// The bits of rounded_up(x) for such an x. A call waits for its inputs, and this takes fewer steps.
inline std::uint32_t normal_rounded_up(double x) {
  constexpr std::uint64_t kCut = 29;  // bits of the fraction that single precision has not
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t sign = bits >> 63;
  const std::uint64_t up = bits + ((sign - 1) & ((std::uint64_t{1} << kCut) - 1));
  constexpr std::uint64_t kExponents = std::uint64_t{1023 - 127} << 23;
  return static_cast<std::uint32_t>((up >> kCut) - kExponents) | static_cast<std::uint32_t>(sign << 31);
}

/// An input as descend_all compares it: a threshold is below it where the threshold's bits, some of them
/// flipped, are below `key`. The bits of numbers in single precision are in their order but for the sign, and
/// which to flip depends on the sign of the input alone.
struct InputKey {
  std::uint32_t flip, key;

  /// Of rounded_up(x). Nothing is below NaN, and no zero below another.
  static InputKey of(float x) {
    const auto given = std::bit_cast<std::uint32_t>(x);
    const std::uint32_t bits =
        given == 0 ? 0x80000000U : given;  // above all that is negative, below both zeros
    const std::uint32_t flip = bits >> 31 != 0 ? 0xFFFFFFFFU : 0x80000000U;
    return x != x ? of_leaf() : InputKey{flip, bits ^ flip};
  }
  /// What a leaf compares with: a descent stays in it.
  static InputKey of_leaf() { return {0, 0}; }
};

/// A point as the descents of one call compare it; the feature after the last is that of leaves.
struct RoundedPoint {
  std::array<float, kMaxTreeInputs + 1> x;
  std::array<InputKey, kMaxTreeInputs + 1> keys;

  void set(std::size_t feature, double value) {
    x[feature] = is_normal(value) ? std::bit_cast<float>(normal_rounded_up(value)) : rounded_up(value);
    keys[feature] = InputKey::of(x[feature]);
  }
};

/// As descend, of one point in many trees: whole numbers are compared, with fewer instructions, so that more
/// of the descents are under way at a time.
template <std::size_t kSize>
inline void descend_all(const ForestNode* nodes, std::array<std::uint64_t, kSize>& places,
                        const InputKey* keys) {
  std::array<std::uint64_t, kSize> at = places;
  std::uint64_t moved;
  do {
    moved = 0;
#pragma GCC unroll 32
    for (std::size_t i = 0; i < kSize; ++i) {
      std::uint64_t node;  // the value, then the link
      std::memcpy(&node, nodes + at[i], sizeof node);
      const InputKey& input = keys[node >> 56];
      const std::uint64_t ahead = node >> 32 & ForestNode::kMaxAhead;
      std::uint64_t next = at[i] + ahead;
      if ((static_cast<std::uint32_t>(node) ^ input.flip) < input.key) ++next;  // compiles to an addition
      at[i] = next;
      moved |= ahead;
      asm("" : "+r"(moved));  // now: to add all up in the end, the compiler would store each
    }
  } while (moved != 0);
  places = at;
}

/// Whole numbers in the order of numbers in single precision.
inline std::uint32_t ordered(std::uint32_t bits) {
  const std::uint32_t sign = 0U - (bits >> 31);  // all bits, or none
  return bits ^ (sign | 0x80000000U);
}

/// An input as descend_alone compares it: rounded_up(x), in order. Zeros are equal, and NaN is not above
/// anything.
inline std::uint32_t key_of(double x) {
  if (is_normal(x)) [[likely]]
    return ordered(normal_rounded_up(x));
  const float up = rounded_up(x);
  return x != x ? 0U : ordered(std::bit_cast<std::uint32_t>(up == 0 ? -0.0F : up));
}

/// The leaf of a point in a single tree; `keys` are those of its features. One descent is as slow as what
/// each of its steps waits for: so both children are loaded while it is seen which one it is, whole numbers
/// are compared, which is faster, and the choice is no branch, which would be guessed wrongly half the time.
inline ForestNode descend_alone(const ForestNode* nodes, std::uint32_t root, const std::uint32_t* keys) {
  const auto load = [](const ForestNode* node) {
    std::uint64_t bits;  // the value, then the link
    std::memcpy(&bits, node, sizeof bits);
    return bits;
  };
  const ForestNode* at = nodes + root;
  std::uint64_t node = load(at);
  while (const std::uint64_t ahead = node >> 32 & ForestNode::kMaxAhead) {
    const std::uint32_t value = ordered(static_cast<std::uint32_t>(node));
    const std::uint32_t& key = keys[node >> 56];
    at += ahead;
    node = load(at);
    const ForestNode* high_child = at + 1;
    const std::uint64_t high = load(high_child);
#if defined(__x86_64__)
    // Compilers make it a branch, or take four instructions more.
    asm("cmp %[key], %[value]\n\tcmovb %[high], %[node]\n\tcmovb %[high_child], %[at]"
        : [node] "+&r"(node), [at] "+&r"(at)
        : [high] "r"(high), [high_child] "r"(high_child), [key] "m"(key), [value] "r"(value)
        : "cc");
#else
    const std::uint64_t is_high = value < key ? 1 : 0;
    node ^= (node ^ high) & (0U - is_high);
    at += is_high;
#endif
  }
  return std::bit_cast<ForestNode>(node);
}
static_assert(std::endian::native == std::endian::little, "a node's value is in its first four bytes");

}  // namespace coppice
