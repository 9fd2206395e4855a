#pragma once

#include <string_view>

namespace coppice {

// The parts of an exported C++ header that are the same for all policies; those with {names} are formats.

inline constexpr std::string_view kCppTop = R"(// Written by {writer}: a {component}.
// Made by node: {provenance}
//
//   {name}::State state;
//   state.{state} = ...;
//   const {name}::Action action = {name}::act(state);
//
// C++17. Nothing is allocated, thrown or kept between calls; calls from several threads do not disturb each
// other. Actions are bit for bit those of the policy file, with every compiler and processor that computes in
// IEEE 754 double precision, rounds to nearest and does not reorder sums (no -ffast-math). -ffp-contract may
// be anything.
#ifndef COPPICE_POLICY_{guard}_H
#define COPPICE_POLICY_{guard}_H

#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#if defined(__FAST_MATH__)
#error "Compile this header without -ffast-math: it promises the bits of the policy file."
#endif
#if defined(FLT_EVAL_METHOD) && (FLT_EVAL_METHOD < 0 || FLT_EVAL_METHOD == 2)
#error "Doubles are kept in another precision here; on 32-bit x86 compile with -msse2 -mfpmath=sse."
#endif

namespace {name} {{

/// What is measured. Any numbers will do; ranges say what the policy was made for. A circular axis is to be
/// given within its range.
)";

inline constexpr std::string_view kCppConstants = R"(
inline constexpr std::size_t kStateSize = {states};
inline constexpr std::size_t kActionSize = {actions};
inline constexpr int kActionId = {id};  ///< of the actions that the problem has
inline constexpr char kProvenance[] = "{provenance}";  ///< key of the node that made the policy

/// Name, SI unit, range.
struct Axis {{
  const char* name;
  const char* unit;
  double low;
  double high;
  bool circular;
}};

namespace detail {{
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
}}

)";

inline constexpr std::string_view kCppProduct = R"(
namespace detail {

static_assert(std::numeric_limits<double>::is_iec559 && std::numeric_limits<float>::is_iec559, "IEEE 754");

/// a b, rounded before anything is added: what stands here keeps compilers from fusing the two.
inline double product(double a, double b) noexcept {
  double rounded = a * b;
#if defined(__GNUC__) && defined(__x86_64__)
  __asm__("" : "+x"(rounded));
#elif defined(__GNUC__) && defined(__aarch64__)
  __asm__("" : "+w"(rounded));
#else
  volatile double kept = rounded;
  rounded = kept;
#endif
  return rounded;
}

)";

inline constexpr std::string_view kCppNothing = R"(
inline void function(const double*, double*) noexcept {}
)";

inline constexpr std::string_view kCppConstant = R"(
inline void function(const double*, double* y) noexcept {
  for (std::size_t o = 0; o < kActionSize; ++o) y[o] = kValues[o];
}
)";

inline constexpr std::string_view kCppLinear = R"(
inline void function(const double* x, double* y) noexcept {
  for (std::size_t o = 0; o < kActionSize; ++o) {
    y[o] = kBias[o];
    for (std::size_t i = 0; i < kStateSize; ++i) y[o] += product(kSlopes[o * kStateSize + i], x[i]);
  }
}
)";

inline constexpr std::string_view kCppBiasLast = R"(
inline void function(const double* x, double* y) noexcept {
  for (std::size_t o = 0; o < kActionSize; ++o) {
    double sum = 0;
    for (std::size_t i = 0; i < kStateSize; ++i) sum += product(kSlopes[o * kStateSize + i], x[i]);
    y[o] = kBias[o] + sum;
  }
}
)";

inline constexpr std::string_view kCppNode = R"(
/// A split sends x[input] <= value to the node `ahead` places after it and the rest to the one behind that. A
/// leaf has 0 ahead; its value is its constant, or the row of its linear model.
struct Node {
  float value;
  std::uint32_t input : 8;
  std::uint32_t ahead : 24;
};
)";

inline constexpr std::string_view kCppScale = R"(
/// Constants of an output mean offset + scale * constant.
struct Scale {
  double offset;
  double scale;
};
)";

