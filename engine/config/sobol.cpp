#include "engine/config/sobol.h"

#include <array>
#include <stdexcept>

namespace coppice::config {
namespace {

constexpr std::size_t kBits = 32;
using Directions = std::array<std::uint32_t, kBits>;

/// A primitive polynomial over GF(2), x^degree + ... + 1 with the inner coefficients as bits, and the first
/// numbers m_1, m_2, ... of its recurrence.
struct Polynomial {
  std::size_t degree;
  std::uint32_t inner;
  std::array<std::uint32_t, 5> first;
};

// Dimensions 2 to 10 of Joe and Kuo's table new-joe-kuo-6; the first dimension is van der Corput's sequence.
constexpr std::array<Polynomial, kSobolDimensions - 1> kPolynomials = {{{1, 0, {1}},
                                                                        {2, 1, {1, 3}},
                                                                        {3, 1, {1, 3, 1}},
                                                                        {3, 2, {1, 1, 1}},
                                                                        {4, 1, {1, 1, 3, 3}},
                                                                        {4, 4, {1, 3, 5, 13}},
                                                                        {5, 2, {1, 1, 5, 5, 17}},
                                                                        {5, 4, {1, 1, 5, 5, 5}},
                                                                        {5, 7, {1, 1, 7, 11, 19}}}};

/// v_k = m_k / 2^k as 32-bit fractions, by v_k = a_1 v_{k-1} ^ ... ^ a_{s-1} v_{k-s+1} ^ v_{k-s} ^ (v_{k-s}
/// >> s).
constexpr Directions directions(std::size_t dimension) {
  Directions v{};
  if (dimension == 0) {
    for (std::size_t k = 0; k < kBits; ++k) v[k] = 1u << (kBits - 1 - k);
    return v;
  }
  const Polynomial& polynomial = kPolynomials[dimension - 1];
  const std::size_t s = polynomial.degree;
  for (std::size_t k = 0; k < s; ++k) v[k] = polynomial.first[k] << (kBits - 1 - k);
  for (std::size_t k = s; k < kBits; ++k) {
    v[k] = v[k - s] ^ (v[k - s] >> s);
    for (std::size_t i = 1; i < s; ++i) {
      if (((polynomial.inner >> (s - 1 - i)) & 1u) != 0) v[k] ^= v[k - i];
    }
  }
  return v;
}

constexpr std::array<Directions, kSobolDimensions> all_directions() {
  std::array<Directions, kSobolDimensions> all{};
  for (std::size_t d = 0; d < kSobolDimensions; ++d) all[d] = directions(d);
  return all;
}

constexpr std::array<Directions, kSobolDimensions> kDirections = all_directions();

}  // namespace

double sobol(std::uint32_t index, std::size_t dimension) {
  if (dimension >= kSobolDimensions) throw std::logic_error("the Sobol' sequence has too few dimensions");
  std::uint32_t x = 0;
  std::uint32_t gray = index ^ (index >> 1u);
  for (std::size_t k = 0; gray != 0; ++k, gray >>= 1u) {
    if ((gray & 1u) != 0) x ^= kDirections[dimension][k];
  }
  return static_cast<double>(x) * 0x1p-32;
}

}  // namespace coppice::config
