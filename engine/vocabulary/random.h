#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace coppice {

/// The name of what a draw is for ("wheel_noise"), turned into a number by the compiler.
struct Purpose {
  std::uint32_t id;
  consteval Purpose(const char* name) : id(2166136261u) {  // FNV-1a
    for (; *name != '\0'; ++name) id = (id ^ static_cast<unsigned char>(*name)) * 16777619u;
  }
};

class Stream;

/// Addressed randomness. A draw is not consumed but looked up: (root seed, label, replicate, forks) select a
/// family, (scenario, step, purpose, component) the draw in it, by Philox4x32-10 (Salmon et al., SC 2011).
/// The same address gives the same number, in any order and on any thread; two policies on scenario k meet
/// the same scenario k. A value: copy it, pass it by reference, never store a position in it.
class Draws {
 public:
  Draws(std::uint64_t root_seed, std::string_view label, std::uint64_t replicate);

  /// An independent family of draws; fork by what it is for and by index, never by thread. The whole address
  /// so far enters (a fork made in another step is another family); scenario and step begin at 0 again.
  Draws fork(Purpose purpose, std::uint64_t index = 0) const;
  Draws scenario(std::uint64_t number) const;  ///< below 2^48, else throws std::out_of_range
  Draws step(std::uint32_t number) const;

  // `component` numbers the draws of one purpose within a step; below 2^17, else throws std::out_of_range.

  /// Uniform in [low, high) (or low, where they are equal), on a grid of 2^53 values.
  double uniform(Purpose purpose, double low, double high, std::uint32_t component = 0) const;
  /// Normal; one draw gives one value, by the inverse of the distribution function (Wichura 1988, AS 241).
  double normal(Purpose purpose, double mean, double deviation, std::uint32_t component = 0) const;
  /// Uniform in {0, ..., n - 1}; n > 0.
  std::uint64_t below(Purpose purpose, std::uint64_t n, std::uint32_t component = 0) const;
  /// A sequence of draws, for algorithms that need an unknown number of them.
  Stream stream(Purpose purpose, std::uint64_t index = 0) const;

  std::uint64_t key() const { return key_; }  ///< identifies the family
  std::uint64_t scenario() const { return scenario_; }
  std::uint32_t step() const { return step_; }

 private:
  explicit Draws(std::uint64_t key) : key_(key) {}
  std::uint64_t bits(std::uint32_t purpose, std::uint32_t component) const;

  std::uint64_t key_;
  std::uint64_t scenario_ = 0;
  std::uint32_t step_ = 0;
};

/// A sequential generator over one address. Satisfies UniformRandomBitGenerator, but use its own
/// distributions: the standard leaves its distributions' algorithms to the library.
class Stream {
 public:
  explicit Stream(std::uint64_t key) : key_(key) {}

  std::uint64_t next();
  double uniform();                         ///< [0, 1), 53 bits
  double uniform(double low, double high);  ///< [low, high)
  double normal();                          ///< mean 0, deviation 1
  std::uint64_t below(std::uint64_t n);     ///< {0, ..., n - 1}; n > 0

  using result_type = std::uint64_t;
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return ~0ull; }
  result_type operator()() { return next(); }

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;  ///< of the next block
  std::array<std::uint64_t, 2> block_{};
  unsigned left_ = 0;  ///< numbers of block_ not given out yet
};

}  // namespace coppice