inline constexpr std::string_view kCppDescent = R"(
/// The least single-precision number that is not below x: compared with a threshold it says what x says.
inline float rounded_up(double x) noexcept {
  const float nearest = static_cast<float>(x);
  if (!(static_cast<double>(nearest) < x)) return nearest;
  std::int32_t bits = 0;
  std::memcpy(&bits, &nearest, sizeof bits);
  bits += bits >= 0 ? 1 : -1;
  float above = 0;
  std::memcpy(&above, &bits, sizeof above);
  return above;
}

inline constexpr std::size_t kAbreast = kTrees < 8 ? kTrees : 8;

/// The leaves that x falls into in kAbreast trees from `first` on (fewer at the end): their loads overlap,
/// where one descent after the other would wait for each.
inline std::size_t descend(const std::uint32_t* roots, std::size_t first, const float* x,
                           std::uint32_t* at) noexcept {
  const std::size_t width = kTrees - first < kAbreast ? kTrees - first : kAbreast;
  for (std::size_t i = 0; i < kAbreast; ++i) at[i] = roots[first + (i < width ? i : 0)];
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t i = 0; i < kAbreast; ++i) {
      const Node& node = kNodes[at[i]];
      const std::uint32_t ahead = node.ahead;
      const std::uint32_t next = at[i] + ahead + (x[node.input] > node.value ? 1U : 0U);
      moved = moved || next != at[i];
      at[i] = next;
    }
  }
  return width;
}
)";

inline constexpr std::string_view kCppLinearLeaf = R"(
/// The model of a leaf: bias, slopes, lowest and highest value.
inline const double* model(std::uint32_t leaf) noexcept {
  return kModels + static_cast<std::size_t>(kNodes[leaf].value) * (kStateSize + 3);
}

inline double linear(const double* model, const double* x) noexcept {
  double value = model[0];
  for (std::size_t i = 0; i < kStateSize; ++i) value += product(model[1 + i], x[i]);
  return value;
}

inline double held(double value, double low, double high) noexcept {
  return value < low ? low : high < value ? high : value;
}
)";

inline constexpr std::string_view kCppMeanOfConstants = R"(
inline double value(std::size_t output, const double*, const float* rounded) noexcept {
  double sum = 0;
  for (std::size_t first = 0; first < kTrees; first += kAbreast) {
    std::uint32_t at[kAbreast];
    const std::size_t width = descend(kRoots + output * kTrees, first, rounded, at);
    for (std::size_t i = 0; i < width; ++i) sum += static_cast<double>(kNodes[at[i]].value);
  }
  return kScales[output].offset + product(kScales[output].scale, sum / static_cast<double>(kTrees));
}
)";

inline constexpr std::string_view kCppMeanOfLinear = R"(
inline double value(std::size_t output, const double* x, const float* rounded) noexcept {
  double sum = 0;
  double low = 0;
  double high = 0;
  for (std::size_t first = 0; first < kTrees; first += kAbreast) {
    std::uint32_t at[kAbreast];
    const std::size_t width = descend(kRoots + output * kTrees, first, rounded, at);
    for (std::size_t i = 0; i < width; ++i) {
      const double* leaf = model(at[i]);
      sum += linear(leaf, x);
      low += leaf[kStateSize + 1];
      high += leaf[kStateSize + 2];
    }
  }
  return held(sum, low, high) / static_cast<double>(kTrees);
}
)";

inline constexpr std::string_view kCppTrimmed = R"(
/// The mean of the values that are left without the kTrimmed lowest and highest; NaN when one of them is. Values
/// that equal the last one left out stay as often as that leaves them.
inline double trimmed_mean(double* values) noexcept {
  double sum_of_all = 0;
  for (std::size_t i = 0; i < kTrees; ++i) sum_of_all += values[i];
  if (std::isnan(sum_of_all)) return sum_of_all;
  const double left = static_cast<double>(kTrees - 2 * kTrimmed);
  if (kTrimmed == 0) return sum_of_all / left;
  double sorted[kTrees];
  for (std::size_t i = 0; i < kTrees; ++i) {
    std::size_t place = i;
    for (; place > 0 && values[i] < sorted[place - 1]; --place) sorted[place] = sorted[place - 1];
    sorted[place] = values[i];
  }
  const double low = sorted[kTrimmed == 0 ? 0 : kTrimmed - 1];
  const double high = sorted[kTrees - (kTrimmed == 0 ? 1 : kTrimmed)];
  if (low == high) return low;
  double sum = 0;
  double lows = -static_cast<double>(kTrimmed);
  double highs = lows;
  for (std::size_t i = 0; i < kTrees; ++i) {
    const double value = kTrimmed > 6 ? sorted[i] : values[i];  // the order that the sum has in the policy
    sum += value > low && value < high ? value : 0.0;
    lows += value <= low ? 1 : 0;
    highs += value >= high ? 1 : 0;
  }
  return (sum + product(lows, low) + product(highs, high)) / left;
}
)";

