#include "engine/vocabulary/random.h"

#include <Random123/philox.h>
#include <xxhash.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "engine/vocabulary/elementary.h"

namespace coppice {
namespace {

// Tags that keep the keys of forks and streams apart, whatever their purposes and indices.
constexpr std::uint64_t kForkTag = 0x666f726b00000001;
constexpr std::uint64_t kStreamTag = 0x7374726500000002;

constexpr std::uint64_t kMaxScenario = std::uint64_t{1} << 48;
constexpr std::uint32_t kMaxComponent = std::uint32_t{1} << 17;

/// The finalizer of SplitMix64 (Steele, Lea and Flood, OOPSLA 2014): a bijection that changes about half of
/// the bits.
constexpr std::uint64_t scramble(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9;
  x ^= x >> 27;
  x *= 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

/// Adds `value` to a hash; injective in the value, and depends on the order of calls.
constexpr std::uint64_t combine(std::uint64_t hash, std::uint64_t value) {
  return scramble(scramble(hash + 0x9e3779b97f4a7c15) ^ value);
}

/// Both 64-bit numbers of one Philox block.
std::array<std::uint64_t, 2> block(std::uint64_t key, std::uint32_t c0, std::uint32_t c1, std::uint32_t c2,
                                   std::uint32_t c3) {
  const r123::Philox4x32::ctr_type counter{{c0, c1, c2, c3}};
  const r123::Philox4x32::key_type keys{
      {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)}};
  const r123::Philox4x32::ctr_type out = r123::Philox4x32()(counter, keys);
  const auto join = [](std::uint32_t low, std::uint32_t high) { return std::uint64_t{high} << 32 | low; };
  return {join(out[0], out[1]), join(out[2], out[3])};
}

/// The upper 53 bits as a number in [0, 1).
double unit(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

double scaled(double u, double low, double high) {
  const double x = low + (high - low) * u;
  if (x < high) return x;
  return low < high ? std::nextafter(high, low) : low;  // rounding may reach the open end
}

/// 52 bits and a half, so that the quantile's argument is never 0 or 1 and is exact and symmetric about 1/2.
double standard_normal(std::uint64_t bits) {
  return normal_quantile((static_cast<double>(bits >> 12) + 0.5) * 0x1p-52);
}

/// An unbiased number below n from 64 random bits; false when they fall into the part that must be rejected
/// (Lemire, ACM TOMACS 29(1), 2019).
bool reduce(std::uint64_t bits, std::uint64_t n, std::uint64_t& result) {
  __extension__ using Wide = unsigned __int128;
  const Wide product = static_cast<Wide>(bits) * n;
  result = static_cast<std::uint64_t>(product >> 64);
  const auto low = static_cast<std::uint64_t>(product);
  return low >= n || low >= (0 - n) % n;
}

}  // namespace

Draws::Draws(std::uint64_t root_seed, std::string_view label, std::uint64_t replicate)
    : key_(combine(combine(scramble(root_seed), XXH3_64bits(label.data(), label.size())), replicate)) {}

Draws Draws::fork(Purpose purpose, std::uint64_t index) const {
  std::uint64_t key = combine(key_ ^ kForkTag, scenario_);
  key = combine(key, std::uint64_t{step_} << 32 | purpose.id);
  return Draws(combine(key, index));
}

Draws Draws::scenario(std::uint64_t number) const {
  if (number >= kMaxScenario)
    throw std::out_of_range("scenario " + std::to_string(number) + " is not below 2^48");
  Draws draws = *this;
  draws.scenario_ = number;
  return draws;
}

Draws Draws::step(std::uint32_t number) const {
  Draws draws = *this;
  draws.step_ = number;
  return draws;
}

// The counter is the address itself: scenario's low 32 bits, step, purpose, then scenario's high 16 bits
// beside the component's block; each block serves an even component and the odd one after it. Key and counter
// together make distinct addresses of a family distinct inputs of Philox, which is a bijection for each key.
std::uint64_t Draws::bits(std::uint32_t purpose, std::uint32_t component) const {
  if (component >= kMaxComponent) {
    throw std::out_of_range("component " + std::to_string(component) + " of a draw is not below 2^17");
  }
  const auto low = static_cast<std::uint32_t>(scenario_);
  const auto high = static_cast<std::uint32_t>(scenario_ >> 32) << 16 | component >> 1;
  return block(key_, low, step_, purpose, high)[component & 1];
}

double Draws::uniform(Purpose purpose, double low, double high, std::uint32_t component) const {
  return scaled(unit(bits(purpose.id, component)), low, high);
}

double Draws::normal(Purpose purpose, double mean, double deviation, std::uint32_t component) const {
  return mean + deviation * standard_normal(bits(purpose.id, component));
}

std::uint64_t Draws::below(Purpose purpose, std::uint64_t n, std::uint32_t component) const {
  std::uint64_t result = 0;
  if (reduce(bits(purpose.id, component), n, result)) return result;
  return stream(purpose, component).below(n);  // rejected: go on with further numbers of this very address
}

Stream Draws::stream(Purpose purpose, std::uint64_t index) const {
  std::uint64_t key = combine(key_ ^ kStreamTag, scenario_);
  key = combine(key, std::uint64_t{step_} << 32 | purpose.id);
  return Stream(combine(key, index));
}

std::uint64_t Stream::next() {
  if (left_ == 0) {
    block_ =
        block(key_, static_cast<std::uint32_t>(counter_), static_cast<std::uint32_t>(counter_ >> 32), 0, 0);
    ++counter_;
    left_ = 2;
  }
  return block_[2 - left_--];
}

double Stream::uniform() {
  return unit(next());
}

double Stream::uniform(double low, double high) {
  return scaled(uniform(), low, high);
}

double Stream::normal() {
  return standard_normal(next());
}

std::uint64_t Stream::below(std::uint64_t n) {
  std::uint64_t result = 0;
  while (!reduce(next(), n, result)) {
  }
  return result;
}

}  // namespace coppice
