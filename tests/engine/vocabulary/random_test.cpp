#include "engine/vocabulary/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

namespace coppice {
namespace {

using Words = std::array<std::uint32_t, 4>;

/// Philox4x32-10 as the paper gives it (Salmon et al., SC 2011, section 3.3), independent of the library.
Words philox(Words counter, std::uint32_t key0, std::uint32_t key1) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53} * counter[0];
    const std::uint64_t b = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key0, static_cast<std::uint32_t>(b),
               static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key1, static_cast<std::uint32_t>(a)};
    key0 += 0x9E3779B9;
    key1 += 0xBB67AE85;
  }
  return counter;
}

double chi_square(const std::vector<int>& counts) {
  double total = 0;
  for (int count : counts) total += count;
  const double expected = total / static_cast<double>(counts.size());
  double sum = 0;
  for (int count : counts) sum += (count - expected) * (count - expected) / expected;
  return sum;
}

double correlation(const std::function<std::pair<double, double>(std::uint32_t)>& pair, std::uint32_t n) {
  double sum = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    const auto [a, b] = pair(i);
    sum += (a - 0.5) * (b - 0.5);
  }
  return 12 * sum / n;
}

// Vectors "philox 4x32 10" of the Random123 distribution.
TEST(Philox, TestsOwnImplementationGivesThePublishedVectors) {
  EXPECT_EQ(philox({0, 0, 0, 0}, 0, 0), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({~0u, ~0u, ~0u, ~0u}, ~0u, ~0u), (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, 0xa4093822, 0x299f31d0),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Stream, IsPhiloxInCounterModeAndStartsWithThePublishedVector) {
  Stream stream(0);
  EXPECT_EQ(stream.next(), 0xe169c58d6627e8d5u);
  EXPECT_EQ(stream.next(), 0x9b00dbd8bc57ac4cu);
  Stream keyed(0x299f31d0a4093822);
  for (std::uint32_t block = 0; block < 5; ++block) {
    const Words words = philox({block, 0, 0, 0}, 0xa4093822, 0x299f31d0);
    EXPECT_EQ(keyed.next(), std::uint64_t{words[1]} << 32 | words[0]);
    EXPECT_EQ(keyed.next(), std::uint64_t{words[3]} << 32 | words[2]);
  }
}

TEST(Draws, LookUpPhiloxAtTheirAddress) {
  const Draws draws = Draws(7, "train", 3).scenario(0x123456789abc).step(77);
  const auto key0 = static_cast<std::uint32_t>(draws.key());
  const auto key1 = static_cast<std::uint32_t>(draws.key() >> 32);
  const std::uint32_t purpose = Purpose("wheel_noise").id;
  for (std::uint32_t component : {0u, 1u, 2u, 131071u}) {
    const Words words = philox({0x56789abc, 77, purpose, 0x1234u << 16 | component >> 1}, key0, key1);
    const std::size_t first = component % 2 * 2;
    const std::uint64_t bits = std::uint64_t{words[first + 1]} << 32 | words[first];
    EXPECT_EQ(draws.uniform("wheel_noise", 0, 1, component),
              std::ldexp(static_cast<double>(bits >> 11), -53));
  }
}

// These numbers are part of every stored result: they must not change.
TEST(Draws, KeysAndNumbersStayWhatTheyAre) {
  const Draws draws(2017, "collect", 0);
  EXPECT_EQ(draws.key(), 0x2c7a7b4c1cb3de6bu);
  EXPECT_EQ(draws.fork("policy").key(), 0x116dd209dc42ed9fu);
  EXPECT_EQ(draws.scenario(5).step(6).fork("policy", 2).key(), 0x233728accb3ea566u);
  EXPECT_EQ(draws.scenario(1).uniform("action", 0, 1), 0x1.0b929f6998b86p-1);
  EXPECT_EQ(draws.scenario(1).step(2).normal("noise", 0, 1, 3), 0x1.3bb5a4086930ep-2);
  EXPECT_EQ(draws.stream("shuffle").next(), 0xcabd6689bdbb14ccu);
}

TEST(Draws, EveryPartOfTheAddressCounts) {
  std::set<double> values;
  std::size_t made = 0;
  const auto add = [&](const Draws& draws) {
    for (std::uint32_t component : {0u, 1u, 2u}) {
      values.insert(draws.uniform("a", 0, 1, component));
      values.insert(draws.uniform("b", 0, 1, component));
      made += 2;
    }
  };
  for (std::uint64_t seed : {0u, 1u}) {
    for (const char* label : {"", "a", "ab", "b"}) {
      for (std::uint64_t replicate : {0u, 1u}) {
        const Draws root(seed, label, replicate);
        for (std::uint64_t scenario : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1} << 32}) {
          for (std::uint32_t step : {0u, 1u}) {
            const Draws here = root.scenario(scenario).step(step);
            add(here);
            add(here.fork("x"));
            add(here.fork("x", 1));
            add(here.fork("y"));
            add(here.fork("x").fork("y"));
            add(here.fork("y").fork("x"));
          }
        }
      }
    }
  }
  EXPECT_EQ(values.size(), made);
}