inline constexpr std::string_view kCppTrimmedOfConstants = R"(
inline double value(std::size_t output, const double*, const float* rounded) noexcept {
  double values[kTrees];
  for (std::size_t first = 0; first < kTrees; first += kAbreast) {
    std::uint32_t at[kAbreast];
    const std::size_t width = descend(kRoots + output * kTrees, first, rounded, at);
    for (std::size_t i = 0; i < width; ++i) values[first + i] = static_cast<double>(kNodes[at[i]].value);
  }
  return kScales[output].offset + product(kScales[output].scale, trimmed_mean(values));
}
)";

inline constexpr std::string_view kCppTrimmedOfLinear = R"(
inline double value(std::size_t output, const double* x, const float* rounded) noexcept {
  double values[kTrees];
  for (std::size_t first = 0; first < kTrees; first += kAbreast) {
    std::uint32_t at[kAbreast];
    const std::size_t width = descend(kRoots + output * kTrees, first, rounded, at);
    for (std::size_t i = 0; i < width; ++i) {
      const double* leaf = model(at[i]);
      values[first + i] = held(linear(leaf, x), leaf[kStateSize + 1], leaf[kStateSize + 2]);
    }
  }
  return trimmed_mean(values);
}
)";

inline constexpr std::string_view kCppForest = R"(
inline void function(const double* x, double* y) noexcept {
  float rounded[kStateSize + 1];
  for (std::size_t i = 0; i < kStateSize; ++i) rounded[i] = rounded_up(x[i]);
  rounded[kStateSize] = -FLT_MAX;  // what leaves look at: above none of them, so that descents stay there
  for (std::size_t o = 0; o < kActionSize; ++o) y[o] = value(o, x, rounded);
}
)";

inline constexpr std::string_view kCppObliqueForest = R"(
inline void function(const double* x, double* y) noexcept {
  float rounded[kStateSize + kDirectionCount + 1];  // inputs, then directions, which splits know as inputs, too
  for (std::size_t i = 0; i < kStateSize; ++i) rounded[i] = rounded_up(x[i]);
  for (std::size_t j = 0; j < kDirectionCount; ++j) {
    const double* row = kDirections + j * (kStateSize + 1);
    double sum = row[0];
    for (std::size_t i = 0; i < kStateSize; ++i) sum += product(row[1 + i], x[i]);
    rounded[kStateSize + j] = rounded_up(sum);
  }
  // What leaves look at: above none of them, so that descents stay there.
  rounded[kStateSize + kDirectionCount] = -FLT_MAX;
  for (std::size_t o = 0; o < kActionSize; ++o) y[o] = value(o, x, rounded);
}
)";

inline constexpr std::string_view kCppClamp = R"(
/// The value moved into the axis's range (wrapped, where it is circular); a NaN becomes the centre.
inline double inside(double value, const Axis& axis) noexcept {
  if (value >= axis.low && value <= axis.high) return value;
  const double width = axis.high - axis.low;
  if (std::isnan(value)) {
    if (std::isfinite(axis.low) && std::isfinite(axis.high)) return axis.low / 2 + axis.high / 2;
    value = 0;
  } else if (axis.circular && std::isfinite(value) && width > 0) {
    value -= product(width, std::floor((value - axis.low) / width));
  }
  return value < axis.low ? axis.low : axis.high < value ? axis.high : value;
}
)";

inline constexpr std::string_view kCppAct = R"(
/// The same with arrays: kStateSize numbers in the order of kStates to kActionSize in the order of kActions.
inline void act(const double* state, double* action) noexcept {
  detail::function(state, action);
  for (std::size_t i = 0; i < kActionSize; ++i) action[i] = detail::inside(action[i], kActions[i]);
}

)";

inline constexpr std::string_view kCppActWithoutParameters = R"(
/// The same with arrays; the action has no parameters.
inline void act(const double*, double*) noexcept {}

)";

}  // namespace coppice