TEST(Draws, DoNotDependOnOtherDraws) {
  const Draws draws(1, "evaluate", 0);
  const double alone = draws.scenario(4).step(2).uniform("x", 0, 1);
  for (std::uint32_t i = 0; i < 10; ++i) draws.scenario(i).uniform("y", 0, 1);
  EXPECT_EQ(draws.scenario(4).step(2).uniform("x", 0, 1), alone);
  EXPECT_EQ(draws.step(2).scenario(4).uniform("x", 0, 1), alone);
}

TEST(Draws, StreamsOfDifferentAddressesDiffer) {
  const Draws draws(1, "train", 0);
  std::set<std::uint64_t> firsts;
  for (std::uint32_t i = 0; i < 10; ++i) {
    firsts.insert(draws.stream("x", i).next());
    firsts.insert(draws.stream("y", i).next());
    firsts.insert(draws.scenario(i + 1).stream("x").next());
    firsts.insert(draws.step(i + 1).stream("x").next());
    firsts.insert(draws.fork("x", i).stream("x").next());
  }
  EXPECT_EQ(firsts.size(), 50u);
}

TEST(Draws, AddressesOutOfRangeAreRefused) {
  const Draws draws(1, "", 0);
  EXPECT_NO_THROW(draws.scenario((std::uint64_t{1} << 48) - 1));
  EXPECT_THROW(draws.scenario(std::uint64_t{1} << 48), std::out_of_range);
  EXPECT_THROW(draws.uniform("x", 0, 1, 1 << 17), std::out_of_range);
}

TEST(Draws, UniformStaysBelowItsOpenEnd) {
  const Draws draws(3, "", 0);
  const double next = std::nextafter(1.0, 2.0);  // rounding would reach it half of the time
  for (std::uint32_t i = 0; i < 100; ++i) {
    EXPECT_EQ(draws.step(i).uniform("x", 1.0, next), 1.0);
    EXPECT_EQ(draws.step(i).uniform("x", 2.5, 2.5), 2.5);
    const double x = draws.step(i).uniform("x", -3, -2);
    EXPECT_TRUE(x >= -3 && x < -2);
  }
}

// 63 degrees of freedom: 103.4 is the 0.999 quantile. Along each part of the address the draws must be
// uniform.
TEST(Draws, AreUniformAlongEachPartOfTheAddress) {
  const Draws draws(11, "", 0);
  const std::vector<std::function<double(std::uint32_t)>> ways = {
      [&](std::uint32_t i) { return draws.scenario(i).uniform("x", 0, 64); },
      [&](std::uint32_t i) { return draws.step(i).uniform("x", 0, 64); },
      [&](std::uint32_t i) { return draws.uniform("x", 0, 64, i); },
      [&](std::uint32_t i) { return draws.fork("x", i).uniform("x", 0, 64); },
      [&](std::uint32_t i) { return Draws(i, "", 0).uniform("x", 0, 64); },
      [&](std::uint32_t i) { return Draws(0, "", i).uniform("x", 0, 64); },
      [&](std::uint32_t i) { return draws.stream("x", i).uniform(0, 64); }};
  for (std::size_t way = 0; way < ways.size(); ++way) {
    std::vector<int> counts(64);
    for (std::uint32_t i = 0; i < 64000; ++i) ++counts[static_cast<std::size_t>(ways[way](i))];
    EXPECT_LT(chi_square(counts), 103.4) << "way " << way;
  }
}

TEST(Draws, NeighboursAreUncorrelated) {
  const Draws draws(12, "", 0);
  constexpr std::uint32_t n = 100000;
  const double limit = 4 / std::sqrt(static_cast<double>(n));
  using Pair = std::pair<double, double>;
  const auto u = [](const Draws& d, std::uint32_t component = 0) { return d.uniform("x", 0, 1, component); };
  EXPECT_LT(
      std::fabs(correlation([&](auto i) { return Pair(u(draws.scenario(i)), u(draws.scenario(i + 1))); }, n)),
      limit);
  EXPECT_LT(std::fabs(correlation([&](auto i) { return Pair(u(draws.step(i)), u(draws.step(i + 1))); }, n)),
            limit);
  EXPECT_LT(std::fabs(correlation([&](auto i) { return Pair(u(draws.step(i)), u(draws.step(i), 1)); }, n)),
            limit);
  EXPECT_LT(std::fabs(correlation(
                [&](auto i) { return Pair(u(draws.step(i)), draws.step(i).uniform("y", 0, 1)); }, n)),
            limit);
  EXPECT_LT(std::fabs(correlation(
                [&](auto i) { return Pair(u(draws.fork("f", i)), u(draws.fork("f", i + 1))); }, n)),
            limit);
  EXPECT_LT(std::fabs(correlation([&](auto i) { return Pair(u(draws.step(i)), u(draws.scenario(i))); }, n)),
            limit);
}

TEST(Draws, NormalHasTheMomentsOfTheNormal) {
  const Draws draws(13, "", 0);
  constexpr std::uint32_t n = 400000;
  double m1 = 0, m2 = 0, m3 = 0, m4 = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double x = (draws.scenario(i).normal("x", 10, 2) - 10) / 2;
    m1 += x / n;
    m2 += x * x / n;
    m3 += x * x * x / n;
    m4 += x * x * x * x / n;
  }
  const double se = 1 / std::sqrt(static_cast<double>(n));  // variances of x^k: 1, 2, 15, 96
  EXPECT_NEAR(m1, 0, 4 * se);
  EXPECT_NEAR(m2, 1, 4 * se * std::sqrt(2.0));
  EXPECT_NEAR(m3, 0, 4 * se * std::sqrt(15.0));
  EXPECT_NEAR(m4, 3, 4 * se * std::sqrt(96.0));
}

TEST(Draws, BelowIsUniformAndInRange) {
  const Draws draws(14, "", 0);
  for (std::uint64_t n : {1u, 2u, 3u, 10u}) {
    std::vector<int> counts(n);
    for (std::uint32_t i = 0; i < 30000; ++i) ++counts.at(draws.step(i).below("x", n));
    EXPECT_LT(chi_square(counts), 27.9) << n;  // 0.999 quantile for 9 degrees of freedom
  }
}

// With n = 3 * 2^62 a quarter of all 64-bit numbers must be rejected: a plain multiplication would give the
// multiples of 3 twice as often as the others.
TEST(Draws, BelowRejectsWhatWouldBeBiased) {
  const std::uint64_t n = std::uint64_t{3} << 62;
  const Draws draws(15, "", 0);
  std::vector<int> counts(3);
  for (std::uint32_t i = 0; i < 30000; ++i) {
    const std::uint64_t x = draws.step(i).below("x", n);
    ASSERT_LT(x, n);
    ++counts[x % 3];
  }
  EXPECT_LT(chi_square(counts), 13.8);  // 0.999 quantile for 2 degrees of freedom
}

TEST(Stream, BelowVisitsEveryNumber) {
  Stream stream = Draws(16, "", 0).stream("x");
  std::vector<int> counts(7);
  for (int i = 0; i < 7000; ++i) ++counts.at(stream.below(7));
  EXPECT_LT(chi_square(counts), 22.5);  // 0.999 quantile for 6 degrees of freedom
}

}  // namespace
}  // namespace coppice
